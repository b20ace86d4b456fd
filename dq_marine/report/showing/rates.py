"""How fast damping acts in a case: what tells a stiff motion from others."""

from __future__ import annotations

import numpy as np

from dq_marine.report.cases import CASES, Case

STRONG = 50.0
"""Damping rate from which a case counts as strongly damped [1/s]."""

SMALL = 0.3
"""Step times damping rate below which a step is small: where orders show."""


def damping_rate(case: Case) -> float:
    """Return the largest rate at which damping acts at the speeds of a case's start [1/s], 0 without damping."""
    physics = case.physics
    damping = physics.linear + np.diag(physics.quadratic * np.abs(case.velocity))
    if not damping.any():
        return 0.0
    return float(np.abs(np.linalg.eigvals(np.linalg.solve(physics.mass_matrix, damping))).max())


def largest_small_step(case: Case) -> float:
    """Return the step below which damping is resolved [s], infinite without damping."""
    rate = damping_rate(case)
    return SMALL / rate if rate else float("inf")


def smoothness_limit(case: Case) -> int | None:
    """Return the order that no method exceeds on a case unless it follows kinks, None if there is no such limit.

    A velocity that passes through zero has a kink in the second derivative of |v| v: one step there has an error of
    third order in h, whatever the method, but for one whose quadrature ends and begins at the zero.
    """
    return 3 if case.physics.quadratic.any() else None


def kind_of(case: str) -> str:
    """Return what kind of motion a case is, by its name."""
    rate = damping_rate(CASES[case]) if case in CASES else 0.0
    if rate == 0.0:
        return "motion without damping"
    if not CASES[case].physics.quadratic.any():
        return "linearly damped motion"
    return "damped motion" if rate < STRONG else f"damping rates beyond {STRONG:g}/s"
