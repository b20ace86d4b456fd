"""References agree with closed forms and with separately written equations, and are kept on disk by what made them."""

import json
from dataclasses import replace

import numpy as np
import pytest
from support.fossen import solve

from dq_marine.physics.term import ForceTerm
from dq_marine.report import references as module
from dq_marine.report.cases import CASES
from dq_marine.report.closed_forms import BroadsideTurn, FreeTop, incomplete_third_kind, quaternion_matrix
from dq_marine.report.end_state import EndState, errors
from dq_marine.report.references import path_of, reference, references

KNOWN_TO = {"dzhanibekov": 2e-10, "damped_bluerov2": 2e-11}
"""The middle axis magnifies round-off a hundred thousand times; |nu| nu has a kink wherever a velocity passes zero."""


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))
    return tmp_path / "references"


SHORT = replace(CASES["kirchhoff_bluerov2"], duration=1.0)


# Closed forms


def test_the_free_top_is_where_it_is_known_to_be_after_300_seconds():
    spin = (np.pi / 10.0, np.pi / 6.0, np.pi / 8.0)
    top = FreeTop((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, *spin))
    end = top(300.0)
    assert np.allclose(
        end.velocity[3:], (0.340963036213871, 0.506552988101689, 0.400082264188401), atol=1e-14
    )
    q = np.array([0.67496667, -0.15865779, -0.47614467, -0.54086408])
    assert min(np.abs(end.quaternion - q).max(), np.abs(end.quaternion + q).max()) < 1e-8
    assert np.allclose(top(15.0065630564892).velocity[3:], spin, rtol=0, atol=1e-13)  # its period


def test_dzhanibekovs_nut_flips_when_it_should():
    exact = CASES["dzhanibekov"].exact
    assert np.allclose(exact(2.0 * 11.5780256043045).velocity[3:], (0.01, 2.0, 0.0), rtol=0, atol=1e-11)


def test_the_spheroid_is_where_it_is_known_to_be():
    """The pendulum of the tests of closed forms, in the horizontal plane: x along P, y for -z."""
    m1, m2, inertia, angle = 35.393878242844494, 60.86052274, 2.79541877, np.pi / 2.0 - 0.6
    turn = BroadsideTurn(m1, m2, inertia, np.cos(angle), -m1 * np.sin(angle) / m2)
    end = turn(1.0)
    heading = 2.0 * np.arctan2(end.quaternion[3], end.quaternion[0])  # from the start, where it was `angle`
    c, s = np.cos(angle), np.sin(angle)
    along, across = c * end.position[0] - s * end.position[1], s * end.position[0] + c * end.position[1]
    assert np.mod(heading + angle, 2.0 * np.pi) == pytest.approx(1.87901600152329, abs=1e-9)
    assert (along, across) == pytest.approx((0.63734700192725, 0.08657478932112), abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_spheroid_turns_to_either_side_alike(side):
    ends = [BroadsideTurn(35.0, 60.0, 2.8, 1.0, sway)(3.0) for sway in (0.05, side * 0.05)]
    mirror = np.array([1.0, side, 1.0])
    assert np.allclose(ends[1].position, mirror * ends[0].position, rtol=0, atol=1e-14)
    assert np.allclose(
        ends[1].velocity[[0, 1, 5]], ends[0].velocity[[0, 1, 5]] * [1.0, side, side], atol=1e-13
    )


@pytest.mark.parametrize("amplitude", [0.3, 1.5, 4.0, -7.0])
def test_the_integral_of_the_third_kind(amplitude):
    from scipy.integrate import quad

    n, m = -0.7, 0.4
    expected = quad(
        lambda t: 1.0 / ((1.0 - n * np.sin(t) ** 2) * np.sqrt(1.0 - m * np.sin(t) ** 2)), 0.0, amplitude
    )
    assert incomplete_third_kind(n, amplitude, m) == pytest.approx(expected[0], rel=1e-12)


# References


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.slow, pytest.mark.sweep])
        if name.endswith(("x30", "x1000"))
        else name
        for name in CASES
    ],
)
def test_two_solutions_agree_at_the_end_of_every_case(name):
    assert max(reference(CASES[name]).error) < KNOWN_TO.get(name, 5e-12)


