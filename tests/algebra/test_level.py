"""Level vectors against complex numbers, and against rotations in space: north is 1, east is i, turns are clockwise."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.level import (
    level_along,
    level_bow,
    level_cross,
    level_dot,
    level_length,
    level_turned,
    seen_at,
)

angles = st.floats(-math.pi, math.pi)
sizes = st.floats(-1e3, 1e3)
vectors = st.tuples(sizes, sizes)


@given(a=vectors, b=vectors)
def test_products_and_length_are_those_of_complex_numbers(a, b):
    product = complex(*a).conjugate() * complex(*b)
    assert level_dot(a, b) == pytest.approx(product.real, abs=1e-9)
    assert level_cross(a, b) == pytest.approx(product.imag, abs=1e-9)
    assert level_length(a) == pytest.approx(abs(complex(*a)))


@given(a=vectors, angle=angles)
def test_turning_is_to_starboard(a, angle):
    assert complex(*level_turned(a, angle)) == pytest.approx(complex(*a) * cmath.exp(1j * angle), abs=1e-9)


@given(a=vectors, angle=angles)
def test_along_a_unit_vector_is_turned_by_its_angle(a, angle):
    ahead = (math.cos(angle), math.sin(angle))
    assert level_along(a, ahead) == pytest.approx(level_turned(a, angle), abs=1e-9)
    assert level_dot(ahead, level_along(a, ahead)) == pytest.approx(a[0], abs=1e-9), (
        "and seen from it as it was"
    )
    assert level_cross(ahead, level_along(a, ahead)) == pytest.approx(a[1], abs=1e-9)


@pytest.mark.parametrize("bearing", range(-179, 181, 3))
def test_bearings_are_clockwise_from_the_bow(bearing):
    for course in (0.0, 1.0, -2.5):
        bow, offset = cmath.rect(3.0, course), cmath.rect(7.0, course + math.radians(bearing))
        seen = seen_at((bow.real, bow.imag), (offset.real, offset.imag))
        assert math.degrees(seen) == pytest.approx(bearing)


@given(roll=angles, pitch=st.floats(-1.5, 1.5), heading=angles)
def test_a_bow_points_where_the_vehicle_heads_however_it_is_tilted(roll, pitch, heading):
    bow = level_bow(quaternion_from_euler(roll, pitch, heading))
    assert complex(*bow) == pytest.approx(cmath.exp(1j * heading), abs=1e-9)


@pytest.mark.parametrize("pitch", [0.5 * math.pi, -0.5 * math.pi])
def test_of_a_vehicle_that_stands_upright_no_bow_is_seen_from_above(pitch):
    assert level_length(level_bow(quaternion_from_euler(0.0, pitch, 0.7))) < 1e-6
