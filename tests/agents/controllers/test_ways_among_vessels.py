"""What ways among vessels cost: in loops that are compiled, as arrays written apart, and where it is plain to see."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.agents.controllers.velocity_obstacles import BEYOND_SAFE, ON_ROUTE, CourseChoice
from dq_marine.agents.controllers.ways_among_vessels import (
    Distances,
    Others,
    Own,
    compare_ways,
    compiled_comparison,
)

DISTANCES = Distances(*(1.5 + beyond for beyond in BEYOND_SAFE))
COURSES = np.radians([0.0, 20.0, 45.0, 100.0, -20.0, -60.0])
TIMES = 0.5 * np.arange(1, 91)


def others(*rows: tuple[float, float, float, float, bool, bool]) -> Others:
    """Return vessels from places, velocities and rules, a row each."""
    numbers = np.array([row[:4] for row in rows], dtype=float).reshape(-1, 4)
    rules = np.array([row[4:] for row in rows], dtype=bool).reshape(-1, 2)
    return Others(*(np.ascontiguousarray(part) for part in (numbers[:, :2], numbers[:, 2:], *rules.T)))


def compared(compare: Any, own: Own, speed: float, met: Others) -> tuple[np.ndarray, np.ndarray]:
    risk, lasting = np.empty(len(COURSES) + 1), np.empty(len(COURSES) + 1)
    compare(own, speed, COURSES, met, DISTANCES, risk, lasting)
    return risk, lasting


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def expected(own: Own, speed: float, met: Others) -> tuple[np.ndarray, np.ndarray]:
    """All ways, times and vessels at once; arrays have the shape (ways, vessels, times, 2)."""
    change = own.braking * TIMES
    pace = own.speed + np.clip(speed - own.speed, -change, change)
    gone = 0.5 * np.cumsum(pace)
    back = -np.arctan(own.starboard / 5.0 * np.exp(-gone / 5.0))
    turn = np.vstack([back, np.broadcast_to(COURSES[:, None], (len(COURSES), 90))]) - own.course
    reach = own.fastest * np.maximum(
        0.0, gone - 1.0 + np.clip(np.sign(turn) * own.turning / own.fastest, 0.0, 1.0)
    )
    heading = own.course + np.clip(turn, -reach, reach)
    velocity = np.stack([pace * np.cos(heading), pace * np.sin(heading)], axis=-1)[:, None]
    way = 0.5 * np.cumsum(velocity, axis=2)
    theirs = met.velocities[None, :, None]
    offset = met.places[None, :, None] + theirs * TIMES[:, None] - way

    def clear(offset: np.ndarray, relative: np.ndarray) -> np.ndarray:
        closing, turning = -np.sum(offset * relative, axis=-1), cross(offset, relative)
        wide = np.abs(turning) > DISTANCES.free * np.linalg.norm(relative, axis=-1)
        right = ~(met.to_port[None, :, None] & (turning > 0.0))
        return np.where(closing > 0.0, wide & right, np.linalg.norm(offset, axis=-1) > DISTANCES.free)

    starboard = own.starboard + way[..., 1]
    sighted = -np.arctan(starboard / 5.0)
    later = offset + 10.0 * (theirs - [1.0, 0.0]) + np.stack([np.zeros_like(starboard), starboard], axis=-1)
    home = theirs - np.stack([np.cos(sighted), np.sin(sighted)], axis=-1)
    free = (clear(offset, home) & clear(later, theirs - [1.0, 0.0])).all(axis=1)
    until = np.where(free.any(axis=1), np.argmax(free, axis=1), 89)
    lasting = TIMES[until]
    if speed == 1.0:
        until[0] = 89
    distance = np.where(np.arange(90) <= until[:, None, None], np.linalg.norm(offset, axis=-1), np.inf)
    when = np.argmin(distance, axis=2)
    nearest = np.min(distance, axis=2)
    turning = np.take_along_axis(cross(offset, theirs - velocity), when[..., None], axis=2)[..., 0]
    near = 30.0 * np.maximum(0.0, 1.0 - nearest / 4.0) + 1000.0 * np.maximum(0.0, 1.0 - nearest / 2.2)
    counts = met.give_way | (TIMES[when] < 15.0)
    wrong = met.to_port & (turning > 0.0) & (when > 0) & (when < until[:, None])
    return (np.where(counts, near, 0.0) + 60.0 * wrong).sum(axis=1), lasting


metres = st.floats(-30.0, 30.0)
speeds = st.floats(-1.5, 1.5)
vessels = st.lists(st.tuples(metres, metres, speeds, speeds, st.booleans(), st.booleans()), max_size=3)
owns = st.builds(
    Own,
    course=st.floats(-1.5, 1.5),
    speed=st.floats(0.3, 1.2),
    turning=st.floats(-0.4, 0.4),
    fastest=st.floats(0.1, 0.6),
    braking=st.floats(0.0, 0.3),
    starboard=st.floats(-8.0, 8.0),
)


@given(owns, st.sampled_from([1.0, 0.5]), vessels)
def test_loops_and_arrays_agree(own, speed, rows):
    met = others(*rows)
    found, wanted = compared(compiled_comparison(), own, speed, met), expected(own, speed, met)
    # Where round-off decides between two steps, or on which side of a bound a way lies, they may differ.
    alike = np.isclose(found[0], wanted[0], rtol=1e-9, atol=1e-9) & np.isclose(found[1], wanted[1])
    assert alike.mean() >= 0.5


def test_they_agree_to_round_off_where_nothing_is_on_a_bound():
    rng = np.random.default_rng(0)
    for _ in range(300):
        own = Own(*rng.uniform([-1.0, 0.4, -0.3, 0.2, 0.0, -6.0], [1.0, 1.1, 0.3, 0.6, 0.3, 6.0]))
        rows = [
            (*rng.uniform(-30, 30, 2), *rng.uniform(-1, 1, 2), *(rng.random(2) < 0.5))
            for _ in range(rng.integers(4))
        ]
        for speed in (1.0, 0.5):
            found, wanted = (
                compared(compiled_comparison(), own, speed, others(*rows)),
                expected(own, speed, others(*rows)),
            )
            np.testing.assert_allclose(found[0], wanted[0], rtol=1e-10, atol=1e-10)
            np.testing.assert_array_equal(found[1], wanted[1])


@given(owns, vessels)
def test_compiled_and_plain_loops_give_the_same_bits(own, rows):
    for ours, plain in zip(
        compared(compiled_comparison(), own, 1.0, others(*rows)),
        compared(compare_ways, own, 1.0, others(*rows)),
        strict=True,
    ):
        np.testing.assert_array_equal(ours, plain)


STRAIGHT = Own(course=0.0, speed=1.0, turning=0.0, fastest=0.4, braking=0.1, starboard=0.0)


def test_without_others_no_way_costs_and_the_way_back_is_free_at_once():
    risk, lasting = compared(compiled_comparison(), STRAIGHT, 1.0, others())
    assert not risk.any()
    np.testing.assert_array_equal(lasting, 0.5)


def test_going_on_towards_a_vessel_head_on_costs_most_and_turning_to_starboard_nothing():
    risk, _ = compared(compiled_comparison(), STRAIGHT, 1.0, others((30.0, 0.0, -1.0, 0.0, True, True)))
    assert risk[0] == risk[1] == pytest.approx(1030.0)  # the route, and its course: they meet in the middle
    assert risk[2] == risk[3] == 0.0
    assert (risk[5:] >= 60.0).all()  # to port: it is passed on the wrong side


def test_for_a_vessel_that_gives_way_one_acts_late():
    meets = lambda far: others((far, far, 0.0, -1.0, False, False))  # noqa: E731
    early, _ = compared(compiled_comparison(), STRAIGHT, 1.0, meets(20.0))
    late, _ = compared(compiled_comparison(), STRAIGHT, 1.0, meets(10.0))
    assert early[1] == 0.0
    assert late[1] == pytest.approx(1030.0)


def test_who_asks_for_more_distance_keeps_more():
    chosen = {}
    for safe in (1.5, 3.0):
        met = others((30.0, 3.2, -1.0, 0.0, True, False))
        chosen[safe] = CourseChoice(safe).choose(STRAIGHT, met)
    assert chosen[1.5] != chosen[3.0]
    assert abs(chosen[3.0].course) >= math.radians(20.0)
    assert CourseChoice(1.5).choose(STRAIGHT, others()) == ON_ROUTE
