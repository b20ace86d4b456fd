"""Products that are added to single numbers of a structure, at places that are known before compilation.

A number's place in (nested tuples of) numbers is counted depth first, from 0.
"""

from __future__ import annotations

from typing import Any, TypeVar, cast

from dq_marine.algebra.nesting import numbers_of, rebuild

Target = TypeVar("Target")


class Places(tuple[tuple[int, int, int], ...]):
    """Of each product: the place that it is added to, that of its first factor and that of its second."""

    __slots__ = ()


def add_products(places: Places, target: Target, first: Any, second: Any) -> Target:
    """Return `target` with the products of numbers of `first` and `second` added to some of its numbers.

    Args:
        places: which, one product after the other; a closure's, so that compiled code knows them.
        target: (nested tuples of) numbers.
        first: (nested tuples of) numbers, or one number.
        second: likewise.
    """
    numbers, left, right = list(numbers_of(target)), list(numbers_of(first)), list(numbers_of(second))
    for place, i, j in places:
        numbers[place] = numbers[place] + left[i] * right[j]
    return cast(Target, rebuild(target, iter(numbers)))
