"""Elementary functions in lanes: those of one number."""

import numpy as np
import pytest
from hypothesis import given, settings
from support.lane_numbers import by_rows, in_lanes, rows_of, same_bits

from dq_marine.algebra.elementary import arctangent, exponential, sine_and_cosine
from dq_marine.algebra.selection import power_of_two, rounded


def elementary(a, b):
    """Functions of arithmetic alone, and the two steps that they are made with."""
    turns = rounded(max(min(b, 90.0), -90.0))
    return exponential(a), arctangent(a, b), *sine_and_cosine(a), turns, power_of_two(turns)


ELEMENTARY = 6


@settings(max_examples=300)
@given(rows=rows_of(2))
def test_elementary_functions_have_the_bits_of_a_single_number(rows):
    assert same_bits(in_lanes(elementary, rows, ELEMENTARY), by_rows(elementary, rows, ELEMENTARY))


@pytest.mark.parametrize(("arithmetic", "error"), [("strict", 1e-6), ("fast", 1e-5)])
@settings(max_examples=300)
@given(rows=rows_of(2, "float32", min_value=-80.0, max_value=80.0, allow_subnormal=False))
def test_elementary_functions_have_the_digits_of_single_precision(arithmetic, error, rows):
    """Fast arithmetic joins the two parts of a constant again, and so loses a digit of large arguments."""
    rows = np.where(np.isfinite(rows), rows, np.float32(1.0))
    found = in_lanes(elementary, rows, ELEMENTARY, "float32", arithmetic)
    expected = by_rows(elementary, rows, ELEMENTARY)
    np.testing.assert_allclose(found[:, :2], expected[:, :2], rtol=error)
    np.testing.assert_allclose(found[:, 2:4], expected[:, 2:4], atol=error)
    assert np.array_equal(found[:, 4:], expected[:, 4:])
