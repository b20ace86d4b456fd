"""Fixed-point sweeps over all stages of a collocation method, until they have converged."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.selection import by_precision, negation, select, some, spread
from dq_marine.algebra.stages import each_stage, stage_sum
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport, accepted_squared

MAX_SWEEPS = 60
ROUND_OFF = 1e-15  # of the size: what the next sweep would change, when sweeps end
ROUND_OFF_SINGLE = 3e-7  # the same in single precision
HOPELESS = 1e4  # of the size: sweeps that change more diverge
SLOWEST = 0.5  # of the squared change, from one sweep to the next: sweeps that shrink it less are not trusted
AHEAD = 15.0  # times as large is the change of the second sweep that begins with rates of the step before


class Ending(NamedTuple):
    """When sweeps end: where the next would change less than a share of what the method errs.

    A change d tells that, whose square shrinks with the step size as the method errs, or faster. The share of
    d^2 is larger where d is: for the little accuracy that steps have which are long for the method, fewer sweeps do.

    Attributes:
        least_share: of d^2, where d is small.
        steepness: of the share, as d grows: its part of d, as a part of the size.
        largest_share: of d^2.
        largest_telltale: of the size, squared: larger d do not tell the error.
    """

    least_share: float
    steepness: float
    largest_share: float
    largest_telltale: float


CAREFULLY = Ending(0.01, 0.0, 0.01, 0.01)
"""So that sweeps leave no error that can be seen beside the method's."""

BRISKLY = Ending(0.05, 3.0, 0.5, 0.04)
"""So that long steps, of little accuracy anyway, take as few sweeps as that accuracy needs. The energy that they leave
over must be looked at: near the limit of convergence it may be anything."""

Sweep: TypeAlias = Callable[[Any, Any, Any], Any]
Sweeps: TypeAlias = Callable[[Any, Any, Any, float, bool, Ending], tuple[Any, SolverReport]]


def tolerated(ending: Ending, telltale: float, size: float) -> float:
    """Return what the next sweep may change, from d and from the size that it is compared with; all are squares."""
    telltale = min(telltale, ending.largest_telltale * size)
    share = min(ending.steepness**2 * (telltale / size), ending.largest_share**2)
    return max(share, ending.least_share**2) * (telltale * telltale / size)


def same(evaluation: Any) -> Any:
    """Return the evaluation: at all stages, where `each_stage` has it."""
    return evaluation


def kept(active: bool, new: Any, old: Any) -> Any:
    """Return the new evaluation where the sweeps go on."""
    return select(active, new, old)


def make_sweeps(
    method: Collocation,
    sweep_once: Sweep,
    moved: Callable[[Any, float, Any], Any],
    extent: Callable[[Any, Any], float],
) -> Sweeps:
    """Return (context, start, begun, size, ahead, ending) -> (evaluation at all stages, report): a step's stages.

    They solve y_i = start + sum_j A_ij rate_j for the rates at y_i. The first sweep takes `begun` for the evaluations
    at all stages: those at the start or, where `ahead` is true, those that the rates of the step before lead to;
    changes are compared with `size`, a square. The test looks one sweep ahead: two sweeps show the contraction, hence
    what a third would change. `ending` says what may be left over. A body that is done waits, unchanged, for those
    beside it. The report's `on_rest_branch` says whether they converged.

    With s stages, sweep s + 1 changes the rates by d, of order s + 2 in the step size: d^2, of order 2s + 4, is below
    the error of the method, of order 2s + 1. Sweeps that begin with what a step before leads to, of order s + 1, have
    changes of that order from the second on.

    Args:
        method: of collocation.
        sweep_once: (context, start, evaluation at all stages) -> the next: a named tuple with `rate`.
        moved: (y, s, rate) -> y + s rate.
        extent: (context, rate) -> the square of its size.
    """
    weights = method.weights
    ones = (1.0,) * len(weights)
    first_telling = len(weights) + 1

    def squared_change(context: Any, new: Any, old: Any) -> float:
        return extent(context, moved(new, -1.0, old))

    def sweeps(
        context: Any, start: Any, begun: Any, size: float, ahead: bool, ending: Ending
    ) -> tuple[Any, SolverReport]:
        telling = (
            2 if ahead else first_telling
        )  # the sweep whose change tells the error; tests begin with the next
        larger = AHEAD * AHEAD if ahead else 1.0
        tolerance = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
        now = begun
        active = spread(True, size)
        converged = negation(active)
        before = last = spread(math.inf, size)
        count = 0
        for sweep in range(1, MAX_SWEEPS + 1):
            new = sweep_once(context, start, now)
            count += 1
            if sweep >= telling:
                change = stage_sum(ones, each_stage(weights, squared_change, (context, new.rate, now.rate)))
                before, last = select(active, last, before), select(active, change, last)
            now = each_stage(weights, kept, (active, new, now))
            if sweep == telling:
                tolerance = max(tolerance, tolerated(ending, last / larger, size))
            if sweep > telling:
                contracts = last < SLOWEST * before  # not so if both are infinite
                done = (contracts & (last * last <= tolerance * before)) | (last <= tolerance)
                stagnates = (last <= accepted_squared(last) * size) & (last >= 0.25 * before)
                converged = converged | (active & (done | stagnates))
                active = active & negation(converged) & (last <= HOPELESS**2 * size)
                if not some(active):
                    break
        return now, SolverReport(last / size, converged, count)

    return sweeps
