"""Nested tuples: their numbers, one after the other, and sequences as nested pairs, (first, (second, (..., ())))."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Any, TypeVar

from dq_marine.algebra.table import Table

Item = TypeVar("Item")
Joined = TypeVar("Joined")


def folded(link: Callable[[Item, Any], Joined], items: Sequence[Item], end: Any) -> Joined:
    """Return link(first, link(second, ... link(last, end))).

    With functions for items it makes one function of many, which compiled code calls one inside the other: `link`
    takes one of them, and the function for all after it.
    """
    joined: Joined = end
    for item in reversed(items):
        joined = link(item, joined)
    return joined


def nested(items: Sequence[Any]) -> Any:
    """Return (first, (second, (..., ())))."""
    return folded(lambda first, rest: (first, rest), items, ())


def alike(structure: tuple[Any, ...], parts: list[Any]) -> Any:
    """Return a tuple of the structure's type, of these parts."""
    if hasattr(structure, "_fields"):
        return type(structure)(*parts)
    return type(structure)(parts)


def numbers_of(structure: Any) -> Iterator[Any]:
    """Yield the numbers of nested tuples, or what stands for them, depth first."""
    if isinstance(structure, tuple):
        for part in structure:
            yield from numbers_of(part)
    else:
        yield structure


def rebuild(like: Any, numbers: Iterator[Any]) -> Any:
    """Return nested tuples shaped as `like`, of the given numbers, depth first."""
    if not isinstance(like, tuple):
        return next(numbers)
    if isinstance(like, Table):  # of a sea, some thousands: all at once
        return Table(islice(numbers, len(like)))
    return alike(like, [rebuild(part, numbers) for part in like])
