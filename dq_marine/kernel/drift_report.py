"""How a drift's solver fared, and when its outcome may be used."""

from __future__ import annotations

from typing import NamedTuple

CONVERGED_RESIDUAL = 1e-14
"""Relative residual at which the solver is content: round-off."""

ACCEPTED_RESIDUAL = 1e-10
"""Relative residual up to which a solution may be used."""

DIRECT, CONTINUED, SPLIT = range(3)
"""How a step was solved: by plain Newton, or by what had to come to its rescue."""


class DriftReport(NamedTuple):
    """Outcome of solving a drift's discrete equation.

    Attributes:
        relative_residual_squared: |residual|^2 over the sum of the squares of the equation's terms.
        on_rest_branch: whether the solution is on the branch connected to rest. Along it the Jacobian starts
            positive definite and no real eigenvalue has crossed zero; the sign of the determinant alone would miss
            two that cross together, as they do for an axisymmetric body.
        iterations: Newton iterations taken.
        method: DIRECT, CONTINUED or SPLIT.
    """

    relative_residual_squared: float
    on_rest_branch: bool
    iterations: int
    method: int


def drift_accepted(report: DriftReport) -> bool:
    """Whether the equation is met, on the branch connected to rest; False for NaN."""
    met = report.relative_residual_squared <= ACCEPTED_RESIDUAL * ACCEPTED_RESIDUAL
    return met and report.on_rest_branch
