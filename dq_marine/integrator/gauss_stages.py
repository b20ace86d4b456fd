"""The momentum of a free body over a step, by Gauss's collocation on Kirchhoff's equations.

With c = h mu and W = M^-1 the momentum at the stages is (docs/theory.md, eqs. G1-G3, G12)

    y_i = c + sum_j A_ij K_j                                                                         (G1)
    K_i = ad*_(W y_i) y_i                                                                            (G2)
    c' = c + sum_i b_i K_i                                                                           (G3)
    K_i = sum_j E_ij K_j of the step before, to begin with                                           (G12)

The equations are quadratic in y, and energy and both Casimirs are quadratic, too: the method keeps them, as far as the
sweeps (G1), (G2) have converged. They contract by about a sixth of h rho, where rho is the rate at which momentum
turns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import select, smallest_normal
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_subtract
from dq_marine.algebra.stages import each_stage, stage_product, stage_sum, stages_apart
from dq_marine.algebra.vector3 import dot
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.sweeps import Ending, make_sweeps, same

FAR = 4.0
"""Of a momentum's size, squared: where rates change by more from one step to the next, they lead astray."""


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
        following: the evaluations that the rates lead to in the step that follows, at all its stages (G12).
    """

    twists: tuple[Spatial, ...]
    change: Spatial
    report: SolverReport
    following: FreeStage


SweepStages: TypeAlias = Callable[[FreeBody, Spatial, FreeStage, bool, Ending], SweptStages]


def squared_length(inertia: Inertia) -> float:
    """Return tr M11 / tr M22 [m^2]: the square of the arm by which linear and angular momentum compare."""
    angular, linear = inertia.matrix.angular, inertia.matrix.linear
    return (angular[0] + angular[4] + angular[8]) / (linear[0] + linear[4] + linear[8])


def free_stage(body: FreeBody, y: Spatial) -> FreeStage:
    """Return (G2)."""
    twist = twist_from_momentum(body.inertia, y)
    return FreeStage(twist, momentum_bracket(twist, y))


def make_begin(method: Collocation) -> Callable[[FreeBody, Spatial], Any]:
    """Return (body, c) -> the evaluation at the start, for all stages."""
    weights = method.weights

    def begin(body: FreeBody, c: Spatial) -> Any:
        return each_stage(weights, same, (free_stage(body, c),))

    return begin


def weighted_square(length_squared: float, a: Spatial) -> float:
    """Return the square of a momentum's size: the linear part counts with the arm by which inertia weighs it."""
    return dot(a.angular, a.angular) + length_squared * dot(a.linear, a.linear)


def free_extent(body: FreeBody, a: Spatial) -> float:
    """Return the square of the size of a rate."""
    return weighted_square(body.length_squared, a)


def make_continued(method: Collocation) -> Callable[[float, float, Spatial], Any]:
    """Return (length squared, size, rates) -> those of the step that follows: what a step's rates lead to (G12).

    Where that is far from the rates themselves, as in long steps, it is the rate at the step's end.
    """
    weights = method.weights
    ones = (1.0,) * len(weights)

    def continued(length_squared: float, size: float, rate: Spatial) -> Any:
        led_to = stage_product(method.ahead, rate)
        at_end = each_stage(weights, same, (stage_sum(method.end, rate),))
        moved = each_stage(weights, spatial_subtract, (led_to, rate))
        far = stage_sum(ones, each_stage(weights, weighted_square, (length_squared, moved))) > FAR * size
        return each_stage(weights, select, (far, at_end, led_to))

    return continued


def make_sweep_stages(method: Collocation) -> SweepStages:
    """Return (body, c, first evaluations, ahead, ending) -> the stages (G1)-(G3); see `sweeps.make_sweeps`."""
    weights, powers = method.weights, method.powers

    def sweep(body: FreeBody, c: Spatial, now: FreeStage) -> Any:
        y = each_stage(weights, spatial_add, (c, stage_product(method.matrix, now.rate)))  # (G1)
        return each_stage(weights, free_stage, (body, y))

    continued = make_continued(method)
    sweeps = make_sweeps(method, sweep, spatial_add_scaled, free_extent)

    def sweep_stages(
        body: FreeBody, c: Spatial, first: FreeStage, ahead: bool, ending: Ending
    ) -> SweptStages:
        size = weighted_square(body.length_squared, c) + smallest_normal(c.linear[0])
        found, report = sweeps(body, c, first, size, ahead, ending)
        twists = stages_apart(weights, stage_product(powers, found.twist))
        following = FreeStage(found.twist, continued(body.length_squared, size, found.rate))  # (G12)
        return SweptStages(twists, stage_sum(weights, found.rate), report, following)

    return sweep_stages
