"""Rays and distances of shapes against plain NumPy, and the laws that they keep."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from dq_marine.algebra.distances import (
    box_distance,
    capsule_distance,
    line_distance,
    make_pipe_distance,
    pillar_distance,
    plane_distance,
    sphere_distance,
)
from dq_marine.task.world.rays import (
    make_trace,
    ray_to_box,
    ray_to_line,
    ray_to_pillar,
    ray_to_plane,
    ray_to_sphere,
)

REACH = 30.0
CENTER, RADIUS, HALF = (1.0, -2.0, 3.0), 1.5, (1.0, 2.0, 0.5)
NORMAL, OFFSET = (2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0), 1.0
CORNERS = ((0.0, 0.0, 0.0), (3.0, 1.0, 0.0), (3.0, 1.0, 0.0), (5.0, -2.0, 1.0))

coordinate = st.floats(-10.0, 10.0)
points = st.tuples(coordinate, coordinate, coordinate)


@st.composite
def directions(draw):
    vector = np.array(draw(points))
    assume(np.linalg.norm(vector) > 0.1)
    return tuple((vector / np.linalg.norm(vector)).tolist())


def to_pipe(point):
    return make_pipe_distance(4)(point, CORNERS, RADIUS)


DISTANCES = {
    "sphere": lambda p: sphere_distance(p, CENTER, RADIUS),
    "plane": lambda p: plane_distance(p, NORMAL, OFFSET),
    "pillar": lambda p: pillar_distance(p, CENTER[0], CENTER[1], RADIUS),
    "line": lambda p: line_distance(p, CENTER, NORMAL, RADIUS),
    "box": lambda p: box_distance(p, CENTER, HALF),
    "capsule": lambda p: capsule_distance(p, CORNERS[0], CORNERS[3], RADIUS),
    "pipe": to_pipe,
}

RAYS = {
    "sphere": lambda o, d: ray_to_sphere(o, d, CENTER, RADIUS, REACH),
    "plane": lambda o, d: ray_to_plane(o, d, NORMAL, OFFSET, REACH),
    "pillar": lambda o, d: ray_to_pillar(o, d, CENTER[0], CENTER[1], RADIUS, REACH),
    "line": lambda o, d: ray_to_line(o, d, CENTER, NORMAL, RADIUS, REACH),
    "box": lambda o, d: ray_to_box(o, d, CENTER, HALF, REACH),
}

every_distance = pytest.mark.parametrize("shape", DISTANCES)
every_ray = pytest.mark.parametrize("shape", RAYS)


def numpy_distances(shape, p):
    """The distances by other words, for points of shape (n, 3)."""
    if shape == "sphere":
        return np.linalg.norm(p - CENTER, axis=1) - RADIUS
    if shape == "plane":
        return p @ NORMAL - OFFSET
    if shape == "pillar":
        return np.linalg.norm(p[:, :2] - CENTER[:2], axis=1) - RADIUS
    if shape == "line":
        return np.linalg.norm(np.cross(p - CENTER, NORMAL), axis=1) - RADIUS
    q = np.abs(p - CENTER) - HALF
    return np.where((q <= 0.0).all(axis=1), q.max(axis=1), np.linalg.norm(np.maximum(q, 0.0), axis=1))


@every_distance
@given(one=points, other=points)
def test_a_distance_changes_by_no_more_than_the_point_moves(shape, one, other):
    distance = DISTANCES[shape]
    assert abs(distance(one) - distance(other)) <= math.dist(one, other) + 1e-12


@every_distance
@given(point=points)
def test_the_gradient_is_of_length_one_and_leads_to_the_surface(shape, point):
    """Where there is one: not on the axes of a shape, where nearest points change from one to another."""
    distance, step = DISTANCES[shape], 1e-5
    axes = step * np.eye(3)
    up = np.array([distance(tuple(point + axis)) for axis in axes])
    down = np.array([distance(tuple(point - axis)) for axis in axes])
    curved = np.abs(up + down - 2.0 * distance(point)).max()
    assume(curved < 1e-8)
    gradient = (up - down) / (2.0 * step)
    assert np.linalg.norm(gradient) == pytest.approx(1.0, abs=1e-4)
    assume(distance(point) > -0.4)  # from deep inside, the way out may lead past an edge
    surface = tuple(np.array(point) - distance(point) * gradient)
    assert distance(surface) == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("shape", RAYS)
@given(point=points)
def test_distances_are_those_of_numpy(shape, point):
    assert DISTANCES[shape](point) == pytest.approx(numpy_distances(shape, np.array([point]))[0], abs=1e-12)


@given(point=points)
def test_the_distance_to_a_pipe_is_that_to_the_nearest_of_many_points_on_it(point):
    on_it = np.concatenate([np.linspace(a, b, 4001) for a, b in itertools.pairwise(CORNERS)])
    nearest = np.linalg.norm(on_it - point, axis=1).min() - RADIUS
    assert nearest - 1e-3 <= to_pipe(point) <= nearest + 1e-12


@every_ray
@given(origin=points, direction=directions())
@example(origin=(0.0, 0.0, 0.0), direction=(0.0, 0.0, 1.0))  # in a face of the box
def test_a_ray_ends_where_many_small_steps_first_find_the_shape(shape, origin, direction):
    step = 2e-3
    along = np.arange(0.0, REACH, step)
    depths = -numpy_distances(shape, np.array(origin) + along[:, None] * np.array(direction))
    inside = depths > 1e-9  # a ray that runs in a face may meet the shape or not
    found = RAYS[shape](origin, direction)
    if inside.any():
        first = along[inside.argmax()]
        assert found <= first + 1e-9
        if found < first - step - 1e-9:  # it grazed the shape between two steps
            grazed = numpy_distances(shape, np.array([origin]) + found * np.array([direction]))[0]
            assert abs(grazed) < 1e-6
    elif found < REACH:
        grazed = numpy_distances(shape, np.array([origin]) + found * np.array([direction]))[0]
        assert abs(grazed) < 1e-6


@every_ray
@given(origin=points, direction=directions())
def test_sphere_tracing_never_passes_what_a_ray_meets_and_comes_near_it(shape, origin, direction):
    def distance(own, point):
        return DISTANCES[own](point)

    traced = make_trace(distance, 400)(shape, origin, direction, REACH)
    met = RAYS[shape](origin, direction)
    assert traced <= met + 1e-9
    end = tuple(np.array(origin) + traced * np.array(direction))
    assert (
        traced == pytest.approx(met, abs=1e-3) or DISTANCES[shape](end) < 0.05
    )  # along a surface it is slow


@every_ray
def test_a_ray_from_inside_has_no_length(shape):
    inside = CENTER if shape != "plane" else (-5.0, 5.0, -5.0)
    assert RAYS[shape](inside, (0.0, 0.6, 0.8)) == 0.0


@every_ray
@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)])
def test_rays_along_the_axes_are_finite(shape, direction):
    for origin in (CENTER, (0.0, 0.0, 0.0), (2.0, 0.0, 3.5), (1.0, -4.0, -9.0)):
        assert 0.0 <= RAYS[shape](origin, direction) <= REACH
