"""Lanes written as rows and as columns of arrays: every number comes to its place, with its bits."""

import numpy as np
import pytest

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.simd.lanes import lanes_of
from dq_marine.backend.simd.rows import make_load_rows, store_columns, store_rows

BLOCKS = 3


@pytest.mark.parametrize("precision", ["float64", "float32"])
@pytest.mark.parametrize("columns", [1, 3, 8, 21])
def test_rows_and_columns_hold_what_the_lanes_do(columns, precision):
    lanes = lanes_of(precision, "strict")
    load, bodies = make_load_rows(lanes, columns), BLOCKS * lanes.width

    def write(rows, single, double, signs, upright):
        for block in range(BLOCKS):
            numbers = load(rows, block)
            store_rows(single, block, numbers)
            store_rows(double, block, numbers)
            store_rows(signs, block, (numbers[0] > 0.0, numbers[-1] > 0.0))
            store_columns(upright, block, numbers)

    rows = np.random.default_rng(columns).normal(size=(bodies, columns))
    single, double = np.zeros((bodies, columns), np.float32), np.zeros((bodies, columns))
    signs, upright = np.zeros((bodies, 2), np.bool_), np.zeros((columns, bodies))
    compile_function(write, f"rows {columns} {lanes}")(rows, single, double, signs, upright)
    held = rows.astype(precision)
    assert np.array_equal(single, held.astype(np.float32))
    assert np.array_equal(double, held)
    assert np.array_equal(signs, rows[:, [0, -1]] > 0.0)
    assert np.array_equal(upright, held.T)
