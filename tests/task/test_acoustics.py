"""Acoustic modems: the time that sound takes, whose turn it is, what a packet gives, and the errors of all that."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import (
    CONTENTS,
    COURSE_STEP,
    DRIFT_DRAWS,
    DRIFT_TIME,
    ERRING_DRAWS,
    LENGTH_STEP,
    PACKET_TIME,
    SENDERS,
    SLOT_TIME,
    SOUND_SPEED,
    SPEED_STEP,
    UNHEARD,
    Sender,
    erring,
    first_modem,
    link_of,
    listened,
    message_of,
    packets_told,
    silent,
    travel_time,
    wandered,
)

PERIOD = 0.1
SILENCE = silent(((0.0, 0.0),) * 4)
components = st.floats(-500.0, 500.0)
speeds = st.floats(-20.0, 20.0)
PLACES = ((30.0, 0.0, 20.0), (0.0, 40.0, 20.0), (0.0, -50.0, 25.0))
SENDING = tuple(Sender(place, (1.0, 0.5, 0.0)) for place in PLACES)


def still(place=(0.0, 0.0, 20.0), heading=0.0):
    return Motion(place, quaternion_from_euler(0.0, 0.0, heading), Spatial((0.0,) * 3, (0.0,) * 3))


def exact(contents="position", drift=0.0):
    return link_of(0.0, 0.0, contents, drift, PERIOD)


@given(st.tuples(components, components, components), st.tuples(speeds, speeds, speeds))
def test_sound_meets_a_receiver_that_goes_on(offset, velocity):
    time = travel_time(offset, velocity)
    met = np.array(offset) + time * np.array(velocity)
    assert np.linalg.norm(met) == pytest.approx(SOUND_SPEED * time, rel=1e-9, abs=1e-9)


def test_along_the_line_of_sight_it_is_distance_over_the_difference_of_speeds():
    assert travel_time((300.0, 0.0, 0.0), (0.0, 0.0, 0.0)) == pytest.approx(0.2)
    assert travel_time((300.0, 0.0, 0.0), (10.0, 0.0, 0.0)) == pytest.approx(300.0 / (SOUND_SPEED - 10.0))
    assert travel_time((300.0, 0.0, 0.0), (-10.0, 0.0, 0.0)) == pytest.approx(300.0 / (SOUND_SPEED + 10.0))


def test_senders_take_turns_and_a_packet_is_understood_when_all_of_it_has_come():
    link, modem, motion = exact(), SILENCE, still()
    news = []
    for step in range(1, 95):
        before, modem = modem, listened(link, modem, motion, SENDING, PERIOD)
        news += [
            (step, k, now)
            for k, (old, now) in enumerate(zip(before.last, modem.last, strict=True))
            if now.heard and now.age <= old.age
        ]
    periods = round(SLOT_TIME / PERIOD)
    assert [k for _, k, _ in news] == [0, 1, 2] * 3
    for number, (step, k, now) in enumerate(news, start=1):
        distance = math.dist(PLACES[k], motion.position_ned)
        due = distance / SOUND_SPEED + PACKET_TIME
        assert now.range == pytest.approx(distance)
        assert step == number * periods + math.ceil(due / PERIOD - 1e-9)
        assert now.age == pytest.approx((step - number * periods) * PERIOD)


def test_a_range_is_to_where_the_sender_was():
    """The sender goes on after it has sent, and the receiver goes to meet the sound."""
    link, speed = exact(), 2.0
    modem = SILENCE._replace(clock=SLOT_TIME - PERIOD)
    motion = Motion((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), Spatial((0.0,) * 3, (speed, 0.0, 0.0)))
    modem = listened(link, modem, motion, (Sender((750.0, 0.0, 0.0), (5.0, 0.0, 0.0)), *SENDING[1:]), PERIOD)
    while not modem.last[0].heard:
        modem = listened(link, modem, motion, SENDING, PERIOD)
    assert modem.last[0].range == pytest.approx(SOUND_SPEED * 750.0 / (SOUND_SPEED + speed))
    assert modem.last[0].message.place == pytest.approx((750.0, 0.0))
    assert modem.last[0].age == pytest.approx(
        0.7
    )  # the first whole period after 0.5 s of way and 0.2 s of packet


def test_what_is_lost_leaves_the_last_packet_which_grows_old():
    link, modem, motion = exact(), SILENCE, still()
    for _ in range(40):
        modem = listened(link, modem, motion, SENDING, PERIOD)
    ages = [one.age for one in modem.last]
    deaf = modem._replace(lost=1.0)
    for _ in range(1000):
        deaf = listened(link, deaf, motion, SENDING, PERIOD)
    assert all(age < 4.0 for age in ages)
    assert [one.age for one in deaf.last] == [UNHEARD] * SENDERS
    assert [one.message for one in deaf.last] == [one.message for one in modem.last]


def test_errors_of_packets_have_their_standard_deviation_and_probability():
    link = link_of(0.7, 0.3, "none", 0.0, PERIOD)
    uniforms = np.random.default_rng(0).random((4000, ERRING_DRAWS)).tolist()
    sending = SILENCE._replace(clock=SLOT_TIME - PERIOD)
    modems = [erring(link, sending, tuple(row), PERIOD) for row in uniforms]
    errors = np.array([one.error for one in modems if not one.lost])
    assert errors.std() == pytest.approx(0.7, rel=0.05)
    assert abs(errors.mean()) < 0.05
    assert np.mean([one.lost for one in modems]) == pytest.approx(0.3, abs=0.03)
    silent_yet = erring(link, SILENCE, tuple(uniforms[0]), PERIOD)
    assert (silent_yet.error, silent_yet.lost) == (0.0, 0.0)  # nobody sends, nothing is drawn


def test_a_navigation_wanders_about_the_truth_with_its_deviation_and_forgets_in_its_time():
    random = np.random.default_rng(1)
    link = link_of(0.0, 0.0, "position", 2.0, PERIOD)
    assert link.kept == pytest.approx(math.exp(-PERIOD / DRIFT_TIME))
    modem = first_modem(link, tuple(random.random(DRIFT_DRAWS).tolist()), 0)
    assert all(abs(part) > 0.0 for drift in modem.drifts for part in drift)
    kept, error, walked = 0.5, (0.0, 0.0), []
    for uniforms in random.random((20_000, 2)).tolist():
        error = wandered(error, 2.0, kept, tuple(uniforms), 0)
        walked.append(error)
    north, east = np.array(walked[100:]).T
    assert north.std() == pytest.approx(2.0, rel=0.05)
    assert np.mean(north[1:] * north[:-1]) / north.var() == pytest.approx(kept, abs=0.03)
    assert abs(np.mean(north * east)) < 0.15


def sent_errors(link, period, count):
    """For each sender, in which control periods it sent and how its navigation erred then; and one's own errors."""
    uniforms = np.random.default_rng(2).random((count, ERRING_DRAWS)).tolist()
    modem, own, sent = first_modem(link, (0.3,) * DRIFT_DRAWS, 0), [], ([], [], [])
    for step, row in enumerate(uniforms):
        before, modem = modem.drifts, erring(link, modem, tuple(row), period)
        now = modem.drifts
        modem = listened(link, modem, still(), SENDING, period)
        own.append(now[0])
        for k, (old, new) in enumerate(zip(before[1:], now[1:], strict=True)):
            if modem.packet.age == 0.0 and k == modem.turn:
                told = np.subtract(modem.packet.message.place, PLACES[k][:2])
                assert np.abs(told - new).max() <= 0.5 * LENGTH_STEP + 1e-9
                sent[k].append((step, *new))
            else:
                assert new == old
    return [(np.array(one)[:, 0], np.array(one)[:, 1:]) for one in sent], np.array(own)


