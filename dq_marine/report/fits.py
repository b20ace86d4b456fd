"""Numbers read off measured curves: orders, and costs at an error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FEWEST = 3
"""Points that an order is read off, at the least."""

MOST = 5
"""The same at the most: the finest of those in the range."""


@dataclass(frozen=True)
class Order:
    """An observed order.

    Attributes:
        slope: of the logarithms, by least squares.
        points: that it was read off.
    """

    slope: float
    points: int


def observed_order(
    steps: Sequence[float], errors: Sequence[float], smallest: float, largest: float
) -> Order | None:
    """Return the slope of errors over step sizes, in the asymptotic range.

    That is, of the finest step sizes whose errors lie between `smallest`, above round-off and what the reference is
    known to, and `largest`, where the motion is followed at all.

    Returns:
        The order, None if too few points are in the range.
    """
    points = sorted(
        (step, error)
        for step, error in zip(steps, errors, strict=True)
        if math.isfinite(error) and smallest <= error <= largest
    )[:MOST]
    if len(points) < FEWEST:
        return None
    logs = np.log(np.array(points))
    slope = float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])
    return Order(slope, len(points))


def cost_at(costs: Sequence[float], errors: Sequence[float], target: float) -> float | None:
    """Return the least cost at which an error is reached and kept, between points on straight lines of logarithms.

    Args:
        costs: of the points, any order.
        errors: of the points.
        target: the error wanted.

    Returns:
        The cost; that of the cheapest point if that is exact enough; None if no point is.
    """
    points = sorted(zip(costs, errors, strict=True))
    missed = [index for index, (_, error) in enumerate(points) if not error <= target]
    first = missed[-1] + 1 if missed else 0
    if first == len(points):
        return None
    cost, error = points[first]
    if first == 0 or not math.isfinite(points[first - 1][1]) or error <= 0.0:
        return cost
    cost_before, error_before = points[first - 1]
    share = math.log(error_before / target) / math.log(error_before / error)
    return float(cost_before * (cost / cost_before) ** share)