@pytest.mark.parametrize("name", ["kirchhoff_bluerov2", "kirchhoff_remus", "coupled_rexrov", "heavy_top"])
def test_references_agree_with_separately_written_equations(name, cache):
    case = replace(CASES[name], duration=2.0)
    start = case.position, case.quaternion, case.velocity
    position, rotation, velocity = solve(
        case.physics.mass_matrix, *start, case.duration, arm=case.physics.arm, rtol=3e-14
    )
    end = reference(case).end
    assert np.allclose(end.position, position, rtol=0, atol=1e-11)
    assert np.allclose(quaternion_matrix(end.quaternion), rotation, rtol=0, atol=1e-11)
    assert np.allclose(end.velocity, velocity, rtol=0, atol=1e-11)


def test_references_at_several_times_are_those_at_each(cache):
    together = references(SHORT, (0.25, 0.5, 1.0))
    assert [each.time for each in together] == [0.25, 0.5, 1.0]
    for each in together:
        alone = reference(replace(SHORT, duration=each.time))
        assert max(errors(alone.end, each.end)) < 1e-12
        assert "DOP853" in each.source


def test_errors_are_angles_and_distances():
    start = EndState(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(6))
    half = 0.5e-9
    end = EndState(
        np.array([3.0, 4.0, 0.0]), -np.array([np.cos(half), np.sin(half), 0.0, 0.0]), np.full(6, 1.0)
    )
    assert errors(end, start) == pytest.approx((5.0, 1e-9, np.sqrt(6.0)), rel=1e-12)


# On disk


def forbid_solving(monkeypatch):
    def solved(*arguments, **named):
        raise AssertionError("solved again")

    monkeypatch.setattr(module, "solved", solved)


def same(one, other):
    return all(map(np.array_equal, one.end, other.end)) and one[2:] == other[2:]


def test_a_reference_is_solved_once_and_read_back_bit_for_bit(cache, monkeypatch):
    made = reference(SHORT)
    forbid_solving(monkeypatch)
    assert same(reference(SHORT), made)
    assert [path.name.split("-")[0] for path in cache.iterdir()] == ["kirchhoff_bluerov2"]


def push(parameters, pose, time):
    return SHORT  # never called


def changes():
    physics = SHORT.physics
    heavier = replace(physics, mass_matrix=physics.mass_matrix * 1.0001)
    forced = replace(physics, forces=(ForceTerm("push", push, (1.0,)),))
    forced_otherwise = replace(physics, forces=(ForceTerm("push", push, (2.0,)),))
    return [
        SHORT,
        replace(SHORT, duration=1.1),
        replace(SHORT, velocity=SHORT.velocity * 1.0001),
        replace(SHORT, wrench=np.full(6, 0.1)),
        replace(SHORT, stiff=True),
        *(replace(SHORT, physics=changed) for changed in (heavier, forced, forced_otherwise)),
    ]


def test_what_changes_a_motion_changes_its_file(cache, monkeypatch):
    paths = {path_of(case, (case.duration,)) for case in changes()}
    paths.add(path_of(SHORT, (0.5, 1.0)))
    monkeypatch.setattr(module, "scipy_version", lambda: "0.0")
    paths.add(path_of(SHORT, (1.0,)))
    assert len(paths) == len(changes()) + 2


def test_other_equations_change_the_file(cache, monkeypatch):
    before = path_of(SHORT, (1.0,))
    monkeypatch.setattr(module, "text_of", lambda function: b"other")
    assert path_of(SHORT, (1.0,)) != before


def cut(text):
    return text[: len(text) // 2]


def without_numbers(text):
    return text.replace('"position"', '"place"')


def not_finite(text):
    kept = json.loads(text)
    kept[0]["end"]["position"][0] = None
    return json.dumps(kept)


def of_another_time(text):
    kept = json.loads(text)
    kept[0]["time"] = 2.0
    return json.dumps(kept)


@pytest.mark.parametrize("damage", [cut, without_numbers, not_finite, of_another_time, lambda text: "[3]"])
def test_a_damaged_file_is_made_anew(damage, cache):
    made = reference(SHORT)
    (path,) = cache.iterdir()
    whole = path.read_text()
    path.write_text(damage(whole))
    assert same(reference(SHORT), made)
    assert path.read_text() == whole


def test_a_cache_that_cannot_be_written_does_no_harm(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path / "file"))
    assert max(reference(SHORT).error) < 1e-12
