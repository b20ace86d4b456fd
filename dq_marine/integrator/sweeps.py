"""Fixed-point sweeps over all stages of a collocation method, until they no longer change."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from dq_marine.algebra.selection import by_precision, negation, select, some, spread
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport, accepted_squared

MAX_SWEEPS = 60
FIRST_TEST = 3  # sweeps before the first test: fewer never suffice
ROUND_OFF = 1e-15  # of the size: what the next sweep would change, when sweeps end
ROUND_OFF_SINGLE = 3e-7  # the same in single precision
HOPELESS = 1e4  # of the size: sweeps that change more diverge

Evaluate: TypeAlias = Callable[[Any, Any], Any]
Sweeps: TypeAlias = Callable[[Any, Any, float], tuple[Any, SolverReport]]


def kept(active: bool, new: Any, old: Any) -> Any:
    """Return the new evaluation where the sweeps go on."""
    return select(active, new, old)


def make_sweeps(
    method: Collocation,
    evaluate: Evaluate,
    moved: Callable[[Any, float, Any], Any],
    distance: Callable[[Any, Any, Any], float],
) -> Sweeps:
    """Return (context, start, size) -> (evaluation at all stages, report): the stages of one step of y' = rate(y).

    They solve y_i = start + sum_j A_ij rate_j, rate_i = evaluate(context, y_i).rate. The test looks one sweep ahead: two
    sweeps show the contraction, hence what a third would change. A body that is done waits, unchanged, for those
    beside it.

    Args:
        method: of collocation.
        evaluate: (context, y) -> a named tuple with `rate`.
        moved: (y, s, rate) -> y + s rate.
        distance: (context, rate, rate) -> the square of their distance.
    """
    matrix, weights, nodes = method.matrix, method.weights, method.nodes
    ones = (1.0,) * len(weights)

    def follow(start: Any, change: Any) -> Any:
        return moved(start, 1.0, change)

    def sweeps(context: Any, start: Any, size: float) -> tuple[Any, SolverReport]:
        tolerance = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
        begun = each_stage(weights, evaluate, (context, start))
        early = each_stage(weights, moved, (start, stage_constants(nodes, size), begun.rate))
        now = each_stage(weights, evaluate, (context, early))
        active = spread(True, size)
        before = last = size
        count = 0
        for sweep in range(MAX_SWEEPS):
            new = each_stage(
                weights,
                evaluate,
                (context, each_stage(weights, follow, (start, stage_product(matrix, now.rate)))),
            )
            count += 1
            change = stage_sum(ones, each_stage(weights, distance, (context, new.rate, now.rate)))
            before = select(active, last, before)
            last = select(active, change, last)
            now = each_stage(weights, kept, (active, new, now))
            if sweep >= FIRST_TEST:
                done = (change * change <= tolerance * before) | (change <= tolerance)
                stagnates = (change <= accepted_squared(change) * size) & (change >= 0.25 * before)
                active = active & negation(done | stagnates) & (change <= HOPELESS**2 * size)
                if not some(active):
                    break
        return now, SolverReport(last / size, last <= before, count)

    return sweeps
