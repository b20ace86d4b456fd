"""In steps that are too large for RK4 it blows up and the integrator does not; in smaller ones both go the same way."""

from __future__ import annotations

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.report.blow_up import CASE, FARTHEST, OWN, RAN_AWAY, RK4, Run, blow_up
from dq_marine.report.cases import CASES
from dq_marine.report.trial import BLEW_UP, DONE


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return blow_up()


def test_only_rk4_in_large_steps_fails(runs: list[Run]) -> None:
    own, rk4, exact = runs
    assert (own.method, rk4.method, exact.method) == (OWN, RK4, RK4)
    assert own.step == rk4.step == 50 * exact.step
    assert own.outcome == exact.outcome == DONE
    assert rk4.outcome in (RAN_AWAY, BLEW_UP)
    assert rk4.steps < own.steps
    assert rk4.fastest > 1e3 * exact.fastest
    assert own.fastest == pytest.approx(exact.fastest, rel=0.1)


def test_all_begin_at_one_place_and_end_when_their_captions_say(runs: list[Run]) -> None:
    for run in runs:
        begun = run.flight.snapshots[0]
        assert begun.position_ned.tolist() == runs[0].flight.snapshots[0].position_ned.tolist()
        assert run.flight.end == pytest.approx(run.steps * run.step)
        assert f"{run.steps}" in run.flight.caption
        assert all(np.abs(one.position_ned).max() <= FARTHEST for one in run.flight.snapshots)


def test_rk4_fails_beyond_its_bound_of_stability_by_the_speed_before(runs: list[Run]) -> None:
    """Of surge, with the quadratic damping at that speed, h lambda is beyond 2.785 before the failure."""
    _, rk4, exact = runs
    physics = CASES[CASE].physics

    def stiffness(
        speed: float,
    ) -> float:  # of surge, about a speed: the slope of d1 v + d2 |v| v, over its mass
        return float((physics.linear[0, 0] + 2.0 * physics.quadratic[0] * speed) / physics.mass_matrix[0, 0])

    speeds = np.asarray(rk4.flight.plots["speed [m/s]"])
    assert rk4.step * stiffness(speeds[-2]) > 2.785
    assert exact.step * stiffness(exact.fastest) < 2.785


def test_in_small_steps_both_go_the_same_way() -> None:
    own, rk4, exact = blow_up(0.05, 2.0)
    assert own.outcome == rk4.outcome == DONE
    places = [run.flight.snapshots[-1].position_ned for run in (own, rk4, exact)]
    assert np.abs(places[1] - places[2]).max() < 1e-4
    assert np.abs(places[0] - places[2]).max() < 0.02


@pytest.mark.parametrize(
    ("step", "duration"), [(-0.1, 1.0), (np.nan, 1.0), (0.5, 0.1), (0.5, 1e9), (1e-9, 10.0)]
)
def test_steps_that_make_no_sense_are_refused(step: float, duration: float) -> None:
    with pytest.raises(InvalidInputError, match="step"):
        blow_up(step, duration)
