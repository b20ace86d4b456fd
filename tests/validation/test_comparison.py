"""Verdicts, what files of references may say, and a vehicle held against them."""

import json
import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.sweeps import sweep
from typer.testing import CliRunner

import dq_marine.validation
from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.quantities import Quantity
from dq_marine.validation import Line, Verdict, compared, load_references, validated_vehicles
from dq_marine.validation.trials import Expected
from dq_marine.vehicles import load_vehicle, vehicle_names

NUMBERS = st.floats(-1e6, 1e6).filter(lambda x: abs(x) > 1e-6)


def line(got, **expected):
    wanted = Expected.model_validate({"quantity": "speed_m_s", "source": "a trial"} | expected)
    return Line("trial", Quantity("speed_m_s", "speed", got, "m/s"), wanted)


@given(NUMBERS, st.floats(1e-3, 1.0), st.floats(-3.0, 3.0))
def test_a_number_agrees_with_a_value_within_its_share(value, within, share):
    one = line(value * (1.0 + within * share), value=value, within=within)
    if abs(abs(share) - 1.0) > 1e-9:
        assert (one.verdict is Verdict.AGREES) == (abs(share) < 1.0)
        assert abs(one.offset) == pytest.approx(abs(share), abs=1e-9)


@given(NUMBERS, NUMBERS)
def test_a_number_agrees_with_bounds_from_within_them(got, bound):
    assert (line(got, at_most=bound).verdict is Verdict.AGREES) == (got <= bound)
    assert (line(got, at_least=bound).verdict is Verdict.AGREES) == (got >= bound)


@given(st.lists(NUMBERS, min_size=2, max_size=2, unique=True), NUMBERS)
def test_a_number_agrees_between_two_bounds(bounds, got):
    low, high = sorted(bounds)
    if min(abs(got - low), abs(got - high)) > 1e-9 * max(abs(low), abs(high)):
        assert (line(got, at_least=low, at_most=high).verdict is Verdict.AGREES) == (low <= got <= high)


def test_what_was_not_reached_differs_unless_it_is_explained():
    assert line(None, at_most=3.0).verdict is Verdict.DIFFERS
    assert line(None, at_most=3.0, because="it stops before").verdict is Verdict.EXPLAINED
    assert line(2.0, at_most=3.0, because="it stops before").verdict is Verdict.AGREES


def test_every_vehicle_of_the_catalogue_has_references_or_a_reason_for_none():
    assert validated_vehicles() == vehicle_names()
    for name in validated_vehicles():
        references = load_references(name)
        assert references.trial or references.silence
        names = [trial.name for trial in references.trial]
        assert len(set(names)) == len(names)


TRIAL = """
[[trial]]
name = "both propellers at 100 rad/s"
manoeuvre = "steady"
commands = { port = 100.0, starboard = 100.0 }
duration = 20.0
[[trial.expected]]
quantity = "surge_m_s"
value = 2.98
source = "Python Vehicle Simulator"
"""

