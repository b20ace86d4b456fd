"""Numbers side by side in lanes: each lane has the bits that one number has in compiled code."""

import functools
import math
import sys
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numba.core.errors import TypingError
from support.lane_numbers import WIDTHS, by_rows, in_lanes, rows_of, same_bits

from dq_marine.algebra.selection import (
    by_precision,
    every,
    negation,
    select,
    select_call,
    smallest_normal,
    some,
    spread,
)
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.simd.lanes import lanes_of
from dq_marine.backend.simd.rows import make_load_rows, store_rows

BOTH = pytest.mark.parametrize("precision", WIDTHS)


def everything(a, b):
    """All operators and functions that lanes have; the constants are exact in single precision too."""
    c = a
    c += b
    d = a
    d -= b
    e = a
    e *= b
    f = a
    f /= b
    return (
        (a + b, a - b, a * b, a / b, c, d, e, f),
        (a + 2.5, 2.5 + a, a - 2.5, 2.5 - a, a * 3, 3 * a, a / 3, 3 / a, a + True),
        (-a, abs(a), max(a, b), min(a, b), max(a, 0.5), min(0.5, a), max(a, -1), math.sqrt(a)),
        (math.exp(a), math.log(a), math.sin(a), math.cos(a), math.tan(a), math.atan2(a, b)),
        (math.atan2(a, 1.5), math.atan2(2, a)),
        (a < b, a <= b, a > b, a >= b, a == b, a != b, a < 1.0, 1.0 < a, a == 0, 1 >= a),  # noqa: SIM300
    )


RESULTS = 8 + 9 + 8 + 6 + 2 + 10


@settings(max_examples=300)
@given(rows=rows_of(2))
def test_every_operation_has_the_bits_of_a_single_number(rows):
    assert same_bits(in_lanes(everything, rows, RESULTS), by_rows(everything, rows, RESULTS))


@settings(max_examples=300)
@given(rows=rows_of(2, "float32"))
def test_every_operation_is_rounded_to_single_precision(rows):
    """To the nearest: rounded once more, what double precision gives of two such numbers is that."""
    with np.errstate(over="ignore"):
        expected = by_rows(everything, rows, RESULTS).astype(np.float32)
    own = in_lanes(everything, rows, RESULTS, "float32")
    assert np.array_equal(own, own.astype(np.float32), equal_nan=True)
    assert same_bits(own, expected)


def beyond_single(a):
    return a * 0.1, a + 1e-3, spread(smallest_normal(a), a)


def test_constants_are_rounded_to_the_precision_of_the_lanes():
    rows = np.linspace(-3.0, 5.0, 16, dtype=np.float32)[:, None]
    a = rows[:, 0]
    expected = [a * np.float32(0.1), a + np.float32(1e-3), np.full(16, np.float32(1.2e-38))]
    assert same_bits(in_lanes(beyond_single, rows, 3, "float32"), np.stack(expected, axis=1))


def python_max_min(a, b):
    return max(a, b), min(a, b), max(b, a), min(b, a)


@given(rows=rows_of(2))
def test_max_and_min_choose_as_python_does(rows):
    """The first unless the second is larger: which says what becomes of NaN and of the zeros' signs."""
    expected = [python_max_min(*row) for row in rows.tolist()]
    assert same_bits(in_lanes(python_max_min, rows, 4), np.array(expected))


def finiteness(a, b):
    total = a + b
    return total - total == 0.0, a == a, (a < b) | (a >= b)


@BOTH
@pytest.mark.parametrize("arithmetic", ["strict", "fast"])
def test_nan_and_infinity_keep_their_meaning(precision, arithmetic):
    inf, nan = math.inf, math.nan
    pairs = [
        (1.0, 2.0),
        (nan, 1.0),
        (1.0, nan),
        (inf, 1.0),
        (1.0, -inf),
        (inf, -inf),
        (0.0, -0.0),
        (inf, inf),
    ]
    rows = np.array(pairs * 2)[: WIDTHS[precision]]
    expected = [
        [math.isfinite(a + b), a == a, not (math.isnan(a) or math.isnan(b))] for a, b in rows.tolist()
    ]
    assert np.array_equal(in_lanes(finiteness, rows, 3, precision, arithmetic), expected)


