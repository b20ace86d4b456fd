"""A vehicle whose numbers were changed is found again from its noisy motion, with errors as large as it says."""

from __future__ import annotations

import numpy as np
import pytest
from identification.logs import GROUPS, NOISE, STEP, changed, rov_log, written
from support.sweeps import sweep

from dq_marine import load_vehicle
from dq_marine.errors import InvalidInputError
from dq_marine.identification import Conditions, fit_vehicle, read_log
from dq_marine.identification.parameters import parameters_of, quantities_of

SEED = 5
CONDITIONS = Conditions(GROUPS, step=STEP)


@pytest.fixture(scope="module")
def nominal():
    return load_vehicle("bluerov2_heavy")


def fitted(nominal, path, conditions=CONDITIONS):
    return fit_vehicle(nominal, read_log(path, nominal), conditions)


def truth(nominal, seed=SEED, groups=GROUPS):
    parameters = parameters_of(nominal, groups)
    return {one.label: one.value for one in quantities_of(changed(nominal, groups, seed), parameters)}


@pytest.fixture(scope="module", params=sweep([180.0, 600.0], plain=[180.0]))
def long_fit(request, nominal, tmp_path_factory):
    return fitted(nominal, written(tmp_path_factory.mktemp("log") / "run.csv", rov_log(SEED, request.param)))


def test_noisy_minutes_tell_every_number_within_two_per_cent(nominal, long_fit):
    """Ten minutes, of which three are enough for these sensors."""
    true = truth(nominal)
    assert not long_fit.held
    assert {one.label for one in long_fit.estimates} == set(true)
    errors = {one.label: one.value / true[one.label] - 1.0 for one in long_fit.estimates}
    assert max(map(abs, errors.values())) < 0.02, errors
    assert max(abs(one.nominal / true[one.label] - 1.0) for one in long_fit.estimates) > 0.3


def test_standard_errors_are_honest(nominal, long_fit):
    """Of 15 estimates none is beyond 3.5 errors, and their scatter is that of the errors, neither below nor above."""
    true = truth(nominal)
    scores = np.array([(one.value - true[one.label]) / one.standard_error for one in long_fit.estimates])
    assert np.abs(scores).max() < 3.5, scores
    assert 0.4 < np.sqrt((scores**2).mean()) < 1.7, scores


def test_the_residuals_are_the_sensors_noise(long_fit):
    degrees = np.radians(NOISE["deg"])
    expected = [NOISE["depth_m"], *[degrees] * 3, *[NOISE["m_s"]] * 3, *[NOISE["rad_s"]] * 3]
    assert np.isnan(long_fit.noise[:2]).all()
    assert long_fit.noise[2:] == pytest.approx(expected, rel=0.12)


def test_what_never_moves_is_held_by_name(nominal, tmp_path):
    """A log in heave alone, which never sways: nothing of sway and yaw is told, and nothing of them changes."""
    fit = fitted(nominal, written(tmp_path / "dive.csv", rov_log(SEED, 120.0, (2,))))
    held = {label for label, _ in fit.held}
    assert {
        "added mass, sway",
        "quadratic damping, sway",
        "quadratic damping, yaw",
        "added mass, yaw",
    } <= held
    assert {"added mass, heave", "linear damping, heave", "quadratic damping, heave"}.isdisjoint(held)
    assert "sway" in fit.notes[0]
    assert "The log does not tell" in fit.notes[0]
    assert fit.vehicle.quadratic_damping[1] == nominal.quadratic_damping[1]
    assert all(error > CONDITIONS.bound for _, error in fit.held)


def test_a_log_at_rest_tells_nothing(nominal, tmp_path):
    weight = nominal.weight - nominal.buoyant_force
    noise = np.random.default_rng(0).normal(0.0, 0.01, (1200, 10))
    rows = [
        [0.1 * number, *readings, 0.0, 0.0, -weight, 0.0, 0.0, 0.0] for number, readings in enumerate(noise)
    ]
    with pytest.raises(InvalidInputError, match=r"tells nothing of .*surge.*moves in more ways"):
        fitted(nominal, written(tmp_path / "rest.csv", rows), Conditions(("added_mass",), step=STEP))


@pytest.mark.sweep
def test_sensors_without_a_reading_and_uneven_times(nominal, tmp_path):
    """A depth meter at 1 Hz, a DVL that drops out, a clock that jitters: fewer readings, the same vehicle."""
    rng = np.random.default_rng(0)
    rows = [list(row) for row in rov_log(SEED, 600.0)[:3001]]
    for number, row in enumerate(rows):
        row[0] += rng.uniform(-1e-4, 1e-4)
        row[1] = row[1] if number % 10 == 0 else ""
        row[5:8] = row[5:8] if number % 2 == 0 and not 400 < number < 450 else ["", "", ""]
    fit = fitted(nominal, written(tmp_path / "gaps.csv", rows))
    true = truth(nominal)
    for one in fit.estimates:
        assert abs(one.value - true[one.label]) < 4.0 * one.standard_error + 0.005 * one.value, one.label
    assert np.isnan(fit.residuals[1, 2])
    assert not np.isnan(fit.noise[2])
