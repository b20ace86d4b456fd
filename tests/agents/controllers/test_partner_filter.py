"""The filter of a rendezvous: it finds out where the partner is, by what packets tell or by ranges alone."""

import math

import numpy as np
import pytest

from dq_marine.agents.controllers.partner_filter import PartnerFilter, Told

PERIOD, SPEED, AGE, EVERY = 0.1, 1.0, 0.3, 20
BEGIN = np.array([18.0, 9.0])


def told_at(places, now, contents, random):
    """What is told `AGE` after a packet was sent, of a partner on a straight course."""
    partner, own, velocity = places
    then = partner(now - AGE) - own(now - AGE)
    return Told(
        AGE,
        float(np.hypot(*then)) + 0.1 * random.normal(),
        0.0,
        tuple(velocity + 0.01 * random.normal(size=2)) if contents != "none" else None,
        tuple(partner(now - AGE) - own(now) + random.normal(size=2)) if contents == "position" else None,
    )


def flown(contents, seed=0):
    """The filter after each packet with the true state; the vehicle turns by 60 degrees every 15 s."""
    random = np.random.default_rng(seed)
    course = random.uniform(-math.pi, math.pi)
    velocity = SPEED * np.array([math.cos(course), math.sin(course)])
    track = [np.zeros(2)]
    moves = []
    for step in range(700):
        heading = 0.3 + (step // 150) % 2 * math.radians(60.0)
        moves.append(1.4 * np.array([math.cos(heading), math.sin(heading)]))
        track.append(track[-1] + PERIOD * moves[-1])

    def partner(time):
        return BEGIN + time * velocity

    def own(time):
        return track[round(time / PERIOD)]

    found = None
    for step in range(1, 700):
        now = step * PERIOD
        if found is not None:
            found.predict(tuple(moves[step - 1]), PERIOD)
        if step % EVERY == 3:
            told = told_at((partner, own, velocity), now, contents, random)
            if found is None:
                found = PartnerFilter(told, 0.3, SPEED)
            else:
                found.update(told, tuple(moves[step - 1]))
            yield found, np.concatenate([partner(now) - own(now), velocity])


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("contents", "error"), [("position", 0.05), ("course", 0.05), ("none", 0.2)])
def test_it_finds_out_where_the_partner_is(contents, error, seed):
    """Ranges tell distances; bearings follow from how these change."""
    *_, (last, truth, count) = [
        (one.likeliest.copy(), truth, len(one.weights)) for one, truth in flown(contents, seed)
    ]
    (north, east, *velocity), (true_north, true_east, *true_velocity) = last, truth
    assert math.hypot(north, east) == pytest.approx(math.hypot(true_north, true_east), abs=0.5)
    off = math.atan2(east, north) - math.atan2(true_east, true_north)
    assert abs(math.remainder(off, math.tau)) < error
    assert math.dist(velocity, true_velocity) < 0.2
    assert count < 20


def test_weights_are_shares_and_covariances_stay_those_of_something():
    for found, _ in flown("none"):
        assert found.weights.sum() == pytest.approx(1.0)
        assert (found.weights > 0.0).all()
        assert np.allclose(found.covariances, np.swapaxes(found.covariances, 1, 2), atol=1e-9)
        assert np.linalg.eigvalsh(found.covariances).min() > 0.0


def test_it_says_when_ranges_are_none_that_it_expected():
    for found, _ in flown("course"):
        assert not found.lost
    places = found.means[:, :2]
    for _ in range(3):
        found.update(Told(0.0, 2.0 * float(np.hypot(*places.max(axis=0))), 0.0, None, None), (0.0, 0.0))
    assert found.lost


def test_one_packet_without_a_place_leaves_the_bearing_open():
    found = PartnerFilter(Told(0.0, 20.0, 0.0, (0.0, SPEED), None), 1.0, SPEED)
    bearings = np.arctan2(found.means[:, 1], found.means[:, 0])
    assert bearings.min() < 1.0 - 1.5 < 1.0 + 1.5 < bearings.max()
    assert np.hypot(found.means[:, 0], found.means[:, 1]) == pytest.approx(20.0)
    assert found.weights == pytest.approx(1.0 / len(bearings))
