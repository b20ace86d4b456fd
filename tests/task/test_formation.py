"""Formations: rigid in the axes of the leader's course, with the velocities that this takes."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import ZERO
from dq_marine.integrator.body import Motion
from dq_marine.task.formation import (
    FOLLOWERS,
    Winding,
    about_place,
    drawn_places,
    keeping,
    make_marches,
    member,
    places_from_own,
)
from dq_marine.task.harmonics import CurvePoint

SPANS = 4
MARCHES = make_marches(SPANS)
WINDING = Winding(20.0, 0.6, 0.1)
SPEED = 1.5


def march(seed=0, spacing=5.0):
    uniforms = tuple(np.random.default_rng(seed).random(MARCHES.draws).tolist())
    return MARCHES.drawn(spacing, (0.0, 0.0, 30.0), WINDING, uniforms, 0)


def test_outside_of_a_bend_one_goes_faster_by_its_radius_and_astern_across():
    radius, rate = 40.0, 0.05  # the leader on a circle to starboard, heading north
    leader = CurvePoint((0.0, 0.0, 7.0), (radius, 0.0, 0.0), (0.0, radius, 0.0))
    assert member(leader, rate, (0.0, -10.0)).velocity_ned == pytest.approx((rate * 50.0, 0.0, 0.0))
    assert member(leader, rate, (0.0, 10.0)).velocity_ned == pytest.approx((rate * 30.0, 0.0, 0.0))
    last = member(leader, rate, (-10.0, 0.0))
    assert last.position_ned == pytest.approx((-10.0, 0.0, 7.0))
    assert last.velocity_ned == pytest.approx((rate * radius, -rate * 10.0, 0.0))


@pytest.mark.parametrize("seed", range(4))
def test_velocities_are_the_derivatives_of_places_and_the_formation_is_rigid(seed):
    here, step = march(seed), 0.01
    for _ in range(40):
        here = MARCHES.onward(here, 1.5)
        before, after = (MARCHES.formation(MARCHES.onward(here, way), SPEED) for way in (-step, step))
        now = MARCHES.formation(here, SPEED)
        everyone = [(*one.others, one.own) for one in (before, now, after)]
        for old, one, new in zip(*everyone, strict=True):
            found = np.subtract(new.position_ned, old.position_ned) * SPEED / (2.0 * step)
            assert one.velocity_ned == pytest.approx(tuple(found), abs=2e-4)
        leader, *rest = [np.array(one.position_ned) for one in everyone[1]]
        assert sorted(np.linalg.norm(one - leader) for one in rest) == pytest.approx(
            [5.0 * math.sqrt(2.0)] * 2 + [10.0]
        )


@pytest.mark.parametrize("seed", range(4))
def test_the_leader_keeps_its_speed(seed):
    here, walked = march(seed), 0.0
    while here.parameter < SPANS - 0.01:
        further = MARCHES.onward(here, 0.15)
        places = [MARCHES.formation(one, SPEED).others[0].position_ned for one in (here, further)]
        assert math.dist(*places) == pytest.approx(0.15, rel=1e-3)
        here, walked = further, walked + 0.15
    assert 0.9 * SPANS < walked / WINDING.leg <= SPANS


def test_a_march_begins_at_its_course_and_ones_own_place_in_it():
    uniforms = tuple(np.random.default_rng(3).random(MARCHES.draws).tolist())
    course, place = MARCHES.first(5.0, uniforms, 0)
    now = MARCHES.formation(MARCHES.drawn(5.0, (1.0, 2.0, 30.0), WINDING, uniforms, 0), SPEED)
    c, s = math.cos(course), math.sin(course)
    assert now.others[0].velocity_ned == pytest.approx((SPEED * c, SPEED * s, 0.0))
    expected = (1.0 + c * place[0] - s * place[1], 2.0 + s * place[0] + c * place[1], 30.0)
    assert now.own.position_ned == pytest.approx(expected)
    assert about_place(place, 0.0, course, uniforms, 0) == pytest.approx(
        (expected[0] - 1.0, expected[1] - 2.0)
    )


@given(st.floats(0.0, 0.999999))
def test_everyone_has_a_place_of_their_own(uniform):
    places = drawn_places(2.0, uniform)
    assert sorted(places) == sorted((2.0 * x, 2.0 * y) for x, y in FOLLOWERS)
    assert places.own == tuple(2.0 * part for part in FOLLOWERS[int(3.0 * uniform)])
    leader, second, third = places_from_own(places)
    assert np.add(leader, places.own) == pytest.approx((0.0, 0.0))
    assert np.add(second, places.own) == pytest.approx(places.second)
    assert np.add(third, places.own) == pytest.approx(places.third)


def test_who_is_in_place_is_off_by_nothing_and_who_is_not_by_its_distance():
    now = MARCHES.formation(MARCHES.onward(march(1), 30.0), SPEED)
    north, east, _ = now.own.velocity_ned
    heading = math.atan2(east, north)
    place = now.own.position_ned
    here = keeping(now, Motion(place, quaternion_from_euler(0.0, 0.0, heading), ZERO))
    assert here == pytest.approx((0.0, 0.0, 5.0 * math.sqrt(2.0)), abs=1e-9)
    off = (place[0] + 0.3, place[1], place[2] + 0.4)
    there = keeping(now, Motion(off, quaternion_from_euler(0.0, 0.0, heading - 0.7), ZERO))
    assert (there.off, there.turned) == pytest.approx((0.5, 0.7))
    assert there.nearest == pytest.approx(min(math.dist(one.position_ned, off) for one in now.others))
