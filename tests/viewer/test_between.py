"""Between two snapshots a motion goes on evenly, and what jumps stays until the later one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.samples import snapshot, yawed

from dq_marine.algebra.dual_quaternion import dual_multiply, pose_from_parts, pose_position
from dq_marine.algebra.screw import pose_exp
from dq_marine.algebra.spatial import Spatial
from dq_marine.task.things import Column, Thing
from dq_marine.viewer.between import at_even_times, between, picture_count
from dq_marine.viewer.snapshot import Thrust

TWIST = Spatial((0.1, -0.2, 0.9), (0.5, 0.1, -0.05))


def on_a_screw(time: float) -> tuple[np.ndarray, np.ndarray]:
    """Where a body of constant velocity in its own frame is."""
    turned = pose_exp(Spatial(*(tuple(time * value for value in part) for part in TWIST)))
    start = pose_from_parts((0.5, 0.5, 0.5, 0.5), (1.0, 2.0, 5.0))
    pose = dual_multiply(start, turned)
    return np.array(pose_position(pose)), np.array(pose.real)


def test_a_constant_velocity_is_met_exactly() -> None:
    ends = [
        snapshot(time=time, position_ned=position, quaternion_body_to_ned=-attitude if time else attitude)
        for time in (0.0, 1.0)
        for position, attitude in [on_a_screw(time)]
    ]
    for time in (0.1, 0.5, 0.83):
        position, attitude = on_a_screw(time)
        shown = between(*ends, time)
        assert shown.time == time
        assert_allclose(shown.position_ned, position, atol=1e-12)
        assert abs(shown.quaternion_body_to_ned @ attitude) == pytest.approx(1.0, abs=1e-12)


def test_forces_and_water_change_evenly_and_a_goal_jumps() -> None:
    earlier = snapshot(
        goal_position_ned=[0.0, 0.0, 4.0],
        current_ned=[0.0, 0.2, 0.0],
        thrusts=(Thrust(np.array([0.0, 0.2, 0.0]), np.zeros(3)),),
    )
    later = snapshot(
        time=2.0,
        goal_position_ned=[9.0, 0.0, 4.0],
        wrench_body=[4.0, 0, 0, 0, 0, 8.0],
        thrusts=(Thrust(np.array([0.0, 0.2, 0.0]), np.array([4.0, 0.0, 0.0])),),
        current_ned=[0.4, 0.2, 0.0],
    )
    shown = between(earlier, later, 0.5)
    assert_allclose(shown.wrench_body, [1.0, 0, 0, 0, 0, 2.0])
    assert_allclose(shown.current_ned, [0.1, 0.2, 0.0])
    assert_allclose(shown.thrusts[0].force_body, [1.0, 0.0, 0.0])
    assert shown.goal_position_ned is not None
    assert_allclose(shown.goal_position_ned, [0.0, 0.0, 4.0])
    assert between(earlier, later, 0.0) is earlier
    assert between(earlier, later, 2.0) is later


def test_things_travel_unless_another_stands_in_their_place() -> None:
    pillar, tower = Column(1.0, 5.0), Column(2.0, 9.0)
    earlier = snapshot(things=(Thing(pillar), Thing(pillar), Thing(pillar)))
    later = snapshot(
        time=1.0, things=(Thing(pillar, (4.0, 0.0, 2.0), tuple(yawed(1.0))), Thing(tower, (4.0, 0.0, 0.0)))
    )
    moved, *stayed = between(earlier, later, 0.5).things
    assert_allclose(moved.attitude, yawed(0.5))
    assert moved.position_ned[2] == pytest.approx(1.0)
    assert stayed == [Thing(pillar), Thing(pillar)]


@pytest.mark.parametrize(
    ("rate", "expected"),
    [(10.0, np.arange(5) / 10), (5.0, [0.0, 0.2, 0.4]), (25.0, np.arange(11) / 25), (0.1, [0.0])],
)
def test_times_are_even(rate: float, expected: list[float]) -> None:
    recorded = [snapshot(time=3.0 + time) for time in (0.0, 0.1, 0.2, 0.3, 0.4)]
    shown = list(at_even_times(recorded, rate))
    assert_allclose([one.time for one in shown], 3.0 + np.array(expected), atol=1e-9)
    assert len(shown) == picture_count(recorded, rate)


def test_one_snapshot_is_one_picture() -> None:
    only = snapshot(time=2.0)
    assert list(at_even_times([only], 30.0)) == [only]
