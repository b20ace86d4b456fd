"""Meetings of two vessels: how near they come, who gives way, and on which side they pass; in all sectors."""

import math

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from dq_marine.algebra.level import seen_at
from dq_marine.task.colregs import (
    ABAFT,
    AHEAD,
    GIVE_WAY,
    HEAD_ON,
    NO_RULE,
    OVERTAKEN,
    OVERTAKING,
    STAND_ON,
    closest_approach,
    gives_way,
    leaves_to_port,
    meeting,
    passing,
    sight_turns,
)
from dq_marine.task.imazu import IMAZU_CASES
from dq_marine.task.traffic import FAR_ASTERN, MEETINGS, SLOTS, TRAFFIC_DRAWS, Own, met, moved, traffic

NORTH = (1.0, 0.0)
SWAPPED = {
    HEAD_ON: HEAD_ON,
    GIVE_WAY: STAND_ON,
    STAND_ON: GIVE_WAY,
    OVERTAKING: OVERTAKEN,
    OVERTAKEN: OVERTAKING,
}
MIRRORED = {
    HEAD_ON: HEAD_ON,
    GIVE_WAY: STAND_ON,
    STAND_ON: GIVE_WAY,
    OVERTAKING: OVERTAKING,
    OVERTAKEN: OVERTAKEN,
}
angles = st.floats(-math.pi, math.pi)
ratios = st.floats(0.3, 2.5)


def way(angle, length=1.0):
    return (length * math.cos(angle), length * math.sin(angle))


def less(a, b):
    return (a[0] - b[0], a[1] - b[1])


def on_collision_course(heading, ratio, time=10.0):
    """Where another vessel is, and its velocity less one's own, if both are at one place after a time."""
    velocity = less(way(heading, ratio), NORTH)
    return (-time * velocity[0], -time * velocity[1]), velocity


def kind_of(heading, ratio):
    return meeting(NORTH, way(heading), *on_collision_course(heading, ratio))


def clear_of_sectors(heading, offset):
    """Not at the very edge of a sector, nor dead ahead, where round-off decides."""
    bearings = (seen_at(NORTH, offset), seen_at(way(heading), (-offset[0], -offset[1])))
    return all(abs(abs(one) - edge) > 1e-6 for one in bearings for edge in (0.0, AHEAD, ABAFT, math.pi))


@pytest.mark.parametrize("bearing", range(-175, 180, 10))
def test_a_vessel_is_overtaken_by_what_comes_up_from_its_sternlight_sector(bearing):
    """The other at all bearings, at rest over ground but coming nearer: its heading decides who comes from where."""
    offset = way(math.radians(bearing), 5.0)
    towards = less((0.0, 0.0), way(math.radians(bearing), 0.2))
    for heading in range(-177, 180, 10):
        own_seen = math.remainder(bearing + 180.0 - heading, 360.0)
        kind = meeting(NORTH, way(math.radians(heading)), offset, towards)
        if abs(own_seen) > 112.5:
            assert kind == OVERTAKING
        elif abs(bearing) > 112.5:
            assert kind == OVERTAKEN
        elif abs(bearing) <= 10.0 and abs(own_seen) <= 10.0:
            assert kind == HEAD_ON
        else:
            assert kind == (GIVE_WAY if bearing > 0 else STAND_ON)


@given(angles, ratios)
@example(math.pi, 1.0)
def test_the_mirrored_meeting_has_the_mirrored_rule_and_the_other_one_sees_its_counterpart(heading, ratio):
    offset, velocity = on_collision_course(heading, ratio)
    assume(math.hypot(*velocity) > 0.05)
    assume(heading == math.pi or clear_of_sectors(heading, offset))
    kind = meeting(NORTH, way(heading), offset, velocity)
    mirrored = meeting(NORTH, way(-heading), (offset[0], -offset[1]), (velocity[0], -velocity[1]))
    back = ((-offset[0], -offset[1]), (-velocity[0], -velocity[1]))
    assert mirrored == MIRRORED[kind]
    assert meeting(way(heading), NORTH, *back) == SWAPPED[kind]
    if kind != HEAD_ON:  # one of two gives way, in a head-on meeting both
        assert gives_way(kind) + gives_way(SWAPPED[kind]) == 1.0


def test_vessels_that_do_not_come_nearer_are_nothing_to_each_other():
    assert meeting(NORTH, NORTH, (3.0, 4.0), (0.0, 0.0)) == NO_RULE
    assert meeting(NORTH, NORTH, (3.0, 4.0), (0.1, 0.1)) == NO_RULE
    assert gives_way(NO_RULE) == leaves_to_port(NO_RULE) == 0.0


@given(angles, st.floats(0.0, 50.0), angles, st.floats(0.01, 3.0))
def test_the_closest_approach_is_the_least_of_all_distances(bearing, far, course, speed):
    offset, velocity = way(bearing, far), way(course, speed)
    nearest = closest_approach(offset, velocity)
    assert nearest.time >= 0.0
    at = lambda t: math.hypot(offset[0] + t * velocity[0], offset[1] + t * velocity[1])  # noqa: E731
    assert nearest.distance == pytest.approx(at(nearest.time), abs=1e-9)
    for later in (0.0, 0.5 * nearest.time, nearest.time + 1.0, 2.0 * nearest.time + 0.1):
        assert nearest.distance <= at(later) + 1e-9