MISTAKES = {
    "a misspelt key": (TRIAL.replace("duration", "time"), r"time = 20.0: unknown key"),
    "no duration": (TRIAL.replace("duration = 20.0", ""), "duration: missing"),
    "an unknown manoeuvre": (TRIAL.replace("steady", "looping"), "looping"),
    "no source": (TRIAL.replace('source = "Python Vehicle Simulator"', ""), "source: missing"),
    "value and bound": (TRIAL + "at_most = 3.0\n", "a value or bounds, and not both"),
    "nothing to compare with": (TRIAL.replace("value = 2.98", ""), "a value or bounds"),
    "a value of zero": (TRIAL.replace("2.98", "0.0"), "a share of it says nothing"),
    "bounds the wrong way": (
        TRIAL.replace("value = 2.98", "at_least = 3.0\nat_most = 2.0"),
        "is not below at_most",
    ),
    "not a number": (TRIAL.replace("2.98", "nan"), "not a finite number"),
    "no expectations": (TRIAL[: TRIAL.index("[[trial.expected]]")], "expected: missing"),
    "not TOML": ("[[trial", "not a file of references"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_wrong_file_is_refused(tmp_path, name):
    content, message = MISTAKES[name]
    file = tmp_path / "trials.toml"
    file.write_text(content)
    with pytest.raises(InvalidInputError, match=message):
        load_references(file)


def test_a_file_that_is_none_or_too_large_is_refused(tmp_path):
    with pytest.raises(InvalidInputError, match=r"there are no references 'nothing'.*otter"):
        load_references("nothing")
    large = tmp_path / "large.toml"
    large.write_text("# " + "x" * 1_000_000)
    with pytest.raises(InvalidInputError, match="more than 1000000 bytes"):
        load_references(large)


def test_a_channel_or_a_quantity_that_there_is_not_is_refused(tmp_path):
    file = tmp_path / "trials.toml"
    file.write_text(TRIAL.replace("port =", "middle ="))
    with pytest.raises(
        InvalidInputError, match=r"commands of 'middle': Otter has no such channel; it has port"
    ):
        compared("otter", load_vehicle("otter"), load_references(file).trial)


def test_all_vehicles_are_there_before_the_first_is_simulated(tmp_path, monkeypatch):
    monkeypatch.setattr(dq_marine.validation, "compared", None)
    (tmp_path / "page").write_text("a file")
    for arguments, message in (
        (
            ["osv83", "no_such_vehicle"],
            "there are no references 'no_such_vehicle'|no vehicle 'no_such_vehicle'",
        ),
        (
            ["supply_vessel", "otter", "--radiation", "memory"],
            "'Otter' has no added mass and damping by freq",
        ),
        (["osv83", "--out", str(tmp_path / "page")], "page.* cannot be written: File exists"),
    ):
        result = CliRunner().invoke(app, ["validate", *arguments])
        assert result.exit_code == 1
        assert re.search(message, " ".join(result.stderr.split()))


def test_the_command_holds_a_vehicle_against_a_file_of_ones_own(tmp_path):
    """The speed of both propellers at 100 rad/s; a reference that is 10 % off makes the command fail."""
    file = tmp_path / "trials.toml"
    file.write_text(TRIAL)
    runner = CliRunner()
    given_file = ["validate", "otter", "--references", str(file)]
    agreeing = runner.invoke(app, [*given_file, "--out", str(tmp_path / "page")])
    assert agreeing.exit_code == 0, agreeing.output
    assert "agrees" in agreeing.stdout
    page = (tmp_path / "page" / "README.md").read_text()
    assert "| both propellers at 100 rad/s | surge | 2.98" in page
    assert (tmp_path / "page" / "otter.png").stat().st_size > 1000
    file.write_text(TRIAL.replace("2.98", "3.3"))
    differing = runner.invoke(app, [*given_file, "--json"])
    assert differing.exit_code == 1
    (found,) = json.loads(differing.stdout)["otter"]
    assert found["verdict"] == "differs"
    assert math.isclose(found["value"], 2.98, rel_tol=0.01)


@pytest.mark.sweep
def test_the_command_lets_a_vehicle_make_its_waves_by_memory(tmp_path):
    """The period of roll is 2.5 % longer: that of the pole in test_decay.py."""
    file = tmp_path / "trials.toml"
    file.write_text(
        '[[trial]]\nname = "roll"\nmanoeuvre = "decay"\nmotion = "roll"\nrelease = 0.1\n'
        '[[trial.expected]]\nquantity = "period_s"\nvalue = 10.46\nwithin = 0.01\nsource = "its pole"\n'
    )
    for radiation, status in (("memory", 0), ("constant", 1)):
        arguments = ["supply_vessel", "--references", str(file), "--radiation", radiation]
        result = CliRunner().invoke(app, ["validate", *arguments])
        assert result.exit_code == status, result.output


@pytest.mark.parametrize("name", sweep(validated_vehicles(), plain=["otter"]))
def test_no_number_of_the_catalogue_differs_unexplained(name):
    comparison = compared(name, load_vehicle(name), load_references(name).trial)
    assert [one for one in comparison.lines if one.verdict is Verdict.DIFFERS] == []
