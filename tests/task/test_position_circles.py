"""Circles of position: the partner is on all of them, wherever both have gone since, as far as it was told."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Heard, Link, Message
from dq_marine.task.hearing import partner_link
from dq_marine.task.position_circles import CIRCLES, SPACING, Circle, Plot, empty_plot, plotted

PERIOD, SLOT, LATE = 0.1, 20, 3  # [s], [periods], [periods]: packets are understood so much later
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


def kept(plot: Plot) -> list[Circle]:
    """The circles that there are, which are the first ones."""
    there = [one for one in plot if one.radius >= 0.0]
    assert there == list(plot[: len(there)])
    return there


@given(
    st.tuples(places, places, st.floats(0.0, 20.0)), st.tuples(speeds, speeds), st.floats(-0.3, 0.3), speeds
)
def test_a_partner_that_goes_straight_on_is_where_all_circles_meet(place, velocity, turn, speed):
    """But for what one's own velocity changed while a packet was under way.

    Nearly above the partner the level distance, the root of a difference of squares, has lost half of its digits.
    """
    meeting = Meeting(list(place), list(velocity), turn, speed)
    plot = flown(meeting, TELLING, 2 * SLOT * CIRCLES + SLOT // 2)
    place = (meeting.place - meeting.own)[:2]
    change = abs(speed * turn) * (LATE * PERIOD) ** 2
    circles = kept(plot)
    assert circles
    for centre, radius, _ in circles:
        off = abs(math.dist(place, centre) - radius)
        lost = 4.0 * math.sqrt(np.finfo(float).eps) * math.hypot(radius, 20.0)
        assert off < change + lost


@given(
    st.tuples(places, places, st.floats(0.0, 20.0)), st.tuples(speeds, speeds), st.floats(-0.3, 0.3), speeds
)
def test_the_newest_range_is_kept_and_those_before_it_from_other_sides(place, velocity, turn, speed):
    meeting = Meeting(list(place), list(velocity), turn, speed)
    plot = flown(meeting, TELLING, 3 * SLOT * CIRCLES + LATE)
    circles = kept(plot)
    ages = [one.age for one in circles]
    assert ages == sorted(ages)
    assert math.isclose(ages[0], LATE * PERIOD)
    for newer, older in pairwise(circles[1:]):
        assert math.dist(newer.centre, older.centre) > SPACING * meeting.nearest - 1e-5


@pytest.mark.parametrize(("speed", "count"), [(0.0, 2), (2.0, CIRCLES)])
def test_who_keeps_its_place_beside_the_partner_needs_two_circles(speed, count):
    meeting = Meeting([0.0, 10.0, 10.0], [1.0, 0.0], 0.0, 1.0 + speed)
    plot = flown(meeting, TELLING, 40 * SLOT)
    assert len(kept(plot)) == count


def test_of_a_partner_that_tells_nothing_nothing_is_plotted():
    plot = flown(Meeting([40.0, 30.0, 10.0], [0.5, 0.0], 0.1, 1.0), SILENT, 3 * SLOT + LATE)
    assert kept(plot) == []


def test_a_circle_is_about_where_one_was():
    """The vehicle has gone north since a packet was sent, and the partner stands still."""
    meeting = Meeting([40.0, 30.0, 18.0], [0.0, 0.0], 0.0, 1.0)
    (circle,) = kept(flown(meeting, TELLING, SLOT + LATE))
    assert circle.centre == pytest.approx((-LATE * PERIOD, 0.0), abs=1e-12)
    assert math.isclose(circle.radius, math.hypot(40.0 - SLOT * PERIOD, 30.0), rel_tol=1e-9)
    assert math.isclose(circle.age, LATE * PERIOD)
