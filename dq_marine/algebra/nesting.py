"""Nested tuples: sequences as nested pairs, (first, (second, (..., ()))), and functions that take such pairs apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

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
