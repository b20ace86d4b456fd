"""How a drift and its solver fared, and when the outcome may be used."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.selection import by_precision, select, smallest_normal, spread
from dq_marine.algebra.vector3 import Vector3, dot

CONVERGED_RESIDUAL = 1e-14
"""Relative residual at which the solver is content: round-off."""

ACCEPTED_RESIDUAL = 1e-10
"""Relative residual up to which a solution may be used."""

CONVERGED_RESIDUAL_SINGLE = 5e-6
"""`CONVERGED_RESIDUAL` where numbers have single precision."""

ACCEPTED_RESIDUAL_SINGLE = 1e-4
"""`ACCEPTED_RESIDUAL` where numbers have single precision."""

CANCELLED_PART = 1e-5
"""Of the product of translation and momentum that counts as size of their cross product: where the two are parallel,
what is left of it is round-off, which no solver brings below `ACCEPTED_RESIDUAL` of itself."""

CANCELLED_PART_SINGLE = 1e-2
"""`CANCELLED_PART` where numbers have single precision."""

LARGEST_ENERGY_CHANGE = 0.005
"""Of the kinetic energy before a drift that may be gained or lost in it, see docs/theory.md, "When a step is hard"."""


class SolverReport(NamedTuple):
    """Outcome of solving a drift's discrete equation.

    Attributes:
        relative_residual_squared: |residual|^2 over the sum of the squares of the equation's terms.
        on_rest_branch: whether the solution is on the branch connected to rest. Along it the Jacobian starts
            positive definite and no real eigenvalue has crossed zero; the sign of the determinant alone would miss
            two that cross together, as they do for an axisymmetric body.
        iterations: Newton iterations taken.
    """

    relative_residual_squared: float
    on_rest_branch: bool
    iterations: int


class DriftReport(NamedTuple):
    """Outcome of a drift.

    Attributes:
        solver: the outcome of solving the discrete equation, the worst where there were several.
        energy_kept: whether the kinetic energy, which free motion keeps, changed by no more than
            `LARGEST_ENERGY_CHANGE`; False for NaN.
    """

    solver: SolverReport
    energy_kept: bool


def nothing_solved(like: float) -> SolverReport:
    """Return the report on no solution at all, in as many lanes as `like` has: to begin `worst` with."""
    return SolverReport(spread(0.0, like), spread(True, like), 0)


def worst(first: SolverReport, second: SolverReport) -> SolverReport:
    """Return the report on two solutions."""
    return SolverReport(
        max(first.relative_residual_squared, second.relative_residual_squared),
        first.on_rest_branch & second.on_rest_branch,
        first.iterations + second.iterations,
    )


def report_of_either(wanted: bool, second: DriftReport, first: DriftReport) -> DriftReport:
    """Return the report on the second of two attempts where it is wanted, else on the first; both took iterations."""
    a, b = second.solver, first.solver
    residual = select(wanted, a.relative_residual_squared, b.relative_residual_squared)
    solved = select(wanted, a.on_rest_branch, b.on_rest_branch)
    report = SolverReport(residual, solved, a.iterations + b.iterations)
    return DriftReport(report, select(wanted, second.energy_kept, first.energy_kept))


def equation_size_squared(
    a: Vector3, za: Vector3, w: Vector3, y: Vector3, zb: Vector3, coupled: Vector3
) -> float:
    """Return the squared size that a residual is compared with.

    That of the terms a, za and w, where w is a product of y and zb, and of `coupled`, the part of za that y brings in:
    where nothing turns a body whose M is coupled, rotation undoes that part but for round-off.
    """
    part = by_precision(a[0], CANCELLED_PART**2, CANCELLED_PART_SINGLE**2)
    cancelled = part * dot(y, y) * dot(zb, zb)
    terms = dot(a, a) + dot(za, za) + dot(w, w) + dot(coupled, coupled)
    return terms + cancelled + smallest_normal(a[0])


def converged_squared(like: float) -> float:
    """Return the square of the relative residual at which the solver is content."""
    return by_precision(like, CONVERGED_RESIDUAL**2, CONVERGED_RESIDUAL_SINGLE**2)


def accepted_squared(like: float) -> float:
    """Return the square of the relative residual up to which a solution may be used."""
    return by_precision(like, ACCEPTED_RESIDUAL**2, ACCEPTED_RESIDUAL_SINGLE**2)


def equation_met(report: SolverReport) -> bool:
    """Whether the equation is met, on the branch connected to rest; False for NaN."""
    residual = report.relative_residual_squared
    return (residual <= accepted_squared(residual)) & report.on_rest_branch


def is_energy_kept(before: float, after: float) -> bool:
    """Whether an energy differs from that before by no more than `LARGEST_ENERGY_CHANGE` of it; False for NaN."""
    return abs(after - before) <= LARGEST_ENERGY_CHANGE * before


def drift_accepted(report: DriftReport) -> bool:
    """Whether a drift's outcome may be used: its equation is met, and it kept the energy."""
    return equation_met(report.solver) & report.energy_kept
