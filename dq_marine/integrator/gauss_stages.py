"""The momentum of a free body over a step, by Gauss's collocation on Kirchhoff's equations.

With c = h mu and W = M^-1 the momentum at the stages is (docs/theory.md, eqs. G1-G3)

    y_i = c + sum_j A_ij K_j                                                                         (G1)
    K_i = ad*_(W y_i) y_i                                                                            (G2)
    c' = c + sum_i b_i K_i                                                                           (G3)

The equations are quadratic in y, and energy and both Casimirs are quadratic, too: the method keeps them, as far as the
sweeps (G1), (G2) have converged. They contract by about a sixth of h rho, where rho is the rate at which momentum turns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import by_precision, negation, select, smallest_normal, some, spread
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_subtract
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum, stages_apart
from dq_marine.algebra.vector3 import dot
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport, accepted_squared
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

MAX_SWEEPS = 60
FIRST_TEST = 3  # sweeps before the first test: fewer never suffice
ROUND_OFF = 1e-15  # of the momentum: what the next sweep would change, when sweeps end
ROUND_OFF_SINGLE = 3e-7  # the same in single precision
HOPELESS = 1e4  # of the momentum: sweeps that change it by more diverge


class SweptStages(NamedTuple):
    """What a free body does in a step.

    Attributes:
        twists: h times the twist as a polynomial in the time from the middle of the step, in half steps: its
            coefficients, the constant first, per half step.
        change: sum of b_i K_i (G3).
        report: relative change of the last sweep, squared; whether sweeps still converged; how many there were.
    """

    twists: tuple[Spatial, ...]
    change: Spatial
    report: SolverReport


class Sweep(NamedTuple):
    """One evaluation of (G2) at a stage: h times the twist W y, and K."""

    twist: Spatial
    rate: Spatial


SweepStages: TypeAlias = Callable[[Inertia, float, Spatial], SweptStages]


def swept(inertia: Inertia, y: Spatial) -> Sweep:
    """Return (G2)."""
    twist = twist_from_momentum(inertia, y)
    return Sweep(twist, momentum_bracket(twist, y))


def weighted_square(length_squared: float, a: Spatial) -> float:
    """Return the square of a momentum's size: the linear part counts with the arm by which inertia weighs it."""
    return dot(a.angular, a.angular) + length_squared * dot(a.linear, a.linear)


def weighted_distance(length_squared: float, a: Spatial, b: Spatial) -> float:
    """Return the square of the size of a - b."""
    return weighted_square(length_squared, spatial_subtract(a, b))


def moved(start: Spatial, change: Spatial) -> Spatial:
    """Return start + change."""
    return spatial_add(start, change)


def kept_sweep(active: bool, new: Sweep, old: Sweep) -> Sweep:
    """Return the new sweep where the sweeps go on."""
    return select(active, new, old)


def make_sweep_stages(method: Collocation) -> SweepStages:
    """Return (inertia, length squared, c) -> the stages (G1)-(G3) of a step, swept until they no longer change.

    The test looks one sweep ahead: two sweeps show the contraction, hence what a third would change.
    """
    matrix, weights, nodes, powers = method.matrix, method.weights, method.nodes, method.powers
    ones = (1.0,) * len(weights)

    def sweep_stages(inertia: Inertia, length_squared: float, c: Spatial) -> SweptStages:
        size = weighted_square(length_squared, c) + smallest_normal(c.linear[0])
        tolerance = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
        begun = swept(inertia, c)
        early = each_stage(weights, spatial_add_scaled, (c, stage_constants(nodes, size), begun.rate))
        now = each_stage(weights, swept, (inertia, early))
        active = spread(True, size)
        before = size
        last = size
        sweeps = 0
        for sweep in range(MAX_SWEEPS):
            y = each_stage(weights, moved, (c, stage_product(matrix, now.rate)))
            new = each_stage(weights, swept, (inertia, y))
            sweeps += 1
            distance = each_stage(weights, weighted_distance, (length_squared, new.rate, now.rate))
            change = stage_sum(ones, distance)
            before = select(active, last, before)
            last = select(active, change, last)
            now = each_stage(weights, kept_sweep, (active, new, now))
            if sweep >= FIRST_TEST:
                done = (change * change <= tolerance * before) | (change <= tolerance)
                stagnates = (change <= accepted_squared(change) * size) & (change >= 0.25 * before)
                active = active & negation(done | stagnates) & (change <= HOPELESS**2 * size)
                if not some(active):
                    break
        twists = stages_apart(weights, stage_product(powers, now.twist))
        report = SolverReport(last / size, last <= before, sweeps)
        return SweptStages(twists, stage_sum(weights, now.rate), report)

    return sweep_stages
