"""Functions of numbers in lanes, and of one number after the other, to compare what they give."""

import functools
import math

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import store
from dq_marine.backend.simd.lanes import PRECISIONS, lanes_of
from dq_marine.backend.simd.rows import make_load_rows, store_rows

WIDTHS = {name: lanes_of(name, "strict").width for name in PRECISIONS}


def rows_of(columns, precision="float64", **limits):
    """Hypothesis strategy: a number for every lane and column, zeros, subnormals, infinities and NaN among them."""
    width = 64 if precision == "float64" else 32
    elements = st.floats(width=width, **limits) | st.sampled_from([0.0, -0.0, 1.0, math.inf])
    return arrays(f"float{width}", (WIDTHS[precision], columns), elements=elements)


@functools.cache
def compiled_in_lanes(function, columns, precision, arithmetic):
    """Compile (rows, results): a function of as many lanes as `columns`, for one block of rows."""
    load = make_load_rows(lanes_of(precision, arithmetic), columns)

    def apply_to_block(rows, results):
        store_rows(results, 0, function(*load(rows, 0)))

    return compile_function(apply_to_block, f"{columns} {precision} {arithmetic}")


@functools.cache
def compiled_by_rows(function):
    """Compile (rows, results): a function of two numbers, for one row after the other."""

    def apply_to_rows(rows, results):
        for row in range(rows.shape[0]):
            store(results[row], function(rows[row, 0], rows[row, 1]))

    return compile_function(apply_to_rows, "rows")


def in_lanes(function, rows, results, precision="float64", arithmetic="strict"):
    """What a function of lanes gives, a row for each lane."""
    out = np.full((len(rows), results), -7.0)
    compiled_in_lanes(function, rows.shape[1], precision, arithmetic)(rows, out)
    return out


def by_rows(function, rows, results):
    """What a function of two numbers gives for each row."""
    out = np.full((len(rows), results), -7.0)
    compiled_by_rows(function)(rows.astype(np.float64), out)
    return out


def same_bits(a, b):
    """Whether floats agree to the bit, with all NaN alike."""
    return np.array_equal(a, b, equal_nan=True) and np.array_equal(
        np.signbit(np.nan_to_num(a)), np.signbit(np.nan_to_num(b))
    )
