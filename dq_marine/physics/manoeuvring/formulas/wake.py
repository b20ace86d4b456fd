"""The share of the ship's speed that reaches the propeller, 1 - w_P, while the ship drifts and turns."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.selection import select


class TwoConstantsWake(NamedTuple):
    """1 - w_P0 of the straight course, C_1, and C_2 on each side of beta_P."""

    straight: float
    growth: float
    most_positive: float
    most_negative: float


class GaussianWake(NamedTuple):
    """w_P0 of the straight course, and how fast it falls with beta_P^2."""

    straight: float
    decay: float


def two_constants_inflow(wake: TwoConstantsWake, beta: float) -> float:
    """Return 1 - w_P at the drift angle beta_P of the propeller (Yasukawa and Yoshimura 2015, eq. 16): (P8)."""
    most = select(beta > 0.0, wake.most_positive, wake.most_negative)
    return wake.straight * (1.0 + (1.0 - exponential(-wake.growth * abs(beta))) * (most - 1.0))


def gaussian_inflow(wake: GaussianWake, beta: float) -> float:
    """Return 1 - w_P0 exp(-4 beta_P^2), with another number for the 4 if the file has one: (P9)."""
    return 1.0 - wake.straight * exponential(-wake.decay * beta * beta)
