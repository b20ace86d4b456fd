"""Numbers read off measured curves: orders, and costs at an error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import compress

import numpy as np

FEWEST = 3
"""Points that an order is read off, at the least."""

MOST = 5
"""The same at the most: the finest of those in the range."""

HIGHEST_FLOOR = 100.0
"""Times the smallest error that counts: an error that stops falling below this has met round-off, above it has not."""

STALLED = 0.7
"""An error that falls to more than this share of itself when the step is halved does not fall: order 1 gives 0.5."""

ABOVE_FLOOR = 30.0
"""Times the error at which round-off shows: below that, round-off takes part in an error without being seen."""


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

    That is, of the finest step sizes between those that are too large and those at which round-off shows; see
    `asymptotic`. Every point beyond either counts for nothing, wherever its error happens to lie.

    Args:
        steps: step sizes, each about half of the next larger one.
        errors: of each.
        smallest: error that is still well above round-off and above what the reference is known to.
        largest: error up to which the motion is followed at all.

    Returns:
        The order, None if too few points are in the range.
    """
    points = sorted(zip(steps, errors, strict=True), reverse=True)
    chosen = asymptotic(points, smallest, largest)[-MOST:]
    if len(chosen) < FEWEST:
        return None
    logs = np.log(np.array(chosen))
    slope = float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])
    return Order(slope, len(chosen))


def asymptotic(
    points: Sequence[tuple[float, float]], smallest: float, largest: float
) -> list[tuple[float, float]]:
    """Return those of (step, error), from coarse to fine, that lie between too large a step and round-off.

    Round-off begins with the first error below `smallest`, or, a little above it, with the first that stops falling.
    From there on errors grow with the number of steps and may come back into the range.
    """
    errors = [error for _, error in points]
    end, least = len(errors), smallest
    for index, error in enumerate(errors):
        finer = errors[index + 1] if index + 1 < len(errors) else 0.0
        stalled = error <= HIGHEST_FLOOR * smallest and finer > STALLED * error
        if error < smallest or stalled:
            end, least = index, max(smallest, ABOVE_FLOOR * error if stalled else 0.0)
            break
    too_large = [index for index in range(end) if not errors[index] <= largest]  # a NaN is too large, too
    begin = too_large[-1] + 1 if too_large else 0
    return [point for point in points[begin:end] if point[1] >= least]


def cost_at(costs: Sequence[float], errors: Sequence[float], target: float) -> float | None:
    """Return the cost at which an error is reached, between points on straight lines of logarithms.

    A point counts if the next finer one is as exact, too: others were lucky. Where finer points are cheaper, as beside
    steps that a solver finds hard, the cheapest of them is the cost.

    Args:
        costs: of the points, from coarse to fine.
        errors: of the points.
        target: the error wanted.

    Returns:
        The cost; that of the coarsest point if that is exact enough; None if no point is.
    """
    counts = [all(error <= target for error in errors[index : index + 2]) for index in range(len(errors))]
    if not any(counts):
        return None
    first = counts.index(True)
    return min([on_the_line(costs, errors, target, first), *compress(costs, counts)])


def on_the_line(costs: Sequence[float], errors: Sequence[float], target: float, first: int) -> float:
    """Return the cost of an error between the first point that counts and the one before; that of the point at most."""
    cost, error = costs[first], errors[first]
    if first == 0 or not math.isfinite(errors[first - 1]) or error <= 0.0:
        return cost
    if costs[first - 1] >= cost:  # coarser and dearer, as where a fallback took the steps
        return cost
    share = math.log(errors[first - 1] / target) / math.log(errors[first - 1] / error)
    return float(costs[first - 1] * (cost / costs[first - 1]) ** share)
