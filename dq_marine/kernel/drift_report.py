"""How a drift's solver fared, and when its outcome may be used."""

from __future__ import annotations

from typing import NamedTuple

ACCEPTED_RESIDUAL = 1e-10


class DriftReport(NamedTuple):
    """Outcome of solving a drift's discrete equation.

    Attributes:
        relative_residual_squared: |residual|^2 over the sum of the squares of the equation's terms.
        determinant: that of the last Jacobian; positive on the branch connected to rest.
        iterations: Newton iterations taken.
    """

    relative_residual_squared: float
    determinant: float
    iterations: int


def drift_accepted(report: DriftReport) -> bool:
    """Whether the equation is met, on the branch connected to rest; False for NaN."""
    met = report.relative_residual_squared <= ACCEPTED_RESIDUAL * ACCEPTED_RESIDUAL
    return met and report.determinant > 0.0
