"""Curves of harmonics: their derivatives, their shapes, and that a point on one never stands still."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from dq_marine.task.harmonics import course_rate, curve_point, level_course, moved_to
from dq_marine.task.shapes import SHAPE_DRAWS, SHAPES, STEEPEST, shaped_curve

RADIUS, HEIGHT = 3.0, 1.2
uniform = st.floats(0.0, 1.0, exclude_max=True)
curves = st.builds(
    lambda shape, uniforms: (shape, shaped_curve(float(shape), RADIUS, HEIGHT, tuple(uniforms), 0)),
    st.integers(0, len(SHAPES) - 1),
    st.lists(uniform, min_size=SHAPE_DRAWS, max_size=SHAPE_DRAWS),
)
phases = st.floats(-20.0, 20.0)
TINY = 1e-4


def central(function, phase):
    return (np.array(function(phase + TINY)) - np.array(function(phase - TINY))) / (2.0 * TINY)


@given(curves, phases)
def test_slope_and_bend_are_the_derivatives(shaped, phase):
    _, curve = shaped
    point = curve_point(curve, phase)
    np.testing.assert_allclose(
        central(lambda p: curve_point(curve, p).position_ned, phase), point.slope_ned, atol=1e-6
    )
    np.testing.assert_allclose(
        central(lambda p: curve_point(curve, p).slope_ned, phase), point.bend_ned, atol=1e-6
    )


@example((3, shaped_curve(3.0, RADIUS, HEIGHT, (0.0,) * SHAPE_DRAWS, 0)), 1.0)  # nearly the fastest there is
@given(curves, phases)
def test_a_point_never_stands_still_and_is_never_faster_than_said(shaped, phase):
    shape, curve = shaped
    level = np.hypot(*curve_point(curve, phase).slope_ned[:2]) / RADIUS
    assert 0.2 < level <= STEEPEST[shape] * (1.0 + 1e-12)


@given(curves, phases)
def test_the_course_is_a_level_pair_of_unit_vectors_and_turns_as_told(shaped, phase):
    _, curve = shaped
    point = curve_point(curve, phase)
    ahead, starboard = map(np.array, level_course(point.slope_ned))
    assert np.linalg.norm(ahead) == pytest.approx(1.0)
    np.testing.assert_allclose(np.cross(ahead, starboard), (0.0, 0.0, 1.0), atol=1e-12)
    turning = central(lambda p: level_course(curve_point(curve, p).slope_ned)[0], phase)
    np.testing.assert_allclose(turning, course_rate(point, 1.0) * starboard, atol=1e-5)


@given(curves, phases, st.tuples(*[st.floats(-50.0, 50.0)] * 3))
def test_a_moved_curve_is_where_it_was_moved_to_and_has_the_same_shape(shaped, phase, place):
    _, curve = shaped
    moved = moved_to(curve, phase, place)
    np.testing.assert_allclose(curve_point(moved, phase).position_ned, place, atol=1e-9)
    assert curve_point(moved, phase + 1.0).slope_ned == curve_point(curve, phase + 1.0).slope_ned


def positions(shape, uniforms, turns=1.0):
    curve = shaped_curve(float(SHAPES.index(shape)), RADIUS, HEIGHT, uniforms, 0)
    return np.array(
        [curve_point(curve, phase).position_ned for phase in np.linspace(0.0, 2.0 * np.pi * turns, 241)]
    )


@pytest.mark.parametrize("side", [0.2, 0.8])
def test_shapes_are_what_they_are_called(side):
    uniforms = (0.3, side, *[0.9] * (SHAPE_DRAWS - 2))
    circle = positions("circle", uniforms)
    np.testing.assert_allclose(np.linalg.norm(circle, axis=1), RADIUS)
    assert not circle[:, 2].any()
    helix = positions("helix", uniforms, turns=2.0)
    np.testing.assert_allclose(np.hypot(*helix[:, :2].T), RADIUS)
    np.testing.assert_allclose(np.diff(helix[:, 2]), 2.0 * HEIGHT / 240.0)
    eight = positions("lemniscate", uniforms)  # of Gerono: y^2 = x^2 (1 - x^2), along its own axes
    c, s = np.cos(2.0 * np.pi * 0.3), np.sin(2.0 * np.pi * 0.3)
    x, y = np.array([[c, s], [-s, c]]) @ eight[:, :2].T / RADIUS
    np.testing.assert_allclose(y**2, x**2 * (1.0 - x**2), atol=1e-12)


def test_wavy_circles_close_and_differ():
    random = np.random.default_rng(0)
    first, second = (positions("wavy", tuple(random.random(SHAPE_DRAWS))) for _ in range(2))
    np.testing.assert_allclose(first[0], first[-1], atol=1e-12)
    assert np.abs(first - second).max() > 0.1
    assert np.ptp(first[:, 2]) <= HEIGHT * (1.0 + 1e-9)
