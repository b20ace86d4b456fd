"""Elementary functions in lanes: those of one number."""

import numpy as np
import pytest
from hypothesis import given
from support.lane_numbers import by_rows, in_lanes, rows_of, same_bits

from dq_marine.algebra.elementary import arctangent, exponential, logarithm, sine_and_cosine
from dq_marine.algebra.selection import exponent_of, power_of_two, rounded


def elementary(a, b):
    """Functions of arithmetic alone, and the two steps that they are made with."""
    whole, positive = rounded(max(min(b, 90.0), -90.0)), max(abs(b), 1e-30)
    steps = (whole, power_of_two(whole), exponent_of(positive))
    return exponential(a), arctangent(a, b), *sine_and_cosine(a), logarithm(positive), *steps


ELEMENTARY = 8


@given(rows=rows_of(2))
def test_elementary_functions_have_the_bits_of_a_single_number(rows):
    assert same_bits(in_lanes(elementary, rows, ELEMENTARY), by_rows(elementary, rows, ELEMENTARY))


@pytest.mark.parametrize(("arithmetic", "error"), [("strict", 1e-6), ("fast", 1e-5)])
@given(rows=rows_of(2, "float32", min_value=-80.0, max_value=80.0, allow_subnormal=False))
def test_elementary_functions_have_the_digits_of_single_precision(arithmetic, error, rows):
    """Fast arithmetic joins the two parts of a constant again, and so loses a digit of large arguments.

    A quotient below the smallest normal number has fewer digits.
    """
    rows = np.where(np.isfinite(rows), rows, np.float32(1.0))
    found = in_lanes(elementary, rows, ELEMENTARY, "float32", arithmetic)
    expected = by_rows(elementary, rows, ELEMENTARY)
    np.testing.assert_allclose(
        found[:, :2], expected[:, :2], rtol=error, atol=float(np.finfo(np.float32).tiny)
    )
    np.testing.assert_allclose(found[:, 2:5], expected[:, 2:5], rtol=error, atol=error)
    assert np.array_equal(found[:, 5:], expected[:, 5:])
