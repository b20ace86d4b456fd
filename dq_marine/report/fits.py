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
    """Return the cost at which an error is reached, between points on straight lines of logarithms.

    A point counts if the next finer one is as exact, too: others were lucky.

    Args:
        costs: of the points, from coarse to fine.
        errors: of the points.
        target: the error wanted.

    Returns:
        The cost; that of the coarsest point if that is exact enough; None if no point is.
    """
    met = [error <= target for error in errors]
    first = next((index for index, _ in enumerate(met) if all(met[index : index + 2])), None)
    if first is None:
        return None
    cost, error = costs[first], errors[first]
    if first == 0 or not math.isfinite(errors[first - 1]) or error <= 0.0:
        return cost
    share = math.log(errors[first - 1] / target) / math.log(errors[first - 1] / error)
    return float(costs[first - 1] * (cost / costs[first - 1]) ** share)
