"""Distributions and randomisation files: what is drawn from them, what is refused and how."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter
from scipy import stats

from dq_marine.errors import InvalidInputError
from dq_marine.randomisation import Randomisation, randomisation_names
from dq_marine.randomisation.distributions import Distribution, drawn
from dq_marine.randomisation.files import _FOLDER

distribution = TypeAdapter(Distribution).validate_python

CASES = {
    "uniform": ({"uniform": (0.5, 2.0)}, stats.uniform(0.5, 1.5)),
    "log-uniform": ({"log_uniform": (0.5, 2.0)}, stats.loguniform(0.5, 2.0)),
    "normal": (
        {"normal": (1.0, 0.3), "within": (0.5, 2.0)},
        stats.truncnorm(-0.5 / 0.3, 1.0 / 0.3, 1.0, 0.3),
    ),
    "narrow normal": ({"normal": (1.0, 1e-3), "within": (0.5, 2.0)}, stats.norm(1.0, 1e-3)),
}


@pytest.mark.parametrize("case", CASES)
def test_draws_are_distributed_as_scipy_has_it(case):
    table, reference = CASES[case]
    shares = np.linspace(0.001, 0.999, 99)
    quantiles = [distribution(table).quantile(share) for share in shares]
    assert np.allclose(quantiles, reference.ppf(shares), rtol=1e-9)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.sampled_from(sorted(CASES)))
def test_quantiles_rise_within_the_limits(one, other, case):
    made = distribution(CASES[case][0])
    below, above = sorted((one, other))
    assert made.limits[0] <= made.quantile(below) <= made.quantile(above) <= made.limits[1]


@given(st.sampled_from(sorted(CASES)))
def test_a_draw_takes_one_number_of_the_generator(case):
    rng, other = np.random.default_rng(1), np.random.default_rng(1)
    drawn(distribution(CASES[case][0]), rng)
    other.random()
    assert rng.random() == other.random()


@pytest.mark.parametrize("name", randomisation_names())
def test_files_that_ship_say_where_they_are_from(name):
    randomisation = Randomisation.load(name)
    assert randomisation.sources
    assert randomisation.description
    assert Randomisation.load(_FOLDER / f"{name}.toml") == randomisation
    assert Randomisation.load(randomisation) is randomisation


WRONG = {
    "unknown table": ("[engine]\n", "engine = {}: unknown key; remove it"),
    "unknown key": ("[rigid_body]\nweight = 1.0", "rigid_body.weight = 1.0: unknown key"),
    "a number": ("[rigid_body]\nmass = 1.2", "rigid_body.mass = 1.2: not a distribution; give { uniform"),
    "no distribution": ("[rigid_body]\nmass = { flat = [1, 2] }", "rigid_body.mass = {'flat': [1, 2]}: not a"),
    "a text": ("[rigid_body]\nmass = { uniform = [1, 'b'] }", "rigid_body.mass.uniform.1 = 'b': "),
    "three limits": ("[rigid_body]\nmass = { uniform = [1, 2, 3] }", "rigid_body.mass.uniform = [1, 2, 3]: too many"),
    "upside down": (
        "[rigid_body]\nmass = { uniform = [1.2, 0.8] }",
        "rigid_body.mass.uniform = [1.2, 0.8]: the lower limit is above the upper one; give [lower, upper]",
    ),
    "not positive": (
        "[added_mass]\nfactor = { uniform = [0.0, 1.0] }",
        "added_mass.factor = {'uniform': [0.0, 1.0]}: draws from 0 to 1; a factor on the vehicle's own number lies",
    ),
    "one of six": (
        "[damping]\nquadratic = [" + "{ uniform = [0.5, 1.0] }, " * 5 + "{ uniform = [-0.5, 1.0] }]",
        "damping.quadratic.5 = {'uniform': [-0.5, 1.0]}: draws from -0.5 to 1",
    ),
    "two of three": (
        "[rigid_body]\ninertia = [{ uniform = [0.5, 1.0] }, { uniform = [0.5, 1.0] }]",
        "rigid_body.inertia.2: missing; add it",
    ),
    "log of zero": ("[added_mass]\nfactor = { log_uniform = [0.0, 1.0] }", "log_uniform.0 = 0.0: must be greater"),
    "normal without limits": ("[rigid_body]\nmass = { normal = [1.0, 0.1] }", "mass.within: missing; add it"),
    "mean outside": (
        "[rigid_body]\nmass = { normal = [1.0, 0.1], within = [1.1, 1.2] }",
        "rigid_body.mass = {'normal': [1.0, 0.1], 'within': [1.1, 1.2]}: the mean lies outside the limits",
    ),
    "two volumes": (
        "[buoyancy]\nvolume = { uniform = [0.9, 1.1] }\nnet_weight = { uniform = [0.0, 0.1] }",
        "volume and net_weight both set the volume; give one of them",
    ),
    "two centres": (
        "[buoyancy]\ncenter = { uniform = [0.0, 0.01] }\nlist_angle = { uniform = [0.0, 5.0] }",
        "set the centre of buoyancy; give one or the other",
    ),
    "capsized": ("[buoyancy]\nlist_angle = { uniform = [0.0, 90.0] }", "{'uniform': [0.0, 90.0]}: draws from"),
    "too much coupling": ("[added_mass]\ncoupling = 0.5", "added_mass.coupling = 0.5: "),
    "backward current": ("[current]\nspeed = -0.5", "current.speed = -0.5: must not be negative"),
    "not a number": ("[current]\nspeed = nan", "current.speed = nan: not a finite number"),
    "not TOML": ("[rigid_body", "not a TOML file"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_file_is_refused_by_field(case, tmp_path):
    text, message = WRONG[case]
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=re.escape(message)) as caught:
        Randomisation.load(path)
    assert str(path) in str(caught.value)


def test_an_unknown_name_is_refused():
    with pytest.raises(
        InvalidInputError,
        match=r"no randomisation 'wild'; there are default, lost_thruster, payload, published",
    ):
        Randomisation.load("wild")


def test_a_file_that_cannot_be_read_is_refused(tmp_path):
    path = tmp_path / "binary.toml"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(InvalidInputError, match="not a TOML file"):
        Randomisation.load(path)
