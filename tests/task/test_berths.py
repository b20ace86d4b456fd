"""Berths: vessels and walls are where rotation matrices and polygons have them; slow contact is borne, fast is not."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.berths import (
    Berth,
    Box,
    Harbour,
    Limits,
    abeam,
    before_berth,
    berthing_kept,
    contact_speed_of,
    drawn_berth,
    first_berthing,
    from_berth,
    room_left,
)
from dq_marine.task.world.pillars import Hull

HARBOUR = Harbour(Hull(half_length=10.0, half_beam=2.0), clearance=0.5, pier=15.0, basin=18.0, thickness=4.0)
OPEN = HARBOUR._replace(pier=0.0)
BOX, LIMITS = Box(along=2.0, clearance=1.0, angle=0.1, speed=0.2), Limits(speed=0.15, give=0.4)
ANGLE = st.floats(-math.pi, math.pi)
UNIFORM = st.floats(0.0, 1.0, exclude_max=True)
PERIOD = 0.5


@st.composite
def berths(draw):
    return drawn_berth((draw(UNIFORM), draw(UNIFORM)), 0)


def vessel(harbour, berth, along, off, turn=0.0, velocity=(0.0, 0.0), turn_rate=0.0):
    """A vessel at a place before a berth, turned to starboard of it, which moves along and away from the quay."""
    heading = math.atan2(berth.east, berth.north) + turn
    aside = from_berth(harbour, berth, velocity[0], velocity[1] + abeam(harbour))  # the origin is left out
    level = Rotation.from_euler("Z", heading).inv().apply((*aside, 0.0))
    return Motion(
        (*from_berth(harbour, berth, along, off), 0.0),
        quaternion_from_euler(0.0, 0.0, heading),
        Spatial((0.0, 0.0, turn_rate), tuple(level)),
    )


def rectangle(low, high):
    """Corners of a rectangle, in turn, shape (4, 2)."""
    return np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])


def distance_of_edges(one, other):
    """The least distance of the outlines of two polygons that are apart: of all their edges, densely sampled."""
    shares = np.linspace(0.0, 1.0, 201)[:, None]
    a = np.vstack([p + shares * (q - p) for p, q in zip(one, np.roll(one, -1, axis=0), strict=True)])
    b = np.vstack([p + shares * (q - p) for p, q in zip(other, np.roll(other, -1, axis=0), strict=True)])
    return np.sqrt(((a[:, None] - b[None]) ** 2).sum(axis=-1)).min()


def within(polygon, points):
    """Whether points are within a convex polygon that runs anticlockwise."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    off = points[:, None] - polygon[None]
    return (edges[:, 0] * off[..., 1] - edges[:, 1] * off[..., 0] > 0.0).all(axis=1)


@given(
    berths(),
    st.floats(-200.0, 200.0),
    st.floats(0.0, 100.0),
    ANGLE,
    st.floats(-3.0, 3.0),
    st.floats(-3.0, 3.0),
)
def test_a_vessel_is_before_its_berth_where_it_was_put(berth, along, off, turn, ahead, away):
    own = before_berth(HARBOUR, berth, vessel(HARBOUR, berth, along, off, turn, (ahead, away)))
    assert own.place == pytest.approx((along, off), abs=1e-9)
    assert own.speed == pytest.approx(math.hypot(ahead, away), abs=1e-9)
    assert math.cos(own.off_parallel - turn) == pytest.approx(1.0, abs=1e-9)
    assert own.bow == pytest.approx((math.cos(turn), -berth.side * math.sin(turn)), abs=1e-9)


@given(berths())
def test_the_moored_vessel_is_at_the_origin_with_the_quay_on_the_side_that_is_said(berth):
    own = before_berth(HARBOUR, berth, vessel(HARBOUR, berth, 0.0, abeam(HARBOUR)))
    assert from_berth(HARBOUR, berth, 0.0, abeam(HARBOUR)) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert own.place == pytest.approx((0.0, 2.5), abs=1e-12)
    quay = from_berth(HARBOUR, berth, 0.0, 0.0)
    assert berth.north * quay[1] - berth.east * quay[0] == pytest.approx(2.5 * berth.side)


