"""Sine and cosine by arithmetic: those of the library."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.sines import sine_cosine


@given(st.floats(-1e4, 1e4))
def test_they_are_those_of_the_library(angle):
    assert sine_cosine(angle) == pytest.approx((math.sin(angle), math.cos(angle)), abs=1e-14)


def test_they_are_so_on_both_sides_of_every_eighth_of_a_turn():
    for eighth in range(-40, 41):
        for off in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3):
            angle = 0.25 * math.pi * eighth + off
            assert sine_cosine(angle) == pytest.approx((math.sin(angle), math.cos(angle)), abs=1e-14)


def test_they_have_length_one():
    for angle in np.linspace(-50.0, 50.0, 1001).tolist():
        assert math.hypot(*sine_cosine(angle)) == pytest.approx(1.0, abs=1e-15)
