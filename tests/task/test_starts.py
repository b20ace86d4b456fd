"""Starts that several tasks draw: where they go."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.quaternion import rotate
from dq_marine.task.starts import under_way


@given(heading=st.floats(-7.0, 7.0), speed=st.floats(0.0, 10.0))
def test_a_start_under_way_goes_level_where_it_heads(heading, speed):
    begun = under_way((1.0, -2.0, 3.0), heading, speed)
    gone = rotate(begun.attitude, begun.velocity.linear)
    assert begun.position_ned == (1.0, -2.0, 3.0)
    assert gone == pytest.approx((speed * math.cos(heading), speed * math.sin(heading), 0.0), abs=1e-12)
    assert begun.velocity.angular == (0.0, 0.0, 0.0)
