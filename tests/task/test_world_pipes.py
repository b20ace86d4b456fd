"""Pipes on a seabed: against plain NumPy, and the laws that they keep."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.world.keel import Keel
from dq_marine.task.world.pipes import LaidPipe, Pipe, Sight, beside_pipe, detected, make_pipe, sight
from dq_marine.task.world.seabed import WAVE_DRAWS, make_seabed

WAVES, RADIUS = 3, 0.4
SEABED = make_seabed(WAVES)
PIPE = make_pipe(SEABED.along, SEABED.cast)

angles = st.floats(-math.pi, math.pi)
seeds = st.integers(0, 10**6)


def ground(seed):
    return SEABED.drawn(
        30.0, 0.4, 40.0, tuple(np.random.default_rng(seed).random(WAVES * WAVE_DRAWS).tolist()), 0
    )


def motion(place, heading, velocity=(1.0, 0.2, 0.1), pitch=0.0):
    return Motion(place, quaternion_from_euler(0.0, pitch, heading), Spatial((0.0, 0.0, 0.0), velocity))


@given(seed=seeds, course=angles, length=st.floats(0.1, 10.0))
def test_a_laid_pipe_runs_along_the_ground_and_lies_on_it(seed, course, length):
    own, place = ground(seed), (3.0, -2.0)
    pipe = PIPE.laid(own, place, (length * math.cos(course), length * math.sin(course)), RADIUS)
    step, axis = 1e-4, np.array(pipe.axis)
    along = np.array([math.cos(course), math.sin(course)])
    before, after = (SEABED.depth(own, *(np.array(place) + s * along)) for s in (-step, step))
    assert np.linalg.norm(axis) == pytest.approx(1.0)
    assert axis[2] / np.linalg.norm(axis[:2]) == pytest.approx((after - before) / (2.0 * step), abs=1e-6)
    assert np.allclose(axis[:2] / np.linalg.norm(axis[:2]), along)
    assert pipe.on_axis[:2] == place
    to_ground = np.array([*place, SEABED.depth(own, *place)]) - pipe.on_axis
    assert np.linalg.norm(np.cross(to_ground, axis)) == pytest.approx(RADIUS)


@given(seed=seeds, tilt=st.floats(-0.8, 0.8), aside=st.floats(-3.0, 3.0))
def test_a_beam_ends_where_marching_points_first_are_in_the_pipe_or_the_ground(seed, tilt, aside):
    own = ground(seed)
    pipe = PIPE.laid(own, (0.0, 0.0), (1.0, 0.0), RADIUS)
    origin = (0.0, aside, SEABED.depth(own, 0.0, aside) - 4.0)
    direction = (0.0, math.sin(tilt), math.cos(tilt))
    found = PIPE.cast(LaidPipe(own, pipe), origin, direction, 10.0)
    ways = np.arange(0.0, 10.0, 2e-3)
    points = np.array(origin) + ways[:, None] * np.array(direction)
    in_pipe = np.linalg.norm(np.cross(points - pipe.on_axis, pipe.axis), axis=1) < RADIUS
    in_ground = points[:, 2] > [SEABED.depth(own, *point[:2]) for point in points]
    first = ways[(in_pipe | in_ground).argmax()]
    assert found == pytest.approx(first, abs=0.01) or (found < first and not in_pipe.any())
    assert found <= first + 1e-9


@given(heading=angles, course=st.floats(-1.0, 1.0), aside=st.floats(-2.0, 2.0), ahead=st.floats(1.0, 9.0))
def test_a_sight_is_where_the_line_crosses_that_square_to_the_bow(heading, course, aside, ahead):
    """The place is made of the answer: some way along the line from the crossing."""
    bow = np.array([math.cos(heading), math.sin(heading)])
    starboard = np.array([-bow[1], bow[0]])
    way = np.array([math.cos(heading + course), math.sin(heading + course)])
    own = motion((5.0, -3.0, 20.0), heading)
    place = np.array([5.0, -3.0]) + ahead * bow + aside * starboard - 1.7 * way
    found = sight(own, tuple(place.tolist()), tuple((3.0 * way).tolist()), ahead)
    assert found.starboard == pytest.approx(aside, abs=1e-9)
    assert found.bearing == pytest.approx(course, abs=1e-9)


@given(heading=angles)
def test_a_line_across_the_bow_has_a_sight_that_is_finite(heading):
    found = sight(motion((0.0, 0.0, 0.0), heading), (4.0, 1.0), (-math.sin(heading), math.cos(heading)), 3.0)
    assert math.isfinite(found.starboard)
    assert found.bearing == pytest.approx(0.5 * math.pi)


@given(
    course=angles,
    heading=angles,
    aside=st.floats(-2.0, 2.0),
    high=st.floats(1.0, 6.0),
    along=st.floats(-5.0, 5.0),
)
def test_beside_a_level_pipe_all_is_as_seen_in_its_own_axes(course, heading, aside, high, along):
    axis = (math.cos(course), math.sin(course), 0.0)
    starboard = (-axis[1], axis[0])
    place = (
        2.0 + along * axis[0] + aside * starboard[0],
        1.0 + along * axis[1] + aside * starboard[1],
        30.0 - high,
    )
    pipe, keel = Pipe((2.0, 1.0, 30.0), axis, RADIUS), Keel(1.0, 0.25)
    by = beside_pipe(pipe, motion(place, heading, velocity=(2.0, 0.0, 0.3)), keel)
    assert (by.starboard, by.height) == pytest.approx((aside, high))
    assert by.speed == pytest.approx(2.0 * math.cos(heading - course), abs=1e-9)
    assume(abs(abs(math.remainder(heading - course, math.tau)) - math.pi) > 1e-3)
    assert by.askew == pytest.approx(math.remainder(heading - course, math.tau), abs=1e-9)
    across = math.sin(heading - course)
    nearest = min(math.hypot(aside + s * across, high) for s in (-1.0, 0.0, 1.0))
    assert by.clearance == pytest.approx(nearest - RADIUS - 0.25)


def test_a_detector_tells_what_it_sees_with_its_errors_and_zeros_otherwise():
    widest, errors = Sight(2.0, 1.0), Sight(0.1, -0.2)
    assert detected(Sight(1.0, 0.5), errors, widest, False) == (1.0, 1.1, 0.3)
    nothing = (0.0, 0.0, 0.0)
    assert detected(Sight(1.0, 0.5), errors, widest, True) == nothing
    assert detected(Sight(-2.5, 0.5), errors, widest, False) == nothing
    assert detected(Sight(1.0, -0.9), errors, widest, False) == nothing
