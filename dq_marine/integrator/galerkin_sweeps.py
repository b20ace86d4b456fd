"""How the equations of a Galerkin step are solved: by sweeps.

The rates at all nodes follow from the curve, and a new curve from the rates, until it stands still at round-off. A
sweep brings the curve closer by about a fifth of h rho, with rho the rate at which the body's momentum turns. Where
sweeps converge, all eigenvalues of their Jacobian are smaller than 1, so that none of the equations' has become zero or
negative since the step was short: the solution is the one that is connected to rest. Elsewhere the step goes to the
fallback.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.matrix3 import trace, transform
from dq_marine.algebra.selection import negation, select, smallest_normal, some, spread
from dq_marine.algebra.spatial import Matrix6, Spatial
from dq_marine.algebra.stages import each_stage, stage_sum
from dq_marine.algebra.vector3 import dot
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift_report import SolverReport, accepted_squared, converged_squared
from dq_marine.integrator.galerkin_curve import Rates, change_squared

MAX_SWEEPS = 40
UNTESTED = 4  # sweeps before changes are looked at
HOPELESS = 1e4  # squared change of a sweep that diverges
PATIENCE = 8  # sweeps after which the squared change must be promising: else pieces of the step cost less
PROMISING = 5e-7
FASTEST_TRUSTED = 0.002  # of the squared change between two sweeps: it is not taken to shrink faster
SMALL_PART = 1e-4  # of the squared parts of a velocity that cancel: their round-off is not to be waited for


class Scales(NamedTuple):
    """What changes of Gamma, of Pi and of 2 R f are compared with: one over the squares of their sizes."""

    turning: float
    forcing: float
    pushing: float


def scales_of(inverse: Matrix6, start: Spatial, twist: Spatial, wrench: Spatial) -> Scales:
    """Return the sizes of the terms of Gamma and Pi at the start of a step under a wrench, times h^2.

    What is left where terms cancel is round-off, which no sweep brings down; hence the sizes of the terms.
    """
    driven = dot(wrench.angular, wrench.angular)
    pushed = dot(start.linear, start.linear) * dot(twist.linear, twist.linear) + driven
    spin = dot(twist.angular, twist.angular)
    mobility = trace(inverse.angular)
    coupled = transform(inverse.angular_linear, start.linear)
    cancelled = SMALL_PART * (mobility * mobility * pushed + dot(coupled, coupled))
    tiny = smallest_normal(pushed)
    return Scales(
        turning=1.0 / (spin + cancelled + tiny),
        forcing=1.0 / (dot(start.angular, start.angular) * spin + pushed + tiny),
        pushing=1.0 / (dot(start.linear, start.linear) + dot(wrench.linear, wrench.linear) + tiny),
    )


def relative_change_squared(scales: Scales, after: Rates, before: Rates) -> float:
    """Return the squared change of a free step's rates at a node."""
    turned = change_squared(after.turning, before.turning)
    return scales.turning * turned + scales.forcing * change_squared(after.forcing, before.forcing)


def make_sweeps(
    method: Collocation, sweep: Callable[[Any, Any], Any], change_of: Callable[[Scales, Any, Any], float]
) -> Callable[..., Any]:
    """Return (what a sweep is handed, first nodes, scales) -> (nodes, report).

    A step is done when the change that is expected of the next sweep, that of the last one times the rate at which
    they shrink, is at round-off, or when changes below the accepted one have stopped shrinking. What is not done after
    `MAX_SWEEPS`, or shrinks too slowly, is not solved: short of round-off a step is not symplectic. A body that is
    done waits, unchanged, for those beside it.
    """
    weights = method.weights

    def sweeps(given: Any, first: Any, scales: Scales) -> tuple[Any, SolverReport]:
        now = first
        change = before = spread(1.0, scales.turning)
        active = spread(True, scales.turning)
        solved = spread(False, scales.turning)
        count = 0
        for taken in range(MAX_SWEEPS):
            following = sweep(given, now)
            count += 1
            if taken >= UNTESTED:
                changes = stage_sum(
                    weights, each_stage(weights, change_of, (scales, following.rates, now.rates))
                )
                before = select(active, change, before)
                change = select(active, changes, change)
            now = each_stage(weights, select, (active, following, now))
            if taken > UNTESTED:
                expected = change * max(change, FASTEST_TRUSTED * before)
                done = expected <= converged_squared(change) * before
                stagnates = (before <= accepted_squared(before)) & (change >= before)
                solved = solved | (active & (done | stagnates))
                promising = change <= (PROMISING if taken >= PATIENCE else HOPELESS)
                active = active & negation(solved) & promising
                if not some(active):
                    break
        return now, SolverReport(change, solved & (change <= accepted_squared(change)), count)

    return sweeps
