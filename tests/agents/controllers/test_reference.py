"""The way of a point, from what is shown of it: circles and climbs as they are, and a point that stands still."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dq_marine.agents.controllers.reference import Way, reference_along

PERIOD, AHEAD = 0.1, (1.0, 2.0)


def circle(radius, rate, sink):
    """A point that goes round to starboard, in its own axes now."""

    def place(t):
        return np.array([radius * math.sin(rate * t), radius * (1.0 - math.cos(rate * t)), sink * t])

    velocity = np.array([radius * rate, 0.0, sink])
    return Way(velocity, np.array([0.0, radius * rate**2, 0.0]), place(AHEAD[0]), place(AHEAD[1]))


def test_round_a_circle_the_velocity_in_its_own_axes_stays():
    radius, rate, sink = 4.0, 0.15, 0.05
    found = reference_along(circle(radius, rate, sink), AHEAD, PERIOD, 20)
    expected = np.array([radius * rate, 0.0, sink, 0.0, 0.0, rate])
    np.testing.assert_allclose(found.velocity, np.tile(expected, (20, 1)), atol=2e-4)
    np.testing.assert_allclose(found.acceleration, 0.0, atol=2e-3)


def test_of_a_circle_the_error_falls_with_the_fourth_power_of_its_rate():
    """The velocity of a polynomial of degree 4 is of degree 3."""
    errors = []
    for rate in (0.4, 0.2):
        found = reference_along(circle(1.0 / rate, rate, 0.0), AHEAD, PERIOD, 20)
        errors.append(np.abs(found.velocity[:, 0] - 1.0).max())
    assert 3.0 < math.log2(errors[0] / errors[1]) < 5.5


def test_a_point_that_speeds_up_straight_ahead():
    way = Way(
        np.array([0.3, 0.0, 0.0]), np.array([0.2, 0.0, 0.0]), np.array([0.4, 0, 0]), np.array([1.0, 0, 0])
    )
    found = reference_along(way, AHEAD, PERIOD, 20)
    np.testing.assert_allclose(found.velocity[:, 0], 0.3 + 0.2 * PERIOD * (np.arange(20) + 0.5))
    np.testing.assert_allclose(found.acceleration[:, 0], 0.2)
    np.testing.assert_allclose(found.velocity[:, 1:], 0.0, atol=1e-12)


@pytest.mark.parametrize("sink", [0.0, 0.2])
def test_a_point_without_a_course_keeps_its_axes(sink):
    """One that stands still, or goes straight down, heads as it did."""
    down = np.array([0.0, 0.0, sink])
    found = reference_along(Way(down, np.zeros(3), down, 2.0 * down), AHEAD, PERIOD, 5)
    np.testing.assert_allclose(found.velocity, np.tile([0, 0, sink, 0, 0, 0], (5, 1)), atol=1e-12)
    assert np.isfinite(found.acceleration).all()
