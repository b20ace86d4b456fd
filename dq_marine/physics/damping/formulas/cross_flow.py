"""Cross-flow drag by strip theory: the hull cut across into strips, each with a drag of its own.

A strip at lever x moves across the water with v_i = v + x r, and its drag -c |v_i| v_i acts at that lever (Faltinsen
1990, Sea Loads on Ships and Offshore Structures; Fossen 2021, Handbook of Marine Craft). With J_i = (1, x_i) the
wrench on (v, r) is

    -sum_i c |v_i| J_i^T J_i (v, r) = -[[S_0, S_1], [S_1, S_2]] (v, r),   S_n = sum_i c |v_i| x_i^n           (S1)

a symmetric matrix that only takes energy. Its derivative, of sum_i c |v_i| v_i J_i^T, is twice that matrix. In heave
and pitch a strip moves with w - x q, so the lever is -x there.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.selection import spread


class StripRow(NamedTuple):
    """Strips at equal distances.

    Attributes:
        coefficient: c = (1/2) rho C_D times the area of one strip across the flow [N s^2/m^2].
        first: lever of the first strip [m].
        spacing: from one lever to the next [m].
    """

    coefficient: float
    first: float
    spacing: float


class StripSums(NamedTuple):
    """S_0 [N s/m], S_1 [N s] and S_2 [N m s] of (S1)."""

    zeroth: float
    first: float
    second: float


SumStrips: TypeAlias = Callable[[StripRow, float, float], StripSums]


@functools.cache
def make_strip_sums(count: int) -> SumStrips:
    """Return (row, v, r) -> the sums of (S1) over `count` strips."""

    def strip_sums(row: StripRow, speed: float, rate: float) -> StripSums:
        zeroth = first = second = spread(0.0, speed)
        for i in range(count):
            lever = row.first + float(i) * row.spacing
            across = abs(speed + lever * rate)
            moment = lever * across
            zeroth = zeroth + across
            first = first + moment
            second = second + lever * moment
        c = row.coefficient
        return StripSums(c * zeroth, c * first, c * second)

    return strip_sums