def test_a_sender_errs_when_it_sends_as_one_that_errs_in_every_period():
    """Deviation, autocorrelation and what is new each time, by their closed forms; slots have 4 periods or 5."""
    period, kept, deviation = (
        0.22,
        0.9,
        2.0,
    )  # what is left from packet to packet is little, so that a run is short
    link = link_of(0.0, 0.0, "position", deviation, period)._replace(kept=kept)
    senders, own = sent_errors(link, period, 40_000)
    courses = [own[:, 0], own[:, 1]]
    assert own.std(axis=0) == pytest.approx(deviation, rel=0.05)
    assert np.mean(own[1:] * own[:-1]) / own.var() == pytest.approx(kept, abs=0.01)
    for steps, errors in senders:
        between = np.diff(steps)
        assert set(between) == {13, 14}
        assert errors.std(axis=0) == pytest.approx(deviation, rel=0.05)
        assert np.abs(errors.mean(axis=0)).max() < 0.2
        before, after = errors[:-1], errors[1:]
        for periods in (13, 14):
            those = between == periods
            assert np.mean(before[those] * after[those]) == pytest.approx(
                deviation**2 * kept**periods, abs=0.05 * deviation**2
            )
        left = (kept**between)[:, None]
        new = (after - left * before) / (deviation * np.sqrt(1.0 - left * left))
        assert new.std(axis=0) == pytest.approx(1.0, rel=0.05)
        assert abs(np.mean(new * before)) < 0.05 * deviation
        assert np.mean(np.abs(new) > 1.959964) == pytest.approx(0.05, abs=0.01)
        courses += [np.interp(np.arange(len(own)), steps, part) for part in errors.T]
    others = np.corrcoef(courses) - np.eye(len(courses))
    assert np.abs(others).max() < 0.1  # nobody's error tells of another's, nor north of east


