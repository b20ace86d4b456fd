"""Free motion by Gauss's collocation of order 6 with the fewest operations: stages one after the other.

The momentum begins as its Taylor series, exact because Kirchhoff's equation is quadratic (docs/theory.md, eq. G11):

    (k + 1) c_k+1 = sum_i ad*_(W c_i) c_k-i,   c_0 = c = h mu                                         (G11)

Sweeps then solve (G1), (G2) stage by stage, each with the newest rates of the others. Pose and momentum are made
consistent as in `gauss_drift`. Bodies in lanes gain by it: stages cannot stand side by side in a vector that bodies
fill already, so that operations are all that counts.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import by_precision, negation, select, smallest_normal, some, spread
from dq_marine.algebra.spatial import (
    Spatial,
    spatial_add,
    spatial_add_scaled,
    spatial_scale,
    spatial_subtract,
)
from dq_marine.algebra.stages import Weights
from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.drift_report import (
    DriftReport,
    SolverReport,
    accepted_squared,
    nothing_solved,
    worst,
)
from dq_marine.integrator.gauss_drift import moved_by, on_energy_level
from dq_marine.integrator.gauss_stages import FreeBody, FreeStage, free_stage, squared_length, weighted_square
from dq_marine.integrator.increment import (
    AT_ONCE,
    QuadraticTwist,
    consistent,
    increment_of_quadratic,
    joined,
    renormalised,
)
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.sweeps import HOPELESS, MAX_SWEEPS, ROUND_OFF, ROUND_OFF_SINGLE, SLOWEST

SUCCESSIVE = 3
"""Stages of the method whose stages are found one after the other."""

METHOD = gauss(SUCCESSIVE)
PLAIN_SWEEPS = 3
"""After the first, before changes are looked at."""

OF_THE_FOURTH = 0.1
"""Of the change of the fourth sweep: what the next may change, when sweeps end."""


class Series(NamedTuple):
    """The momentum's rate as a quadratic in the share of the step that is over: its coefficients k c_k (G11)."""

    first: Spatial
    second: Spatial
    third: Spatial


class Three(NamedTuple):
    """Evaluations of (G2) at the three stages."""

    early: FreeStage
    middle: FreeStage
    late: FreeStage


def momentum_series(inertia: Inertia, c: Spatial) -> Series:
    """Return (G11), to c_3."""
    x0 = twist_from_momentum(inertia, c)
    k1 = momentum_bracket(x0, c)
    x1 = twist_from_momentum(inertia, k1)
    k2 = spatial_add(momentum_bracket(x0, k1), momentum_bracket(x1, c))
    c2 = spatial_scale(0.5, k2)
    x2 = twist_from_momentum(inertia, c2)
    k3 = spatial_add(spatial_add(momentum_bracket(x0, c2), momentum_bracket(x1, k1)), momentum_bracket(x2, c))
    return Series(k1, k2, k3)


def rate_at(series: Series, share: float) -> Spatial:
    """Return the rate when a share of the step is over."""
    return spatial_add_scaled(series.first, share, spatial_add_scaled(series.second, share, series.third))


Rates: TypeAlias = tuple[Spatial, Spatial, Spatial]


def moved(c: Spatial, row: Weights, rates: Rates) -> Spatial:
    """Return c + sum_j A_ij K_j (G1)."""
    first, second, third = rates
    sum_of_two = spatial_add_scaled(spatial_scale(row[0], first), row[1], second)
    return spatial_add(c, spatial_add_scaled(sum_of_two, row[2], third))


def next_sweep(body: FreeBody, c: Spatial, rates: Rates) -> Three:
    """Return the stages (G1), (G2), each with the newest rates."""
    to_early, to_middle, to_late = METHOD.matrix
    _, second, third = rates
    early = free_stage(body, moved(c, to_early, rates))
    middle = free_stage(body, moved(c, to_middle, (early.rate, second, third)))
    late = free_stage(body, moved(c, to_late, (early.rate, middle.rate, third)))
    return Three(early, middle, late)


