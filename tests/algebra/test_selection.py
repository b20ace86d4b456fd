"""Choosing in plain Python, for one body: conditions are bools."""

from typing import NamedTuple

import pytest

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

BOTH = pytest.mark.parametrize("condition", [False, True])


class Pair(NamedTuple):
    first: float
    second: tuple[float, float]


@BOTH
def test_one_body_is_some_and_every_body(condition):
    assert some(condition) is condition
    assert every(condition) is condition
    assert negation(condition) is not condition


@BOTH
def test_select_returns_one_of_two_as_it_is(condition):
    chosen, otherwise = Pair(1.0, (2.0, 3.0)), Pair(4.0, (5.0, 6.0))
    assert select(condition, chosen, otherwise) is (chosen if condition else otherwise)
    assert select(condition, 1.0, 2.0) == (1.0 if condition else 2.0)


@BOTH
def test_a_function_is_called_only_where_its_result_is_chosen(condition):
    calls = []

    def function(a, b):
        calls.append((a, b))
        return a + b

    assert select_call(condition, function, (1.0, 2.0), 7.0) == (3.0 if condition else 7.0)
    assert calls == ([(1.0, 2.0)] if condition else [])


@pytest.mark.parametrize("value", [True, 2.5, (1.0, (2.0, False))])
def test_spread_leaves_a_value_as_it_is(value):
    assert spread(value, 0.0) is value


def test_plain_python_computes_in_double_precision():
    assert by_precision(0.0, 1.0, 2.0) == 1.0
    normal = smallest_normal(0.0)
    assert normal > 0.0
    assert 0.0 / (0.0 + normal) == 0.0


@pytest.mark.parametrize("number", [1e-280, -1e-280, 1.0])
def test_the_smallest_normal_changes_no_other_number_but_zero(number):
    assert number + smallest_normal(number) == number
