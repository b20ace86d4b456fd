"""Gauss's collocation methods: nodes, weights and matrices, to the last bit of a double.

With s stages at the zeros c_i of the shifted Legendre polynomial of degree s, the method is of order 2s, symmetric, and
keeps every quadratic invariant of an equation (Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, II.1,
IV.2).
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from decimal import Decimal, localcontext
from typing import NamedTuple, TypeAlias

Polynomial: TypeAlias = list[Decimal]
"""Coefficients, the constant first."""

DIGITS = 50
"""With which the coefficients are computed before they are rounded."""


class Collocation(NamedTuple):
    """A collocation method of s stages.

    Attributes:
        nodes: c_i, where the stages stand in the step [0, 1].
        weights: b_i, the integral over the step of the polynomial that is 1 at node i and 0 at the others.
        matrix: A_ij, the integral of the j-th of these polynomials from 0 to c_i.
        powers: V_kj, the k-th coefficient of the j-th of them as a polynomial in the time from the middle of the step,
            in half steps; halved, for rates that are a whole step's.
    """

    nodes: tuple[float, ...]
    weights: tuple[float, ...]
    matrix: tuple[tuple[float, ...], ...]
    powers: tuple[tuple[float, ...], ...]

    @property
    def order(self) -> int:
        """Order of convergence."""
        return 2 * len(self.nodes)


@functools.cache
def gauss(stages: int) -> Collocation:
    """Return Gauss's method of so many stages."""
    with localcontext() as context:
        context.prec = DIGITS
        # Zeros of Legendre's polynomial on [-1, 1]: where the stages stand, in half steps from the middle.
        places = legendre_zeros(stages)
        basis = [lagrange(places, j) for j in range(stages)]
        half = Decimal(1) / 2
        return Collocation(
            nodes=tuple(float(half + half * x) for x in places),
            weights=tuple(float(half * integral(p, Decimal(1))) for p in basis),
            matrix=tuple(tuple(float(half * integral(p, x)) for p in basis) for x in places),
            powers=tuple(tuple(float(half * p[k]) for p in basis) for k in range(stages)),
        )


def legendre_zeros(degree: int) -> list[Decimal]:
    """Return the zeros of Legendre's polynomial in [-1, 1], ascending, by Newton's method."""
    before, polynomial = [Decimal(1)], [Decimal(0), Decimal(1)]
    for n in range(1, degree):
        following = [(2 * n + 1) * c / (n + 1) for c in [Decimal(0), *polynomial]]
        for k, c in enumerate(before):
            following[k] -= n * c / (n + 1)
        before, polynomial = polynomial, following
    slope = [k * c for k, c in enumerate(polynomial)][1:]
    zeros: list[Decimal] = []
    for _ in range(degree):
        x = Decimal(1)
        for _ in range(200):  # from outside all zeros, those that are known divided out
            height = value(polynomial, x)
            change = height / (value(slope, x) - height * sum(1 / (x - known) for known in zeros))
            x -= change
            if abs(change) < Decimal(10) ** (10 - DIGITS):
                break
        zeros.append(x)
    return sorted(zeros)


def lagrange(places: Sequence[Decimal], j: int) -> Polynomial:
    """Return the polynomial that is 1 at the j-th place and 0 at the others."""
    product = [Decimal(1)]
    for place in (*places[:j], *places[j + 1 :]):
        scale = 1 / (places[j] - place)
        shifted, kept = [Decimal(0), *product], [*product, Decimal(0)]
        product = [scale * (a - place * b) for a, b in zip(shifted, kept, strict=True)]
    return product


def value(polynomial: Polynomial, x: Decimal) -> Decimal:
    """Return a polynomial's value."""
    result = Decimal(0)
    for coefficient in reversed(polynomial):
        result = result * x + coefficient
    return result


def integral(polynomial: Polynomial, to: Decimal) -> Decimal:
    """Return the integral of a polynomial from -1."""
    primitive = [Decimal(0), *(c / (k + 1) for k, c in enumerate(polynomial))]
    return value(primitive, to) - value(primitive, Decimal(-1))
