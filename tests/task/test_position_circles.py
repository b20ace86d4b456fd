"""Circles of position: the partner is on all of them, wherever both have gone since, as far as it was told."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.level import level_bow
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Heard, Link, Message, packet_told
from dq_marine.task.hearing import partner_link
from dq_marine.task.position_circles import CIRCLES, SPACING, Plot, circles_told, empty_plot, plotted

PERIOD, SLOT, LATE = 0.1, 20, 3  # [s], [periods], [periods]: packets are understood so much later
FAR = 1e3
TELLING = partner_link(0.0, 0.0, "course", 0.0, SLOT * PERIOD)
SILENT = partner_link(0.0, 0.0, "none", 0.0, SLOT * PERIOD)

speeds = st.floats(-2.0, 2.0)
places = st.floats(-50.0, 50.0)


class Meeting:
    """A partner that goes straight on, and a vehicle that turns as it goes, heard as the sound leaves."""

    def __init__(self, place: list[float], velocity: list[float], turn: float, speed: float) -> None:
        self.place, self.velocity = np.array(place), np.array([*velocity, 0.0])
        self.turn, self.speed = turn, speed
        self.own = np.array([0.0, 0.0, 10.0])
        self.heading = 0.0
        self.nearest = math.inf

    def motion(self) -> Motion:
        """The vehicle's, rolled and pitched."""
        attitude = quaternion_from_euler(0.2, -0.1, self.heading)
        going = (self.speed * math.cos(self.heading), self.speed * math.sin(self.heading), 0.0)
        return Motion(tuple(self.own), attitude, Spatial((0.0, 0.0, 0.0), rotate_inverse(attitude, going)))

    def go_on(self) -> None:
        """Let a control period pass, at whose end velocities are those of the period."""
        self.heading += PERIOD * self.turn
        self.own += PERIOD * self.speed * np.array([math.cos(self.heading), math.sin(self.heading), 0.0])
        self.place = self.place + PERIOD * self.velocity

    def packet(self) -> Heard:
        """What is sent now."""
        self.nearest = min(self.nearest, math.dist(self.place[:2], self.own[:2]))
        speed = math.hypot(*self.velocity)
        course = (self.velocity[0] / speed, self.velocity[1] / speed) if speed else (1.0, 0.0)
        message = Message((0.0, 0.0), self.place[2], course, speed)
        return Heard(math.dist(self.place, self.own), 0.0, 1.0, message)


def flown(meeting: Meeting, link: Link, periods: int) -> Plot:
    """The plot at the end."""
    nothing = Message((0.0, 0.0), 0.0, (1.0, 0.0), 0.0)
    plot, last, under_way = empty_plot(), Heard(0.0, 60.0, 0.0, nothing), None
    for period in range(1, periods + 1):
        meeting.go_on()
        last = last._replace(age=min(60.0, last.age + PERIOD))
        if period % SLOT == 0:
            under_way = meeting.packet()
        heard = period % SLOT == LATE and under_way is not None
        if heard:
            last = under_way._replace(age=LATE * PERIOD)
        plot = plotted(link, plot, heard, last, meeting.motion(), PERIOD)
    return plot


def circles(plot: Plot, bow: tuple[float, float]) -> list[tuple[float, ...]]:
    return [one for four in circles_told(plot, bow, FAR) for one in four]


