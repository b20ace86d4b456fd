"""What the drifts of all schemes share: Newton's method, and what to do when it fails.

A scheme eliminates the translation and leaves one equation in three unknowns x, the rotation variable of the step,
for the scaled momenta a = (h/2) mu_angular and b = (h/2) mu_linear. `DriftScheme` names its functions. `make_drift`
makes the fast drift, Newton's method from a good guess; `make_split_drift` the one for steps that the fast one does
not solve, or only with a wrong energy: the step split in up to `MAX_PIECES`. Newton's method with damped steps has no
place here: it finds solutions, but not necessarily on the branch that starts at rest.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_position,
    pose_renormalise,
)
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.matrix3 import Matrix3, has_negative_real_eigenvalue, invert, transform
from dq_marine.algebra.quaternion import (
    Quaternion,
    excess_of_length,
    quaternion_conjugate,
    rotate_scaled,
)
from dq_marine.algebra.selection import by_precision, negation, select, some, spread
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_scale
from dq_marine.algebra.vector3 import Vector3, add, clamp, cross, dot, subtract
from dq_marine.integrator.body import kinetic_energy
from dq_marine.integrator.drift_report import (
    DriftReport,
    SolverReport,
    accepted_squared,
    converged_squared,
    drift_accepted,
    is_energy_kept,
)
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

MAX_ITERATIONS = 12
CHORDS = 3  # corrections by the Jacobian at the guess before a new one is worth its cost
SHRINKING = 0.01  # of the squared correction from one iteration to the next: a tenth of the one before
NEGLIGIBLE_CORRECTION = 1e-20  # of the squared correction, in quarter angles
NEGLIGIBLE_CORRECTION_SINGLE = 1e-10  # the same in single precision
LARGEST_CHANGE = 0.1  # of half a step's angle, in its first half [rad]
MAX_PIECES = 256

Drift: TypeAlias = Callable[
    [Inertia, float, DualQuaternion, Spatial], tuple[DualQuaternion, Spatial, DriftReport]
]
Newton: TypeAlias = Callable[[Inertia, Vector3, Vector3, Vector3], tuple[Any, SolverReport]]
Solve: TypeAlias = Callable[[Inertia, Vector3, Vector3], tuple[Any, SolverReport]]


class DriftScheme(NamedTuple):
    """The functions of one scheme.

    Attributes:
        equation: (inertia, x, a, b) -> a named tuple whose first field is x and which has `residual` and
            `relative_residual_squared`.
        jacobian: (inertia, equation) -> its 3x3 Jacobian.
        guess: (half the step's angle vector, (h/2) omega) -> x to start from.
        increment: (equation) -> the step's unit dual quaternion.
    """

    equation: Callable[[Inertia, Vector3, Vector3, Vector3], Any]
    jacobian: Callable[[Inertia, Any], Matrix3]
    guess: Callable[[Vector3], Vector3]
    increment: Callable[[Any], DualQuaternion]


def make_newton(scheme: DriftScheme, chords: int = 1) -> Newton:
    """Return (inertia, guess, a, b) -> (equation, report): Newton's method.

    The first corrections, as many as `chords`, use the Jacobian at the guess; a good guess needs no other. A body is
    done when its residual is at round-off, when it has stopped falling below the accepted residual, or after
    `MAX_ITERATIONS`; it then waits, unchanged, for those beside it.
    There may be several solutions whose Jacobians look alike; that the corrections shrink from the
    start (Deuflhard's natural monotonicity) tells that it did not wander off to another one than the guess's.
    """
    equation_at, jacobian_at = scheme.equation, scheme.jacobian

    def newton(inertia: Inertia, guess: Vector3, a: Vector3, b: Vector3) -> tuple[Any, SolverReport]:
        equation = equation_at(inertia, guess, a, b)
        jacobian = jacobian_at(inertia, equation)
        inverse = invert(jacobian)
        regular = negation(has_negative_real_eigenvalue(jacobian))
        active = spread(True, a[0])
        shrinking = spread(True, a[0])
        correction = spread(math.inf, a[0])
        iterations = 0
        for iteration in range(MAX_ITERATIONS):
            step = transform(inverse, equation.residual)
            size = dot(step, step)
            negligible = by_precision(size, NEGLIGIBLE_CORRECTION, NEGLIGIBLE_CORRECTION_SINGLE)
            shrunk = (size <= SHRINKING * correction) | (size <= negligible)
            shrinking = shrinking & (shrunk | negation(active))
            correction = size
            before = equation.relative_residual_squared
            equation = select(active, equation_at(inertia, subtract(equation[0], step), a, b), equation)
            iterations += 1
            after = equation.relative_residual_squared
            stagnates = (before <= accepted_squared(before)) & (after >= 0.25 * before)
            active = active & negation((after <= converged_squared(after)) | stagnates)
            if not some(active):
                break
            if iteration >= chords - 1:
                jacobian = jacobian_at(inertia, equation)
                inverse = invert(jacobian)
                regular = select(active, negation(has_negative_real_eigenvalue(jacobian)), regular)
        on_rest_branch = regular & shrinking
        return equation, SolverReport(equation.relative_residual_squared, on_rest_branch, iterations)

    return newton


def make_direct(scheme: DriftScheme) -> Solve:
    """Return (inertia, a, b) -> (equation, report): Newton's method, started from the velocity in the step's middle.

    In scaled momenta c = (a, b) Kirchhoff's equations carry c to c + ad*_(M^-1 c) c by then. The change of the angle
    vector is clamped: beyond, it is no estimate.
    """
    newton, guess_of = make_newton(scheme, CHORDS), scheme.guess

    def direct(inertia: Inertia, a: Vector3, b: Vector3) -> tuple[Any, SolverReport]:
        start = Spatial(a, b)
        angle = twist_from_momentum(inertia, start)
        change = twist_from_momentum(inertia, momentum_bracket(angle, start)).angular
        return newton(inertia, guess_of(add(angle.angular, clamp(LARGEST_CHANGE, change))), a, b)

    return direct


def transport_momentum(
    before: Quaternion, after: Quaternion, displacement_body: Vector3, momentum: Spatial
) -> Spatial:
    """Return the body momentum after a free step, by coadjoint transport.

    b' = R_f^T b and a' = R_f^T (a - l x b), with l the displacement in the body frame before: the spatial momentum is
    kept whatever the solver left over. R_f is taken as the rotation from the old attitude to the new, through the
    world: the rounding errors of a steady motion's constant R_f would add up over a million steps, these average out.
    Attitudes whose length is off by round-off, mostly to one side, would stretch the momentum: they are divided out.
    """
    angular = subtract(momentum.angular, cross(displacement_body, momentum.linear))
    there, back = excess_of_length(before), excess_of_length(after)
    away = quaternion_conjugate(after)
    return Spatial(
        rotate_scaled(away, back, rotate_scaled(before, there, angular)),
        rotate_scaled(away, back, rotate_scaled(before, there, momentum.linear)),
    )


def make_drift_by(scheme: DriftScheme, solve: Solve) -> Drift:
    """Return (inertia, h, pose, momentum) -> (pose, momentum, report): one step of free motion, solved by `solve`."""
    increment_of = scheme.increment

    def drift(
        inertia: Inertia, h: float, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        scaled = spatial_scale(0.5 * h, momentum)
        equation, report = solve(inertia, scaled.angular, scaled.linear)
        increment = increment_of(equation)
        moved = pose_renormalise(dual_multiply(pose, increment))
        carried = transport_momentum(pose.real, moved.real, pose_position(increment), momentum)
        # Written so that the solver's first guess shares the work before, and a kick that follows the work after.
        before = quadratic_form(inertia.inverse, scaled)
        after = quadratic_form(inertia.inverse, carried)
        return moved, carried, DriftReport(report, is_energy_kept(before, 0.25 * h * h * after))

    return drift


def make_split_drift(drift: Drift) -> Drift:
    """Return a drift that divides h into 2, 4, ... pieces until each is solved and together they keep the energy."""

    def split_drift(
        inertia: Inertia, h: float, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        before = kinetic_energy(inertia, momentum)
        pieces = 2
        while True:
            moved, transported, report = drift(inertia, h / pieces, pose, momentum)
            worst = report.solver.relative_residual_squared
            iterations = report.solver.iterations
            done = 1
            while done < pieces and drift_accepted(report):
                moved, transported, report = drift(inertia, h / pieces, moved, transported)
                worst = max(worst, report.solver.relative_residual_squared)
                iterations += report.solver.iterations
                done += 1
            solver = SolverReport(worst, report.solver.on_rest_branch, iterations)
            after = kinetic_energy(inertia, transported)
            together = DriftReport(solver, report.energy_kept & is_energy_kept(before, after))
            if drift_accepted(together) or pieces >= MAX_PIECES:
                return moved, transported, together
            pieces *= 2

    return split_drift


@functools.cache
def make_drift(scheme: DriftScheme) -> Drift:
    """Return the fast drift: Newton from a good guess. It is one function, which is compiled once."""
    return make_drift_by(scheme, make_direct(scheme))
