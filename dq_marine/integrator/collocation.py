"""Collocation methods of Gauss and of Radau: nodes, weights and matrices, to the last bit of a double.

With s stages at the zeros c_i of the shifted Legendre polynomial of degree s, Gauss's method is of order 2s, symmetric,
and keeps every quadratic invariant of an equation (Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, II.1
and IV.2). Radau's, called IIA, has its last stage at the end of the step; it is of order 2s - 1 and L-stable (Hairer,
Wanner 1996, Solving Ordinary Differential Equations II, IV.5).
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
        end: e_j, the j-th of these polynomials at the end of the step.
        ahead: E_ij, the j-th of these polynomials at node i of a step that follows, of the same size.
        order: of convergence.
    """

    nodes: tuple[float, ...]
    weights: tuple[float, ...]
    matrix: tuple[tuple[float, ...], ...]
    powers: tuple[tuple[float, ...], ...]
    end: tuple[float, ...]
    ahead: tuple[tuple[float, ...], ...]
    order: int


def half_matrix(method: Collocation) -> tuple[tuple[float, ...], ...]:
    """Return A/2."""
    return tuple(tuple(0.5 * entry for entry in row) for row in method.matrix)


@functools.cache
def gauss(stages: int) -> Collocation:
    """Return Gauss's method of so many stages."""
    with localcontext() as context:
        context.prec = DIGITS
        return collocation_at(zeros_in_the_step(legendre(stages)), 2 * stages)


@functools.cache
def radau(stages: int) -> Collocation:
    """Return Radau's method IIA of so many stages."""
    with localcontext() as context:
        context.prec = DIGITS
        # The difference of two Legendre polynomials has the end of the step among its zeros.
        polynomial = [
            a - b for a, b in zip(legendre(stages), [*legendre(stages - 1), Decimal(0)], strict=True)
        ]
        inner = divided(polynomial, Decimal(1))
        return collocation_at([*zeros_in_the_step(inner), Decimal(1)], 2 * stages - 1)


def collocation_at(places: Sequence[Decimal], order: int) -> Collocation:
    """Return the method whose stages stand at some places, in half steps from the middle of the step."""
    basis = [lagrange(places, j) for j in range(len(places))]
    half = Decimal(1) / 2
    return Collocation(
        nodes=tuple(float(half + half * x) for x in places),
        weights=tuple(float(half * integral(p, Decimal(1))) for p in basis),
        matrix=tuple(tuple(float(half * integral(p, x)) for p in basis) for x in places),
        powers=tuple(tuple(float(half * p[k]) for p in basis) for k in range(len(places))),
        end=tuple(float(value(p, Decimal(1))) for p in basis),
        ahead=tuple(tuple(float(value(p, x + 2)) for p in basis) for x in places),
        order=order,
    )


def legendre(degree: int) -> Polynomial:
    """Return Legendre's polynomial."""
    before, polynomial = [Decimal(0)], [Decimal(1)]
    for n in range(degree):
        following = [(2 * n + 1) * c / (n + 1) for c in [Decimal(0), *polynomial]]
        for k, c in enumerate(before):
            following[k] -= n * c / (n + 1)
        before, polynomial = polynomial, following
    return polynomial


def divided(polynomial: Polynomial, zero: Decimal) -> Polynomial:
    """Return a polynomial less one of its zeros."""
    quotient: Polynomial = []
    for coefficient in reversed(polynomial[1:]):
        quotient.append(coefficient + zero * (quotient[-1] if quotient else 0))
    return quotient[::-1]


def zeros_in_the_step(polynomial: Polynomial) -> list[Decimal]:
    """Return the zeros of a polynomial that all lie in [-1, 1], ascending, by Newton's method."""
    slope = [k * c for k, c in enumerate(polynomial)][1:]
    zeros: list[Decimal] = []
    for _ in slope:
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