def squared_change(body: FreeBody, new: Three, old: Three) -> float:
    """Return the square of what a sweep has changed at the last stage, which is farthest from the step's start."""
    return weighted_square(body.length_squared, spatial_subtract(new.late.rate, old.late.rate))


def rates(stages: Three) -> tuple[Spatial, Spatial, Spatial]:
    """Return those of all stages."""
    return stages.early.rate, stages.middle.rate, stages.late.rate


def solved_stages(body: FreeBody, c: Spatial) -> tuple[Three, SolverReport]:
    """Return the stages, and how the sweeps fared.

    Five sweeps give the method's order, from the series of order three; the test, which looks one sweep ahead as that
    of `sweeps.make_sweeps` does, says whether the step is too long for so few.
    """
    size = weighted_square(body.length_squared, c) + smallest_normal(c.linear[0])
    series = momentum_series(body.inertia, c)
    n1, n2, n3 = METHOD.nodes
    third = next_sweep(body, c, (rate_at(series, n1), rate_at(series, n2), rate_at(series, n3)))
    fourth = third
    for _ in range(PLAIN_SWEEPS):
        third, fourth = fourth, next_sweep(body, c, rates(fourth))
    now = next_sweep(body, c, rates(fourth))
    before, last = squared_change(body, fourth, third), squared_change(body, now, fourth)
    tolerance = max(by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size, OF_THE_FOURTH**2 * before)
    converged = is_done(last, before, tolerance)
    active = negation(converged) & (last <= HOPELESS**2 * size)
    count = PLAIN_SWEEPS + 2
    while some(active) and count < MAX_SWEEPS:
        new = next_sweep(body, c, rates(now))
        change = squared_change(body, new, now)
        before, last = select(active, last, before), select(active, change, last)
        now = select(active, new, now)
        count += 1
        stagnates = (last <= accepted_squared(last) * size) & (last >= 0.25 * before)
        converged = converged | (active & (is_done(last, before, tolerance) | stagnates))
        active = active & negation(converged) & (last <= HOPELESS**2 * size)
    return now, SolverReport(last / size, converged, count)


def is_done(last: float, before: float, tolerance: float) -> bool:
    """Whether the next sweep would change less than a tolerance; all are squares."""
    contracts = last < SLOWEST * before
    return (contracts & (last * last <= tolerance * before)) | (last <= tolerance)


def quadratic(stages: Three) -> QuadraticTwist:
    """Return the twist as a quadratic in the time from the middle of the step, in half steps."""
    a, b, d = METHOD.powers
    early, middle, late = stages.early.twist, stages.middle.twist, stages.late.twist
    constant = spatial_scale(a[1], middle)
    slope = spatial_scale(b[2], spatial_subtract(late, early))
    curve = spatial_add_scaled(spatial_scale(d[1], middle), d[0], spatial_add(early, late))
    return QuadraticTwist(constant, slope, curve)


def successive_steps(
    inertia: Inertia, h: float, steps: int, pose: DualQuaternion, momentum: Spatial
) -> tuple[DualQuaternion, Spatial, DriftReport]:
    """Return pose, momentum and a drift's report after steps of free motion; they are made consistent at the end."""
    body = FreeBody(inertia, squared_length(inertia))
    length = math.sqrt(body.length_squared)
    start = spatial_scale(h, momentum)
    like = start.linear[0]
    c, increment = start, spread(AT_ONCE, like)
    report = nothing_solved(like)
    for _ in range(steps):
        stages, solver = solved_stages(body, c)
        c = moved(c, METHOD.weights, rates(stages))  # (G3)
        increment = joined(increment, increment_of_quadratic(quadratic(stages)))
        report = worst(report, solver)
    levelled = on_energy_level(body, consistent(length, renormalised(increment), start, c), start)
    return moved_by(levelled.increment, pose, momentum, DriftReport(report, levelled.energy_kept))