@given(angles, st.floats(0.0, 50.0), angles, st.floats(0.01, 3.0), st.floats(-20.0, 20.0))
def test_how_two_pass_is_the_same_at_all_times_and_has_the_sign_of_the_turning_bearing(
    bearing, far, course, speed, later
):
    offset, velocity = way(bearing, far), way(course, speed)
    now = passing(offset, velocity, 100.0, 1e4)
    moved = (offset[0] + later * velocity[0], offset[1] + later * velocity[1])
    then = passing(moved, velocity, 100.0, 1e4)
    assert then.distance == pytest.approx(now.distance, abs=1e-9)
    assert then.time == pytest.approx(now.time - later, abs=1e-6)
    if now.time > 0.0:
        nearest = closest_approach(offset, velocity)
        assert abs(now.distance) == pytest.approx(nearest.distance, abs=1e-9)
        assert now.time == pytest.approx(nearest.time)
    if abs(now.distance) > 1e-9:
        assert now.distance * sight_turns(offset, velocity) > 0.0


def test_how_two_pass_is_within_its_bounds_whatever_they_do():
    assert passing((3.0, 4.0), (0.0, 0.0), 10.0, 10.0) == (0.0, 0.0)
    for offset, velocity in (
        ((1e5, 3.0), (-1e-200, 0.0)),
        ((1e5, 3.0), (0.0, 1e-200)),
        ((0.0, 0.0), (1.0, 0.0)),
    ):
        distance, time = passing(offset, velocity, 10.0, 20.0)
        assert abs(distance) <= 10.0
        assert abs(time) <= 20.0


def test_of_vessels_that_keep_their_distance_it_is_that_of_now():
    assert closest_approach((3.0, 4.0), (0.0, 0.0)) == (5.0, 0.0)
    assert math.isfinite(closest_approach((1e5, 0.0), (-1e-300, 0.0)).time)


def test_the_line_of_sight_turns_to_port_where_the_rules_want_it():
    """Port to port in a head-on meeting, and astern of a vessel that crosses from starboard."""
    meeting_head_on = ((10.0, -1.0), (-2.0, 0.0))
    crossing_ahead = ((10.0, 8.0), (-1.0, -1.0))
    assert sight_turns(*meeting_head_on) < 0.0
    assert sight_turns(*crossing_ahead) < 0.0
    for (x, y), (u, v) in (meeting_head_on, crossing_ahead):
        assert sight_turns((x, -y), (u, -v)) > 0.0


KINDS = {
    1: [HEAD_ON],
    2: [GIVE_WAY],
    3: [OVERTAKING],
    4: [STAND_ON],
    5: [HEAD_ON, GIVE_WAY],
    6: [GIVE_WAY, GIVE_WAY],
    7: [OVERTAKING, GIVE_WAY],
    8: [HEAD_ON, STAND_ON],
    9: [GIVE_WAY, GIVE_WAY],
    10: [GIVE_WAY, STAND_ON],
    11: [STAND_ON, GIVE_WAY],
    12: [HEAD_ON, GIVE_WAY, GIVE_WAY],
    13: [HEAD_ON, STAND_ON, STAND_ON],
    14: [GIVE_WAY, GIVE_WAY, GIVE_WAY],
    15: [OVERTAKING, GIVE_WAY, GIVE_WAY],
    16: [STAND_ON, STAND_ON, GIVE_WAY],
    17: [OVERTAKING, STAND_ON, GIVE_WAY],
    18: [GIVE_WAY, GIVE_WAY, GIVE_WAY],
    19: [STAND_ON, GIVE_WAY, GIVE_WAY],
    20: [OVERTAKING, GIVE_WAY, GIVE_WAY],
    21: [GIVE_WAY, STAND_ON, GIVE_WAY],
    22: [OVERTAKING, GIVE_WAY, GIVE_WAY],
}


def test_imazu_has_22_cases_of_known_rules():
    assert len(IMAZU_CASES) == len(KINDS) == 22
    for number, case in enumerate(IMAZU_CASES, start=1):
        assert [kind_of(math.radians(heading), ratio) for heading, ratio in case] == KINDS[number], number


@given(angles, st.floats(-math.pi, math.pi), ratios, st.floats(0.5, 1.5), st.floats(-3.0, 3.0))
def test_a_vessel_is_met_at_its_time_but_for_its_miss(course, heading, ratio, when, miss):
    own = Own(way(course), 2.0, 5.0, 100.0)
    time = when * own.way / own.speed
    there = moved(met(own, heading, ratio, when, miss, 1.0), time).place
    assert math.hypot(*less(there, way(course, when * own.way))) == pytest.approx(abs(miss), abs=1e-9)


@given(st.lists(st.floats(0.0, 1.0, exclude_max=True), min_size=TRAFFIC_DRAWS, max_size=TRAFFIC_DRAWS))
def test_vessels_that_are_drawn_meet_by_the_rule_of_their_row(uniforms):
    own, none = Own(NORTH, 2.0, 5.0, 100.0), ((0.0, 1.0, 0.0),) * SLOTS
    kinds = (HEAD_ON, GIVE_WAY, STAND_ON, OVERTAKING, OVERTAKEN)
    vessels = traffic(own, none, 0.0, 3.0, tuple(uniforms), 0)
    assert sum(one.present for one in vessels) == 1 + int(3.0 * uniforms[0])
    for index, one in enumerate(vessels):
        if one.present:
            kind = kinds[int(len(MEETINGS) * uniforms[1 + 5 * index])]
            relative = less(one.velocity, (own.speed, 0.0))
            assert (one.give_way, one.to_port) == (gives_way(kind), leaves_to_port(kind))
            assert closest_approach(one.place, relative).distance <= 2.0 * own.length
        else:
            assert math.hypot(*one.place) == FAR_ASTERN * own.way
            assert (one.give_way, one.to_port) == (0.0, 0.0)
