"""The schemes with stages: what a scene's composition and timing become with them.

All take a scene's forces at the stages of the step, damping among them, and leave the steps that they do not solve to
Strang's method with the midpoint drift.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.fallback import FallbackTiming
from dq_marine.integrator.forces import Potential, VelocityForce
from dq_marine.integrator.galerkin import PIECES, PiecesTiming, make_galerkin, make_in_pieces
from dq_marine.integrator.gauss import make_gauss_method
from dq_marine.integrator.radau import DampedTiming, make_radau_method
from dq_marine.integrator.runge_kutta import make_runge_kutta
from dq_marine.integrator.step import Composition, make_advance
from dq_marine.physics.damping.build import DampingTerm

VelocityForces: TypeAlias = tuple[VelocityForce, ...]
Potentials: TypeAlias = tuple[Potential, ...]


class StageScheme(NamedTuple):
    """A scheme.

    Attributes:
        orders: that it takes with stages of its own.
        compose: (composition of Strang's method, order, damping, potentials of all forces) -> composition.
        timing: (damping, step size [s]) -> what the method needs to know of the step size.
    """

    orders: tuple[int, ...]
    compose: Callable[[Composition, int, DampingTerm, Potentials], Composition]
    timing: Callable[[DampingTerm, float], Any]


def with_drag(strang: Composition, drag: VelocityForces) -> Composition:
    """Return the composition with damping as the last of its velocity forces.

    There Strang's method, whose kick has it, does not find its numbers.
    """
    return replace(strang, velocity_forces=(*strang.velocity_forces, *drag))


def drag_of(damping: DampingTerm) -> VelocityForces:
    """Return damping as forces, as the step calls them."""
    return tuple(term.compiled_form for term in damping.drag)


@functools.cache
def gauss_composition(strang: Composition, order: int, potentials: Potentials) -> Composition:
    """Return the composition of Gauss's collocation on the momentum, without damping."""
    return replace(
        strang,
        method=make_gauss_method(order // 2),
        fallback=make_advance(strang),
        potentials=potentials,
    )


@functools.cache
def radau_composition(
    strang: Composition, algebra: DampingAlgebra, grows: bool, drag: VelocityForces
) -> Composition:
    """Return the composition of Radau's collocation, for one kind of damping matrix."""
    method = make_radau_method(algebra, grows=grows)
    return replace(with_drag(strang, drag), method=method, fallback=make_advance(strang))


def compose_gauss(
    strang: Composition, order: int, damping: DampingTerm, potentials: Potentials
) -> Composition:
    """Return the composition of collocation on the momentum: Gauss's, and with damping Radau's."""
    if damping.names:
        return radau_composition(strang, damping.algebra, damping.grows, drag_of(damping))
    return gauss_composition(strang, order, potentials)


def fallback_timing(damping: DampingTerm, step: float) -> FallbackTiming:
    """Return the timing of a method that needs the step size alone, and whose fallback is one step of Strang's."""
    return FallbackTiming(step, damping.timing(step))


def gauss_timing(damping: DampingTerm, step: float) -> FallbackTiming | DampedTiming:
    """Return the timing of the same."""
    if damping.names:
        return DampedTiming(step, damping.stage_matrices, damping.timing(step))
    return fallback_timing(damping, step)


@functools.cache
def galerkin_composition(strang: Composition, order: int, drag: VelocityForces) -> Composition:
    """Return the composition of a Galerkin variational integrator."""
    collocated = with_drag(strang, drag)
    return replace(
        collocated, method=make_galerkin(order), fallback=make_in_pieces(collocated, order, strang)
    )


def compose_galerkin(
    strang: Composition, order: int, damping: DampingTerm, potentials: Potentials
) -> Composition:
    """Return the same; it needs no potentials."""
    return galerkin_composition(strang, order, drag_of(damping))


def galerkin_timing(damping: DampingTerm, step: float) -> FallbackTiming:
    """Return the timing of a Galerkin variational integrator."""
    return FallbackTiming(step, PiecesTiming(step, damping.timing(step / PIECES)))


@functools.cache
def runge_kutta_composition(strang: Composition, order: int, drag: VelocityForces) -> Composition:
    """Return the composition of an explicit Runge-Kutta method."""
    method = make_runge_kutta(order)
    return replace(with_drag(strang, drag), method=method, fallback=make_advance(strang))


def compose_runge_kutta(
    strang: Composition, order: int, damping: DampingTerm, potentials: Potentials
) -> Composition:
    """Return the same; it needs no potentials."""
    return runge_kutta_composition(strang, order, drag_of(damping))


STAGE_SCHEMES = {
    "galerkin": StageScheme((4, 6, 8), compose_galerkin, galerkin_timing),
    "gauss": StageScheme((6, 8), compose_gauss, gauss_timing),
    "runge_kutta": StageScheme((4, 8), compose_runge_kutta, fallback_timing),
}
"""By name."""