@given(
    st.tuples(places, places, st.floats(0.0, 20.0)), st.tuples(speeds, speeds), st.floats(-0.3, 0.3), speeds
)
def test_a_partner_that_goes_straight_on_is_where_all_circles_meet(place, velocity, turn, speed):
    """But for what one's own velocity changed while a packet was under way.

    Nearly above the partner the level distance, the root of a difference of squares, has lost half of its digits.
    """
    meeting = Meeting(list(place), list(velocity), turn, speed)
    plot = flown(meeting, TELLING, 2 * SLOT * CIRCLES + SLOT // 2)
    motion = meeting.motion()
    bow = level_bow(motion.attitude)
    north, east = (meeting.place - meeting.own)[:2]
    ahead, starboard = bow[0] * north + bow[1] * east, bow[0] * east - bow[1] * north
    change = abs(speed * turn) * (LATE * PERIOD) ** 2
    shown = circles(plot, bow)
    assert shown[0][0] == 1.0
    for told, to_centre, across, radius, _ in shown:
        off = abs(math.hypot(ahead - to_centre, starboard - across) - radius)
        lost = 4.0 * math.sqrt(np.finfo(float).eps) * math.hypot(radius, 20.0)
        assert off < change + lost or not told


@given(
    st.tuples(places, places, st.floats(0.0, 20.0)), st.tuples(speeds, speeds), st.floats(-0.3, 0.3), speeds
)
def test_the_newest_range_is_shown_and_those_before_it_from_other_sides(place, velocity, turn, speed):
    meeting = Meeting(list(place), list(velocity), turn, speed)
    plot = flown(meeting, TELLING, 3 * SLOT * CIRCLES + LATE)
    shown = circles(plot, (1.0, 0.0))
    ages = [age for *_, age in shown if age]
    assert ages == sorted(ages)
    assert math.isclose(ages[0], LATE * PERIOD)
    kept = [one for one in shown if one[0]]
    assert kept == shown[: len(kept)]
    for newer, older in pairwise(kept[1:]):
        apart = math.dist(newer[1:3], older[1:3])
        assert apart > SPACING * meeting.nearest - 1e-5


@pytest.mark.parametrize(("speed", "count"), [(0.0, 2), (2.0, CIRCLES)])
def test_who_keeps_its_place_beside_the_partner_needs_two_circles(speed, count):
    meeting = Meeting([0.0, 10.0, 10.0], [1.0, 0.0], 0.0, 1.0 + speed)
    plot = flown(meeting, TELLING, 40 * SLOT)
    assert sum(told for told, *_ in circles(plot, (1.0, 0.0))) == count


@given(st.tuples(places, places, st.floats(0.0, 20.0)), st.tuples(speeds, speeds), speeds)
def test_of_a_partner_that_tells_nothing_circles_are_about_where_one_was(place, velocity, speed):
    meeting = Meeting(list(place), list(velocity), 0.0, speed)
    plot = flown(meeting, SILENT, SLOT + 15)
    ranged = math.dist(
        np.array(place) + SLOT * PERIOD * np.array([*velocity, 0.0]), (SLOT * PERIOD * speed, 0.0, 10.0)
    )
    (told, to_centre, across, radius, _), *_ = circles(plot, (1.0, 0.0))
    assert told == 1.0
    assert math.isclose(to_centre, -15 * PERIOD * speed, abs_tol=1e-9)
    assert abs(across) < 1e-9
    assert math.isclose(radius, ranged, abs_tol=1e-9)


def test_centres_and_radii_are_bounded_and_told_as_the_bow_sees_them():
    meeting = Meeting([40.0, 30.0, 10.0], [0.0, 0.0], 0.0, 1.0)
    plot = flown(meeting, TELLING, SLOT + LATE)
    (_, ahead, starboard, radius, age), *_ = circles(plot, (0.0, 1.0))
    assert math.isclose(ahead, 0.0, abs_tol=1e-12)
    assert math.isclose(starboard, LATE * PERIOD, rel_tol=1e-9), "south of a vehicle that heads east"
    assert math.isclose(radius, math.hypot(40.0 - SLOT * PERIOD, 30.0), rel_tol=1e-9)
    assert math.isclose(age, LATE * PERIOD)
    told, ahead, starboard, radius, _ = circles_told(plot, (1.0, 0.0), 0.1)[0][0]
    assert (told, ahead, radius) == (1.0, -0.1, 0.1)
    assert abs(starboard) < 1e-12


def test_the_newest_circle_and_the_packet_that_it_is_of_tell_the_same_range():
    meeting = Meeting([40.0, 30.0, 18.0], [0.0, 0.0], 0.0, 0.0)
    plot = flown(meeting, TELLING, SLOT + LATE)
    told = packet_told(TELLING, meeting.packet(), tuple(meeting.own), (1.0, 0.0), FAR)
    (_, _, _, radius, _), *_ = circles(plot, (1.0, 0.0))
    assert math.isclose(math.hypot(radius, told[5]), told[2], rel_tol=1e-12)
