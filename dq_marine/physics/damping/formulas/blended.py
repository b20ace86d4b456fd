"""Damping that passes from linear to quadratic, or fades away, as a vehicle gathers way.

At rest, linear damping stands for the waves and the flow of a vessel that is kept in place; under way, resistance grows
with the square of the speed. With the surge velocity u through the water and the crossover speed c, the damping of axis
i is

    d(u, nu_i) = s d + (1 - s) q |nu_i|,   s = 1 - tanh(|u|/c)                                          (B1)

after forceSurgeDamping.m of the Marine Systems Simulator (Fossen), there for surge alone and for motion ahead. With |u|
it holds astern, too, and as s is between 0 and 1 it only takes energy. The derivative of d(u, nu_i) nu_i is

    s d + 2 (1 - s) q |nu_i|              by nu_i at a given s,
    s' sign(u) (d - q |nu_i|) nu_i        by u,   s' = -1/(c cosh^2(u/c))                                (B2)
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.selection import select


class Blend(NamedTuple):
    """The numbers of (B1).

    Attributes:
        linear: d [N s/m, N m s].
        quadratic: q [N s^2/m^2, N m s^2].
        crossover: c [m/s].
    """

    linear: float
    quadratic: float
    crossover: float


def blended_damping(blend: Blend, surge: float, velocity: float) -> float:
    """Return d(u, nu_i) of (B1)."""
    decay = exponential(-2.0 * abs(surge) / blend.crossover)
    at_rest = 2.0 * decay / (1.0 + decay)
    return at_rest * blend.linear + (1.0 - at_rest) * blend.quadratic * abs(velocity)


def blended_slope(blend: Blend, surge: float, velocity: float) -> float:
    """Return the derivative of d(u, nu_i) nu_i by nu_i, with s held."""
    return blended_damping(Blend(blend.linear, 2.0 * blend.quadratic, blend.crossover), surge, velocity)


def blended_turning(blend: Blend, surge: float, velocity: float) -> float:
    """Return the derivative of d(u, nu_i) nu_i by u, with nu_i held."""
    decay = exponential(-2.0 * abs(surge) / blend.crossover)
    steepness = 4.0 * decay / (blend.crossover * (1.0 + decay) * (1.0 + decay))
    change = steepness * (blend.quadratic * abs(velocity) - blend.linear) * velocity
    return select(surge < 0.0, -change, change)
