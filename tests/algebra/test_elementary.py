"""Elementary functions by arithmetic: those of the library, with the same bits in any engine."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.algebra.elementary import arctangent, exponential, logarithm, sine_and_cosine
from dq_marine.backend.batched import batched


def last_digits(found, right):
    """How many units in the last place numbers are off."""
    return np.abs(np.asarray(found) - right) / np.spacing(np.abs(right))


@given(st.floats(-1e4, 1e4))
def test_sine_and_cosine_are_those_of_the_library(angle):
    assert sine_and_cosine(angle) == pytest.approx((math.sin(angle), math.cos(angle)), abs=2.3e-16)


def test_they_are_so_on_both_sides_of_every_eighth_of_a_turn():
    for eighth in range(-40, 41):
        for off in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3):
            angle = 0.25 * math.pi * eighth + off
            expected = (math.sin(angle), math.cos(angle))
            assert sine_and_cosine(angle) == pytest.approx(expected, abs=2.3e-16)


def test_they_have_length_one():
    for angle in np.linspace(-50.0, 50.0, 1001).tolist():
        assert math.hypot(*sine_and_cosine(angle)) == pytest.approx(1.0, abs=1e-15)


@given(st.floats(-708.0, 709.0))
def test_the_exponential_is_that_of_the_library(x):
    assert last_digits(exponential(x), math.exp(x)) <= 2.0


@given(st.floats(-1e300, -708.0), st.floats(709.0, 1e300))
def test_beyond_its_range_the_exponential_stays_where_it_is(low, high):
    assert exponential(low) == exponential(-708.0)
    assert exponential(high) == exponential(709.0)
    assert exponential(0.0) == 1.0


@given(st.floats(2.3e-308, 1.7e308))
def test_the_logarithm_is_that_of_the_library(x):
    assert logarithm(x) == pytest.approx(math.log(x), rel=4e-16, abs=0.0)


def test_the_logarithm_is_so_around_one_and_each_power_of_two():
    for power in range(-40, 41):
        for factor in (1.0 - 1e-3, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 1.0 + 1e-3, math.sqrt(2.0)):
            x = 2.0**power * factor
            assert logarithm(x) == pytest.approx(math.log(x), rel=4e-16, abs=0.0)


SIDES = st.floats(-1e150, 1e150, allow_subnormal=False)


@given(SIDES, SIDES)
def test_the_arctangent_is_that_of_the_library(y, x):
    """The two zeros count as one."""
    expected = math.atan2(y + 0.0, x + 0.0)
    assert arctangent(y, x) == pytest.approx(expected, rel=1e-15, abs=1e-300)


def test_the_arctangent_is_so_around_every_sixteenth_of_a_turn():
    for sixteenth in range(-8, 9):
        for off in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3):
            angle = max(-math.pi, min(math.pi, math.pi / 8.0 * sixteenth + off))
            y, x = math.sin(angle), math.cos(angle)
            assert arctangent(y, x) == pytest.approx(math.atan2(y, x), rel=1e-15)


def test_compiled_they_have_the_bits_of_plain_python():
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-700.0, 700.0, 400), rng.normal(size=400)
    assert batched(exponential)(x).tolist() == [exponential(v) for v in x.tolist()]
    positive = [2.3e-308, 1.0, 1.7e308, *np.abs(x).tolist()]
    assert batched(logarithm)(np.array(positive)).tolist() == [logarithm(v) for v in positive]
    plain = [arctangent(b, a) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    assert batched(arctangent)(y, x).tolist() == plain
