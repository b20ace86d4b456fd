"""The filter of a formation: what it expects of packets, and that it finds out where the vehicle is."""

import math

import numpy as np
import pytest

from dq_marine.agents.controllers.formation_filter import (
    COURSE,
    DEPTH,
    EAST,
    NORTH,
    SPEED,
    TURNING,
    FormationFilter,
    Packet,
    expected_packet,
    turned,
)

SPACING, SPEED_PLANNED, PERIOD = 6.0, 1.2, 0.1
PLACES = ((0.0, 0.0), (-SPACING, -SPACING), (-SPACING, SPACING))
OWN = (-2.0 * SPACING, 0.0)
TURN_RATE, SINK_RATE = 0.03, 0.05
ALL, RANGE_AND_COURSE = np.ones(6, bool), np.array([1, 1, 1, 1, 0, 0], bool)
RANGE_ALONE = np.array([1, 0, 0, 0, 0, 0], bool)


class Circling:
    """A formation on a circle that goes down, by closed forms; the vehicle goes straight on at a velocity."""

    def __init__(self, velocity, begin, course=0.4, turn_rate=TURN_RATE, sink_rate=SINK_RATE):
        self.velocity, self.begin, self.course = np.array(velocity), np.array(begin), course
        self.turn_rate, self.sink_rate = turn_rate, sink_rate

    def leader(self, time):
        radius = SPEED_PLANNED / self.turn_rate
        course = self.course + self.turn_rate * time
        place = radius * np.array(
            [math.sin(course) - math.sin(self.course), math.cos(self.course) - math.cos(course)]
        )
        return place, course

    def sender(self, place, time):
        leader, course = self.leader(time)
        return leader + np.array(turned(place, course))

    def own(self, time):
        return self.begin + time * self.velocity

    def packet(self, place, sent, now, told, depth=0.0):
        step = 1e-4
        where = self.sender(place, sent)
        velocity = (self.sender(place, sent + step) - self.sender(place, sent - step)) / (2.0 * step)
        below = self.sink_rate * sent
        distance = math.hypot(np.linalg.norm(where - self.own(sent)), below - depth)
        return Packet(
            place, now - sent, np.array([distance, *velocity, below, *(where - self.own(now))]), told
        )

    def truth(self, time):
        leader, course = self.leader(time)
        place = self.own(time) - leader
        return np.array(
            [*place, course, self.turn_rate, SPEED_PLANNED, self.sink_rate * time, self.sink_rate]
        )


@pytest.mark.parametrize("place", PLACES)
def test_a_packet_is_expected_as_it_comes_from_a_formation_that_circles(place):
    world = Circling((0.8, 0.5), (-9.0, -5.0))
    packet = world.packet(place, 7.0, 7.4, ALL, depth=0.6)
    expected = expected_packet(world.truth(7.4), packet, (0.8, 0.5), 0.6)
    assert expected == pytest.approx(
        packet.measured, abs=2e-4
    )  # the course is taken to turn about its middle


@pytest.mark.parametrize("told", [ALL, RANGE_AND_COURSE, RANGE_ALONE], ids=["all", "course", "ranges"])
def test_it_finds_out_where_the_vehicle_is(told):
    """The vehicle begins off its place, on another course than the formation's."""
    sink_rate = SINK_RATE if told[3] else 0.0
    begin = np.add(turned(OWN, 0.4), (1.0, -0.8))
    world = Circling((1.05, 0.5), begin, turn_rate=0.01, sink_rate=sink_rate)
    found = FormationFilter(OWN, SPACING, SPEED_PLANNED, 0.4 + 0.2)
    random = np.random.default_rng(0)
    off = []
    for step in range(1, 601):
        now = step * PERIOD
        found.predict(tuple(world.velocity), PERIOD)
        if step % 10 == 3:
            packet = world.packet(PLACES[step // 10 % 3], now - 0.3, now, told)
            noisy = packet.measured + np.array([0.1, 0.01, 0.01, 0.03, 2.0, 2.0]) * random.normal(size=6)
            found.update(packet._replace(measured=noisy), tuple(world.velocity), 0.0)
        off.append(found.state - world.truth(now))
    late = np.sqrt(np.mean(np.array(off[300:]) ** 2, axis=0))
    assert late[[NORTH, EAST]].max() < (0.3 if told[1] else 1.0)
    assert late[COURSE] < (0.03 if told[1] else 0.1)
    assert late[TURNING] < 0.02
    assert late[SPEED] < 0.05
    assert late[DEPTH] < 0.1


def test_its_covariance_stays_that_of_something_and_packets_make_it_smaller():
    world = Circling((1.05, 0.5), turned(OWN, 0.4))
    found = FormationFilter(OWN, SPACING, SPEED_PLANNED, 0.4)
    for step in range(1, 400):
        found.predict(tuple(world.velocity), PERIOD)
        if step % 10 == 3:
            before = np.linalg.slogdet(found.covariance[:5, :5])[1]
            packet = world.packet(PLACES[step // 10 % 3], step * PERIOD - 0.3, step * PERIOD, ALL)
            found.update(packet, tuple(world.velocity), 0.0)
            assert np.linalg.slogdet(found.covariance[:5, :5])[1] < before
            assert np.allclose(found.covariance, found.covariance.T, atol=1e-10)
            assert np.linalg.eigvalsh(found.covariance).min() > 0.0


def test_depth_stays_as_planned_as_long_as_nobody_tells_of_it():
    world = Circling((1.05, 0.5), turned(OWN, 0.4), sink_rate=0.0)
    found = FormationFilter(OWN, SPACING, SPEED_PLANNED, 0.4)
    for step in range(1, 200):
        found.predict(tuple(world.velocity), PERIOD)
        if step % 10 == 3:
            packet = world.packet(PLACES[step // 10 % 3], step * PERIOD - 0.3, step * PERIOD, RANGE_ALONE)
            found.update(packet, tuple(world.velocity), 0.5)
    assert found.state[DEPTH] == 0.0
