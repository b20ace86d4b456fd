"""Choosing, for one body or for each of many at once.

A condition is a bool for one body. Where a backend runs pure functions on many bodies in lanes, a number of theirs is
one number per lane, and so is a condition: `if`, `and`, `or` and `not` cannot ask it. What a pure function decides
between is therefore written with `&`, `|` and these functions, which backends replace by their own for lanes. A
condition may be asked by `some` and `every`, to leave out work that no body needs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


def spread(value: T, like: float) -> T:
    """Return a number or condition that is the same for all bodies, in as many lanes as `like` has."""
    return value


def by_precision(like: float, double: float, single: float) -> float:
    """Return the constant that goes with the precision in which `like` is computed."""
    return double


def smallest_normal(like: float) -> float:
    """Return a number that changes no other but 0, and so keeps 0/0 away, in the precision of `like`."""
    return by_precision(like, 2.3e-308, 1.2e-38)


def rounded(value: float) -> float:
    """Return the whole number next to a finite number, the even one of two."""
    return float(round(value))


def power_of_two(exponent: float) -> float:
    """Return 2^exponent, for a whole number such that the power is a normal number in its precision."""
    return math.ldexp(1.0, int(exponent))


def exponent_of(value: float) -> float:
    """Return the whole number k for which 2^k <= value < 2^(k + 1), of a positive normal number."""
    return float(math.frexp(value)[1] - 1)


def select(condition: bool, chosen: T, otherwise: T) -> T:
    """Return `chosen` where the condition holds, else `otherwise`: numbers, or (nested) tuples of them alike."""
    return chosen if condition else otherwise


def negation(condition: bool) -> bool:
    """Return True where the condition does not hold."""
    return not condition


def some(condition: bool) -> bool:
    """Whether the condition holds for any body."""
    return condition


def every(condition: bool) -> bool:
    """Whether the condition holds for all bodies."""
    return condition


def select_call(condition: bool, function: Callable[..., T], arguments: tuple[Any, ...], otherwise: T) -> T:
    """Return function(*arguments) where the condition holds, else `otherwise`.

    In lanes, the function is called for one body at a time, with that body's numbers.
    """
    return function(*arguments) if condition else otherwise