@given(berths(), st.floats(-40.0, 40.0), st.floats(2.0, 40.0), ANGLE)
def test_the_room_to_the_walls_is_the_least_distance_of_outlines(berth, along, off, turn):
    bow, side = np.array((math.cos(turn), -berth.side * math.sin(turn))), np.array((0.0, 1.0))
    side = np.array((-bow[1], bow[0]))
    hull = np.array([(along, off) + x * bow + y * side for x, y in rectangle((-10.0, -2.0), (10.0, 2.0))])
    piers = [rectangle((18.0, 0.0), (22.0, 15.0)), rectangle((-22.0, 0.0), (-18.0, 15.0))]
    dense = np.vstack(
        [
            p + np.linspace(0.0, 1.0, 50)[:, None] * (q - p)
            for p, q in zip(hull, np.roll(hull, -1, 0), strict=True)
        ]
    )
    assume(hull[:, 1].min() > 0.0)
    for pier in piers:
        assume(not within(pier, dense).any() and not within(hull, pier).any())
    least = min(hull[:, 1].min(), *(distance_of_edges(hull, pier) for pier in piers))
    room = room_left(HARBOUR, berth, vessel(HARBOUR, berth, along, off, turn))
    assert least - 0.15 <= room <= least + 1e-9


@given(berths(), st.floats(-100.0, 100.0), st.floats(3.0, 50.0), st.floats(-1.0, 1.0))
def test_without_piers_the_nearest_corner_is_as_far_as_trigonometry_says(berth, along, off, turn):
    room = room_left(OPEN, berth, vessel(OPEN, berth, along, off, turn))
    assert room == pytest.approx(off - 10.0 * abs(math.sin(turn)) - 2.0 * math.cos(turn), abs=1e-9)


def kept(berth, before, **now):
    motion = vessel(OPEN, berth, **now)
    return berthing_kept(OPEN, BOX, LIMITS, berth, before, motion, PERIOD)


@pytest.mark.parametrize("berth", [Berth(1.0, 0.0, 1.0), Berth(0.6, 0.8, -1.0)])
@pytest.mark.parametrize(("speed", "struck"), [(0.14, 0.0), (0.16, 1.0)])
def test_only_a_hull_that_touches_fenders_faster_than_they_bear_strikes_the_quay(berth, speed, struck):
    before = first_berthing(OPEN, berth, vessel(OPEN, berth, along=0.0, off=2.0 + 0.4 * speed * PERIOD))
    after = kept(berth, before, along=0.0, off=2.0 - 0.6 * speed * PERIOD, velocity=(0.0, -speed))
    assert after.impact_speed == pytest.approx(speed)
    assert after.clearance == pytest.approx(-0.6 * speed * PERIOD)
    assert after.struck == struck
    assert kept(berth, after, along=0.0, off=2.1).struck == struck  # it is not forgotten


def test_fenders_that_are_pressed_in_too_far_are_struck_however_slowly():
    berth = Berth(1.0, 0.0, 1.0)
    before = first_berthing(OPEN, berth, vessel(OPEN, berth, along=0.0, off=1.61))
    assert kept(berth, before, along=0.0, off=1.605).struck == 0.0
    assert kept(berth, before, along=0.0, off=1.595).struck == 1.0


def test_a_bow_that_turns_into_the_quay_strikes_it_with_its_corner():
    berth = Berth(1.0, 0.0, 1.0)
    before = first_berthing(OPEN, berth, vessel(OPEN, berth, along=0.0, off=3.0, turn=0.09))
    after = kept(berth, before, along=0.0, off=3.0, turn=0.12, turn_rate=0.06)
    assert after.struck == 1.0
    assert after.impact_speed == pytest.approx(10.0 * math.cos(0.105) * 0.06, rel=0.03)


def test_a_hull_that_is_side_on_to_a_piers_head_strikes_it_between_its_corners():
    berth = Berth(1.0, 0.0, 1.0)
    motion = vessel(HARBOUR, berth, along=20.0, off=16.9)
    assert room_left(HARBOUR, berth, motion) == pytest.approx(-0.1)


@pytest.mark.parametrize(
    "off_it",
    [{"along": 2.1}, {"off": 3.3}, {"turn": 0.11}, {"velocity": (0.21, 0.0)}],
    ids=["along", "off", "turned", "too fast"],
)
def test_time_alongside_counts_only_within_the_whole_box(off_it):
    berth = Berth(0.0, 1.0, -1.0)
    inside = {"along": 1.5, "off": 2.6, "turn": 0.02, "velocity": (0.1, 0.0)}
    begun = first_berthing(OPEN, berth, vessel(OPEN, berth, **inside))
    once = kept(berth, begun, **inside)
    assert kept(berth, once, **inside).alongside == 2.0 * PERIOD
    assert kept(berth, once, **{**inside, **off_it}).alongside == 0.0


def test_large_ships_come_alongside_at_half_the_speed_of_small_ones():
    assert contact_speed_of(80.0, 5.0) == contact_speed_of(100.0, 5.0) == 0.2
    assert contact_speed_of(160.0, 5.0) == pytest.approx(0.125)
    assert contact_speed_of(200.0, 5.0) == contact_speed_of(320.0, 5.0) == 0.1
    assert contact_speed_of(2.0, 1.5) == pytest.approx(0.15)
