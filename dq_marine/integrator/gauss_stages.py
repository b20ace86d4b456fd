"""The momentum of a free body over a step, by Gauss's collocation on Kirchhoff's equations.

With c = h mu and W = M^-1 the momentum at the stages is (docs/theory.md, eqs. G1-G3)

    y_i = c + sum_j A_ij K_j                                                                         (G1)
    K_i = ad*_(W y_i) y_i                                                                            (G2)
    c' = c + sum_i b_i K_i                                                                           (G3)

The equations are quadratic in y, and energy and both Casimirs are quadratic, too: the method keeps them, as far as the
sweeps (G1), (G2) have converged. They contract by about a sixth of h rho, where rho is the rate at which momentum
turns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import smallest_normal
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled
from dq_marine.algebra.stages import each_stage, stage_product, stage_sum, stages_apart
from dq_marine.algebra.vector3 import dot
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.sweeps import make_sweeps


class FreeBody(NamedTuple):
    """What the momentum of a free body depends on: inertia, and the square of its `squared_length` [m^2]."""

    inertia: Inertia
    length_squared: float


class FreeStage(NamedTuple):
    """One evaluation of (G2): h times the twist, W y, and K."""

    twist: Spatial
    rate: Spatial


class SweptStages(NamedTuple):
    """What a free body does in a step.

    Attributes:
        twists: h times the twist as a polynomial in the time from the middle of the step, in half steps: its
            coefficients, the constant first, per half step.
        change: sum of b_i K_i (G3).
        report: how the sweeps fared.
    """

    twists: tuple[Spatial, ...]
    change: Spatial
    report: SolverReport


SweepStages: TypeAlias = Callable[[FreeBody, Spatial], SweptStages]


def squared_length(inertia: Inertia) -> float:
    """Return tr M11 / tr M22 [m^2]: the square of the arm by which linear and angular momentum compare."""
    angular, linear = inertia.matrix.angular, inertia.matrix.linear
    return (angular[0] + angular[4] + angular[8]) / (linear[0] + linear[4] + linear[8])


def free_stage(body: FreeBody, y: Spatial) -> FreeStage:
    """Return (G2)."""
    twist = twist_from_momentum(body.inertia, y)
    return FreeStage(twist, momentum_bracket(twist, y))


def weighted_square(length_squared: float, a: Spatial) -> float:
    """Return the square of a momentum's size: the linear part counts with the arm by which inertia weighs it."""
    return dot(a.angular, a.angular) + length_squared * dot(a.linear, a.linear)


def free_extent(body: FreeBody, a: Spatial) -> float:
    """Return the square of the size of a rate."""
    return weighted_square(body.length_squared, a)


def make_sweep_stages(method: Collocation) -> SweepStages:
    """Return (body, c) -> the stages (G1)-(G3) of a step."""
    weights, powers = method.weights, method.powers

    def sweep(body: FreeBody, c: Spatial, now: FreeStage) -> Any:
        y = each_stage(weights, spatial_add, (c, stage_product(method.matrix, now.rate)))  # (G1)
        return each_stage(weights, free_stage, (body, y))

    sweeps = make_sweeps(method, sweep, spatial_add_scaled, free_extent, loose=True)

    def sweep_stages(body: FreeBody, c: Spatial) -> SweptStages:
        size = weighted_square(body.length_squared, c) + smallest_normal(c.linear[0])
        found, report = sweeps(body, c, free_stage(body, c), size)
        twists = stages_apart(weights, stage_product(powers, found.twist))
        return SweptStages(twists, stage_sum(weights, found.rate), report)

    return sweep_stages