@example(0.0, 0.0, 0.0, -0.0, 0.0)
@given(components, components, st.floats(0.0, 300.0), st.floats(-4.0, 4.0), st.floats(-4.0, 4.0))
def test_a_message_is_rounded_to_what_its_bytes_resolve(x, y, z, north, east):
    said = message_of(Sender((x, y, z), (north, east, 0.3)), (1.5, -0.5))
    assert np.abs(np.subtract(said.place, (x + 1.5, y - 0.5))).max() <= 0.5 * LENGTH_STEP + 1e-9
    assert abs(said.depth - z) <= 0.5 * LENGTH_STEP + 1e-9
    assert abs(said.speed - math.hypot(north, east)) <= 0.5 * SPEED_STEP + 1e-9
    off = math.atan2(said.course[1], said.course[0]) - math.atan2(east, north)
    if math.hypot(north, east) > 0.0:  # else it has no course
        assert abs(math.remainder(off, math.tau)) <= 0.5 * COURSE_STEP + 1e-9


@pytest.mark.parametrize("contents", CONTENTS)
def test_packets_tell_what_their_contents_are_by_both_navigations(contents):
    link, motion = exact(contents), still(heading=0.5 * math.pi)
    modem = SILENCE._replace(drifts=((1.0, 0.0), (0.0, 2.0), (0.0, 0.0), (0.0, 0.0)))
    for _ in range(15):
        modem = listened(link, modem, motion, SENDING, PERIOD)
    told = packets_told(link, modem, motion, (0.0, 1.0), 1e3)
    heard, course, position = told[0][0]
    assert heard == 1.0
    assert (course, position) == {"none": (0.0, 0.0), "course": (1.0, 0.0), "position": (1.0, 1.0)}[contents]
    age, distance, ahead, starboard, deeper, way, speed = told[0][1:]
    assert (age, distance) == pytest.approx((0.5, 30.0))
    # The sender, 30 m to the north and 2 m off to the east, seen from 1 m off to the north with the bow to the east.
    assert (ahead, starboard) == pytest.approx((2.0 * position, -29.0 * position))
    assert deeper == pytest.approx(0.0)
    assert math.atan2(way[1], way[0]) == pytest.approx(course * (0.4636 - 0.5 * math.pi), abs=COURSE_STEP)
    assert speed == pytest.approx(course * math.hypot(1.0, 0.5), abs=SPEED_STEP)
    assert told[1][0] == (0.0, 0.0, 0.0)
    assert told[1][1] == UNHEARD
