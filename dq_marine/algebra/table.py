"""Tables: many numbers of one kind, which a pure function asks for in a loop, or one by one by `entry`.

An ordinary tuple becomes one variable per number in compiled code, which is right for a matrix and wrong for the
hundreds of numbers of a sea. A table is left in memory, and read where it is asked.
"""

from __future__ import annotations


class Table(tuple[float, ...]):
    """Numbers that stay in memory. In lanes, a table is one for all bodies.

    Compiled code knows its length while compiling, so that `range(len(table))` is a plain loop.
    """

    __slots__ = ()


def entry(table: Table, place: float) -> float:
    """Return the number of a table at a place, a whole number from 0 to below its length, which is not checked.

    Where bodies are in lanes, each has a place of its own.
    """
    return table[int(place)]