# Conditions


def logic(a, b):
    p, q = a > 0.0, b > 0.0
    return p & q, p | q, p ^ q, negation(p), p & True, p | False, negation(p & q) | (p & negation(q))


@given(rows=rows_of(2))
def test_conditions_are_joined_lane_by_lane(rows):
    p, q = rows.T > 0.0
    expected = [p & q, p | q, p ^ q, ~p, p, p, ~(p & q) | (p & ~q)]
    assert np.array_equal(in_lanes(logic, rows, 7), np.stack(expected, axis=1))


def questions(a):
    p = a > 0.0
    one = 1.0 if some(p) else 0.0
    return spread(one, a), spread(every(p), a), spread(some(negation(p)), a)


@BOTH
@pytest.mark.parametrize("positive", [[], [0], [5, 7], [7], list(range(8)), list(range(16))], ids=str)
def test_some_and_every_ask_all_lanes(precision, positive):
    rows = np.full((WIDTHS[precision], 1), -1.0)
    rows[[lane for lane in positive if lane < len(rows)]] = 1.0
    expected = [(rows > 0.0).any(), (rows > 0.0).all(), (rows <= 0.0).any()]
    assert np.array_equal(in_lanes(questions, rows, 3, precision), [expected] * len(rows))


class Pair(NamedTuple):
    first: float
    second: tuple[float, tuple[float, bool]]


def choices(a, b):
    here, there = Pair(a, (b, (a + b, a > b))), Pair(-a, (1.5, (2, False)))
    chosen, back = select(a > b, here, there), select(a > b, there, here)
    return (
        chosen.first,
        chosen.second,
        back,
        select(a > b, 1, 0),
        select(b >= a, True, a == a),
        select(True, a, b),
    )


def chosen_of(a, b):
    here, there = [a, b, a + b, a > b], [-a, 1.5, 2.0, False]
    condition = a > b
    chosen, back = (here, there) if condition else (there, here)
    return [*chosen, *back, condition, True if b >= a else a == a, a]


@given(rows=rows_of(2))
def test_select_takes_tuples_apart(rows):
    with np.errstate(over="ignore", invalid="ignore"):
        expected = [chosen_of(a, b) for a, b in rows]
    assert same_bits(in_lanes(choices, rows, 11), np.array(expected, dtype=float))


def counters(a, b):
    count = spread(0, a)
    count = count + select(a > 0.0, 1, 0)
    count = count + select(b > 0.0, 3, 0) - 1
    return count, count * 2, 5 - count, count == 3, max(count, 0)


@given(rows=rows_of(2))
def test_lanes_count(rows):
    count = (rows[:, 0] > 0.0).astype(int) + 3 * (rows[:, 1] > 0.0) - 1
    expected = [count, 2 * count, 5 - count, count == 3, np.maximum(count, 0)]
    assert np.array_equal(in_lanes(counters, rows, 5), np.stack(expected, axis=1))


# Calls for one lane at a time


def noted(calls, which, a, pair):
    """Counts calls, and takes 7 turns as a loop that no lane could leave alone."""
    calls[int(which)] += 1.0
    turns = 0.0
    while turns < a:
        turns += 7.0
    return Pair(turns, (pair.first + 0.1, (math.sqrt(a), turns > 14.0)))


@BOTH
@settings(max_examples=30)
@given(data=st.data())
def test_a_function_is_called_for_the_chosen_lanes_alone(precision, data):
    width = WIDTHS[precision]
    wanted = data.draw(arrays(bool, width))
    a = data.draw(arrays(np.float32, width, elements=st.floats(0.0, 50.0, width=32))).astype(float)
    rows = np.stack([np.arange(width), a, wanted], axis=1)
    calls, results = np.zeros(width), np.zeros((width, 4))
    references = sys.getrefcount(calls)
    compiled_select_call(precision)(rows, calls, results)
    assert np.array_equal(calls, wanted)
    assert sys.getrefcount(calls) == references
    rounded = (lambda x: x.astype(np.float32)) if precision == "float32" else np.asarray
    turns = 7.0 * np.ceil(a / 7.0)
    called = np.stack([turns, rounded(a + 0.1), rounded(np.sqrt(a)), turns > 14.0], axis=1)
    left = np.stack([a, np.full(width, -1.0), a, a > 3.0], axis=1)
    assert np.array_equal(results, np.where(wanted[:, None], called, left))


