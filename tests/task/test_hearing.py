"""A modem that hears one partner: when a packet is heard, what range it gives, and the errors of both."""

import math

import numpy as np
import pytest

from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import DRIFT_TIME, PACKET_TIME, SOUND_SPEED, UNHEARD, Sender
from dq_marine.task.hearing import (
    FIRST_DRAWS,
    HEARING_DRAWS,
    disturbed,
    first_hearing,
    heard_from,
    partner_link,
    partner_told,
)

PERIOD, SLOT = 0.1, 2.0
VELOCITY = (1.0, 0.5, 0.0)
HERE = Motion((0.0, 0.0, 20.0), (1.0, 0.0, 0.0, 0.0), Spatial((0.0,) * 3, (0.0,) * 3))


def partner(step, distance):
    return Sender(tuple(np.add((0.0, distance, 20.0), np.multiply(step * PERIOD, VELOCITY))), VELOCITY)


def flown(link, steps, distance=600.0, seed=0):
    """The modem after each control period, beside where the partner was then."""
    random = np.random.default_rng(seed)
    hearing = first_hearing(link, tuple(random.random(FIRST_DRAWS)), 0)
    for step in range(1, steps + 1):
        hearing = disturbed(link, hearing, tuple(random.random(HEARING_DRAWS)), PERIOD)
        hearing = heard_from(link, hearing, HERE, HERE, partner(step, distance), PERIOD)
        yield step, hearing


@pytest.mark.parametrize("distance", [30.0, 600.0, 2000.0])
def test_a_packet_comes_once_in_a_slot_and_late_by_the_time_that_sound_takes(distance):
    link = partner_link(0.0, 0.0, "position", 0.0, SLOT)
    sent = round(SLOT / PERIOD)
    *_, away, _ = partner(sent, distance)[0]
    delay = math.dist(partner(sent, distance).position_ned, HERE.position_ned) / SOUND_SPEED
    for step, hearing in flown(link, 2 * sent - 1, distance):
        told = partner_told(link, hearing, HERE, (1.0, 0.0), 1e4)
        age = (step - sent) * PERIOD
        if age < delay + PACKET_TIME - 1e-9:
            assert told[0] == (0.0, 0.0, 0.0)
            assert told[1] == UNHEARD
        elif age > delay + PACKET_TIME + 1e-9:
            assert told[0] == (1.0, 1.0, 1.0)
            assert told[1] == pytest.approx(age)
            assert told[2] == pytest.approx(SOUND_SPEED * delay)
            assert told[4] == pytest.approx(away, abs=0.06)  # where it was, as far as a packet resolves
            assert told[7] == pytest.approx(math.hypot(*VELOCITY), abs=0.02)


@pytest.mark.parametrize(("contents", "told"), [("none", (1.0, 0.0, 0.0)), ("course", (1.0, 1.0, 0.0))])
def test_what_packets_do_not_tell_is_nought(contents, told):
    link = partner_link(0.0, 0.0, contents, 0.0, SLOT)
    *_, (_, hearing) = flown(link, 60)
    shown = partner_told(link, hearing, HERE, (1.0, 0.0), 1e4)
    assert shown[0] == told
    assert shown[2] > 0.0
    assert shown[3] == shown[4] == 0.0
    assert (shown[7] == 0.0) is (contents == "none")


@pytest.mark.sweep
def test_ranges_have_their_noise_packets_are_lost_and_navigations_drift():
    link = partner_link(0.5, 0.25, "position", 3.0, SLOT)
    sent = round(SLOT / PERIOD)
    packets = [one for step, one in flown(link, 8000 * sent) if step % sent == 0]
    assert np.std([one.error for one in packets]) == pytest.approx(0.5, rel=0.03)
    assert np.mean([one.lost for one in packets]) == pytest.approx(0.25, abs=0.02)
    drifts = np.array([one.drift for one in packets])
    assert drifts.std(axis=0) == pytest.approx(3.0 * math.sqrt(2.0), rel=0.15)
    kept = (drifts[1:] * drifts[:-1]).mean() / (drifts**2).mean()
    assert kept == pytest.approx(math.exp(-SLOT / DRIFT_TIME), abs=0.01)


def test_errors_change_with_packets_alone():
    link = partner_link(0.5, 0.25, "position", 3.0, SLOT)
    sent, before = round(SLOT / PERIOD), None
    for step, now in flown(link, 5 * sent):
        if before is not None:
            same = (now.error, now.lost, now.drift) == (before.error, before.lost, before.drift)
            assert same is (step % sent != 0)
        before = now
