"""Paths by control points: smooth, as curved as promised, and the nearest point on them is the nearest."""

import math

import numpy as np
import pytest
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.splines import beside, curvature, make_spline, make_winding, path_axes, winding_draws

SPANS, LEG, TURN, CLIMB = 5, 10.0, math.radians(40.0), math.radians(8.0)
SPLINE, WINDING = make_spline(SPANS), make_winding(SPANS)
POINT, NEAREST = SPLINE.point, SPLINE.nearest


def drawn(seed, climb=CLIMB):
    uniforms = tuple(np.random.default_rng(seed).random(winding_draws(SPANS)).tolist())
    return WINDING((1.0, -2.0, 30.0), LEG, TURN, climb, uniforms, 0)


def scipy_path(controls):
    """The same path by SciPy: the uniform knots of a cubic B-spline."""
    return BSpline(np.arange(-3.0, SPANS + 4.0), np.array(controls), 3)


@pytest.mark.parametrize("seed", range(3))
def test_points_slopes_and_bends_are_those_of_scipys_b_spline(seed):
    controls, path = drawn(seed), scipy_path(drawn(seed))
    for s in np.linspace(0.0, SPANS - 1e-9, 41):
        point = POINT(controls, float(s))
        for order, ours in enumerate(point):
            assert np.allclose(ours, path(s, nu=order), rtol=0.0, atol=1e-12 * LEG * SPANS)


def test_position_course_and_curvature_are_continuous_at_the_knots():
    controls = drawn(4)
    for knot in range(1, SPANS):
        before, after = POINT(controls, math.nextafter(knot, 0.0)), POINT(controls, float(knot))
        for one, other in zip(before, after, strict=True):
            assert np.allclose(one, other, rtol=0.0, atol=1e-12 * LEG)


def test_a_path_begins_straight_where_it_is_told_to():
    point = POINT(drawn(5), 0.0)
    assert np.allclose(point.position_ned, (1.0, -2.0, 30.0), atol=1e-13)
    assert np.linalg.norm(point.slope_ned) == pytest.approx(LEG, rel=1e-13)
    assert np.allclose(curvature(point), 0.0, atol=1e-14)


def test_the_curvature_of_a_level_path_stays_below_that_of_its_largest_turn():
    most = 2.0 * math.sin(TURN / 2.0) / (LEG * math.cos(TURN / 2.0) ** 2)
    found = max(
        np.linalg.norm(curvature(POINT(drawn(seed, 0.0), float(s))))
        for seed in range(40)
        for s in np.linspace(0.0, SPANS, 101)
    )
    assert 0.7 * most < found <= most * (1.0 + 1e-12)


def test_the_axes_are_an_orthonormal_frame_whose_starboard_is_level():
    for seed in range(5):
        for s in np.linspace(0.0, SPANS, 11):
            axes = np.array(path_axes(POINT(drawn(seed), float(s))))
            assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-14)
            assert np.linalg.det(axes) == pytest.approx(1.0)
            assert axes[1, 2] == 0.0


def test_curvature_is_the_turn_of_the_tangent_over_the_way():
    controls, s, step = drawn(6), 2.3, 1e-6
    tangents = [np.array(path_axes(POINT(controls, s + h)).ahead_ned) for h in (-step, step)]
    way = 2.0 * step * np.linalg.norm(POINT(controls, s).slope_ned)
    assert np.allclose(curvature(POINT(controls, s)), (tangents[1] - tangents[0]) / way, atol=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_two_steps_a_period_follow_the_nearest_point_as_scipys_search_finds_it(seed):
    """A vehicle that weaves beside the path, a fiftieth of a leg in each period."""
    controls, path = drawn(seed), scipy_path(drawn(seed))
    random = np.random.default_rng(seed)
    phase, parameter = 2.0 * math.pi * random.random(2), 0.0
    for s in np.arange(0.1, SPANS - 0.1, 0.02):
        axes = path_axes(POINT(controls, float(s)))
        off = 0.1 * LEG * np.sin(2.0 * s + phase)
        place = path(s) + off[0] * np.array(axes.starboard_ned) + off[1] * np.array(axes.down_ned)
        for _ in range(2):
            parameter = NEAREST(controls, parameter, tuple(place.tolist()))
        if s < 0.3:
            continue  # the search starts at the path's beginning
        near = minimize_scalar(
            lambda at, place=place: float(np.sum((path(at) - place) ** 2)),
            bounds=(max(0.0, s - 0.3), min(SPANS, s + 0.3)),
            method="bounded",
            options={"xatol": 1e-10},
        )
        assert parameter == pytest.approx(near.x, abs=1e-5)


def test_the_nearest_point_stays_on_the_path():
    controls = drawn(7)
    begin, end = (np.array(POINT(controls, s).position_ned) for s in (0.0, float(SPANS)))
    parameter = 0.0
    for _ in range(5):
        parameter = NEAREST(controls, parameter, tuple((begin - 3.0 * LEG).tolist()))
    assert 0.0 <= parameter <= SPANS
    ahead = np.array(path_axes(POINT(controls, float(SPANS))).ahead_ned)
    parameter = SPANS - 0.1
    for _ in range(5):
        parameter = NEAREST(controls, parameter, tuple((end + LEG * ahead).tolist()))
    assert parameter == SPANS


def test_beside_tells_distances_and_speed_along_the_path():
    controls = drawn(8)
    point = POINT(controls, 1.7)
    axes = path_axes(point)
    place = np.array(point.position_ned) + 2.0 * np.array(axes.starboard_ned) - 0.5 * np.array(axes.down_ned)
    attitude = quaternion_from_euler(0.0, 0.0, math.atan2(axes.ahead_ned[1], axes.ahead_ned[0]))
    velocity = Spatial((0.0, 0.0, 0.0), (1.5, 0.0, 0.0))
    seen = beside(point, Motion(tuple(place.tolist()), attitude, velocity))
    assert (seen.starboard, seen.below) == pytest.approx((2.0, -0.5))
    assert seen.distance == pytest.approx(math.hypot(2.0, 0.5))
    assert seen.speed == pytest.approx(1.5 * math.hypot(axes.ahead_ned[0], axes.ahead_ned[1]))