@functools.cache
def compiled_select_call(precision):
    load = make_load_rows(lanes_of(precision, "strict"), 3)

    def call_for_block(rows, calls, results):
        which, a, wanted = load(rows, 0)
        otherwise = Pair(a, (spread(-1.0, a), (a, a > 3.0)))
        store_rows(results, 0, select_call(wanted > 0.0, noted, (calls, which, a, otherwise), otherwise))

    return compile_function(call_for_block, precision)


# What is the same in all lanes


def spread_things(a):
    number, (condition, whole) = spread((0.1, (True, 3)), a)
    return number, condition, whole, spread(0.1, a > 0.0), spread(by_precision(a, 0.1, 0.7), a)


@BOTH
def test_spread_and_constants_follow_the_precision(precision):
    dtype, constant = np.dtype(precision).type, {"float64": 0.1, "float32": 0.7}[precision]
    expected = [dtype(0.1), True, 3, dtype(0.1), dtype(constant)]
    rows = np.zeros((WIDTHS[precision], 1))
    assert np.array_equal(in_lanes(spread_things, rows, 5, precision), [expected] * len(rows))


def plain(a, b):
    condition = a > b
    return (
        select(condition, a, b),
        select_call(condition, math.sqrt, (abs(a),), b),
        by_precision(a, 1.0, 2.0),
        spread(a, b),
        (negation(condition), some(condition), every(condition)),
    )


@given(rows=rows_of(2))
def test_one_number_chooses_in_compiled_code_as_in_plain_python(rows):
    expected = [(*flat, *last) for *flat, last in (plain(*row) for row in rows.tolist())]
    assert same_bits(by_rows(plain, rows, 7), np.array(expected, dtype=float))


# What would mean something else in lanes than for one number


@pytest.mark.parametrize(
    "expression",
    [
        "(a > 0.0) + (a > 1.0)",
        "2.5 * (a > 0.0)",
        "(a > 0.0) == 2",
        "select(a > 0.0, 1, 2) * 0.5",
        "select(a > 0.0, 1, 2) < 1.5",
        "select(a > 0.0, 3, 2) / 2",
        "-select(a > 0.0, 3, 2)",
        "math.sqrt(select(a > 0.0, 3, 2))",
        "select(a > 0.0, 1, 0.5)",
        "select(a > 0.0, select(a > 1.0, 1, 2), 0.5)",
        "negation(a)",
        "a & a",
        "a**2",
        "a if a > 0.0 else -a",
    ],
)
def test_what_lanes_cannot_do_as_one_number_does_is_refused(expression):
    """Or done: but never with another result."""
    function = eval(f"lambda a: {expression}", globals())
    rows = np.linspace(-2.0, 2.0, 8)[:, None]
    try:
        own = in_lanes(function, rows, 1)
    except TypingError:
        return
    assert np.array_equal(own[:, 0], [function(a) for a in rows[:, 0].tolist()])


def made_twice(sign):
    """Two functions of one name in one file."""
    if sign > 0:

        def shift(a):
            return a + 1.0
    else:

        def shift(a):
            return a - 1.0

    return shift


def test_functions_of_one_name_in_one_file_are_not_taken_for_each_other(tmp_path, monkeypatch):
    """Nor are two lambdas: compiled code on disk is found by more than names and the file's text."""
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))
    pairs = [(made_twice(1), made_twice(-1)), (lambda a: a + 1.0, lambda a: a - 1.0)]
    for up, down in pairs:
        assert [compile_function(function, "one name")(5.0) for function in (up, down)] == [6.0, 4.0]
