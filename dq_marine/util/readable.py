"""Numbers for people to read."""

from __future__ import annotations

LONGEST = 1e7
"""From here on a number is given with a power of ten."""


def readable(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits, with commas from a thousand on: 0.671, 570, 1,030.

    Where no digit would stand after the point, whole numbers are given.
    """
    rounded = float(f"{value:.{digits}g}")
    if 10.0 ** (digits - 1) <= abs(rounded) < LONGEST:
        return f"{rounded:,.0f}"
    return f"{rounded:.{digits}g}"
