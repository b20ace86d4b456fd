"""Starts that several tasks draw: where they go."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.quaternion import rotate
from dq_marine.task.starts import beside_start, under_way


@given(heading=st.floats(-7.0, 7.0), speed=st.floats(0.0, 10.0))
def test_a_start_under_way_goes_level_where_it_heads(heading, speed):
    begun = under_way((1.0, -2.0, 3.0), heading, speed)
    gone = rotate(begun.attitude, begun.velocity.linear)
    assert begun.position_ned == (1.0, -2.0, 3.0)
    assert gone == pytest.approx((speed * math.cos(heading), speed * math.sin(heading), 0.0), abs=1e-12)
    assert begun.velocity.angular == (0.0, 0.0, 0.0)


UNIFORM = st.floats(0.0, 1.0, exclude_max=True)


@given(st.tuples(UNIFORM, UNIFORM, UNIFORM), st.floats(0.1, 5.0), st.floats(-math.pi, math.pi))
def test_a_start_beside_a_place_goes_about_where_it_is_led(uniforms, speed, course):
    led = (speed * math.cos(course), speed * math.sin(course))
    begun = beside_start((1.0, -2.0, 3.0), 4.0, led, 0.2, uniforms, 0)
    north, east, down = rotate(begun.attitude, begun.velocity.linear)
    assert math.dist(begun.position_ned, (1.0, -2.0, 3.0)) <= 4.0 + 1e-9
    assert begun.position_ned[2] == 3.0
    assert math.hypot(north, east) == pytest.approx(speed)
    assert down == pytest.approx(0.0, abs=1e-12)
    assert north * led[0] + east * led[1] >= speed**2 * math.cos(0.2) - 1e-9
