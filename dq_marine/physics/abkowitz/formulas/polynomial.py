"""Sums of products of dimensionless motions and the rudder's angle, such as Y'_vvr v'^2 r'.

Which products there are is known before compilation; what is not in a polynomial is neither computed nor compiled.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.nesting import folded


class ShipMotion(NamedTuple):
    """What polynomials are evaluated at.

    Attributes:
        speed: U, that forces are made dimensionless with [m/s].
        surge: u' = (u - U_0)/U.
        sway: v' = v/U.
        yaw: r' = r L/U.
        rudder: angle [rad].
    """

    speed: float
    surge: float
    sway: float
    yaw: float
    rudder: float


Polynomial: TypeAlias = Callable[[Any, ShipMotion], float]
"""(coefficients, nested in pairs in the order of the products; motion) -> value."""


def surge_of(motion: ShipMotion) -> float:
    """Return u'."""
    return motion.surge


def sway_of(motion: ShipMotion) -> float:
    """Return v'."""
    return motion.sway


def yaw_of(motion: ShipMotion) -> float:
    """Return r'."""
    return motion.yaw


def rudder_of(motion: ShipMotion) -> float:
    """Return the rudder's angle."""
    return motion.rudder


FACTORS = {"u": surge_of, "v": sway_of, "r": yaw_of, "d": rudder_of}
"""By the letters of derivatives, the rudder's delta written d."""


def one(motion: ShipMotion) -> float:
    """Return 1, the product of nothing."""
    return 1.0


def zero(coefficients: Any, motion: ShipMotion) -> float:
    """Return 0, the sum of nothing."""
    return 0.0


@functools.cache
def make_product(letters: str) -> Callable[[ShipMotion], float]:
    """Return (motion) -> the product of the factors with these letters."""

    def link(letter: str, rest: Callable[[ShipMotion], float]) -> Callable[[ShipMotion], float]:
        factor = FACTORS[letter]

        def product(motion: ShipMotion) -> float:
            return factor(motion) * rest(motion)

        return product

    if len(letters) == 1:
        return FACTORS[letters]
    return folded(link, letters[:-1], FACTORS[letters[-1]]) if letters else one


@functools.cache
def make_polynomial(products: tuple[str, ...]) -> Polynomial:
    """Return (coefficients, motion) -> the sum of coefficients times products (W2)."""

    def link(letters: str, rest: Polynomial) -> Polynomial:
        product_of = make_product(letters)

        def polynomial(coefficients: Any, motion: ShipMotion) -> float:
            first: float = coefficients[0] * product_of(motion)
            return first + rest(coefficients[1], motion)

        return polynomial

    return folded(link, products, zero)
