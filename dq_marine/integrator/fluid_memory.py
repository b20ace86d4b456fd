"""The memory of the water that a hull has set in motion: waves that it made act on it later.

The convolution of Cummins' equation is replaced by sections of three oscillators each. A section belongs to the motions
of one plane, surge, heave and pitch or sway, roll and yaw, and in coordinates whose squares are energies it is

    da/dt = W r,    dr/dt = -W a - D r + G v,    force on the body -G^T r                              (M3)

with W diagonal and positive, D symmetric and positive semidefinite, and v the three velocities through the water. The
energy (|a|^2 + |r|^2)/2 is what the body has put in less what D takes, whatever v is: radiation makes no energy.

The flow over a duration h takes v as constant, its mean over h by the change of momentum that it causes itself,

    (M + E/2) v = mu - C x / 2,    mu' = mu - C x - E v,    x' = P x + Q v,    x = (a, r)               (M4)

where P = exp(A h) and Q, C and E are the exact integrals of (M3) for constant v. It is symmetric in time, and exactly
passive: kinetic energy and sections together lose what D takes. At steady speed C x + E v = 0: no force is left.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.matrix3 import Matrix3, transform
from dq_marine.algebra.nesting import folded, nested
from dq_marine.algebra.spatial import (
    ZERO,
    Matrix6,
    Spatial,
    matrix6_transform,
    spatial_add,
    spatial_add_scaled,
    spatial_subtract,
)
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, scale

NO_VECTOR = (0.0, 0.0, 0.0)


class Plane(NamedTuple):
    """The motions of a section.

    Attributes:
        motions: their places in Fossen's order.
        pick: (spatial vector) -> their components.
        place: (components) -> spatial vector.
    """

    motions: tuple[int, int, int]
    pick: Callable[[Spatial], Vector3]
    place: Callable[[Vector3], Spatial]


def pick_vertical(vector: Spatial) -> Vector3:
    """Return surge, heave and pitch."""
    return (vector.linear[0], vector.linear[2], vector.angular[1])


def place_vertical(part: Vector3) -> Spatial:
    """Return the spatial vector of surge, heave and pitch."""
    return Spatial((0.0, part[2], 0.0), (part[0], 0.0, part[1]))


def pick_lateral(vector: Spatial) -> Vector3:
    """Return sway, roll and yaw."""
    return (vector.linear[1], vector.angular[0], vector.angular[2])


def place_lateral(part: Vector3) -> Spatial:
    """Return the spatial vector of sway, roll and yaw."""
    return Spatial((part[1], 0.0, part[2]), (0.0, part[0], 0.0))


VERTICAL = Plane((0, 2, 4), pick_vertical, place_vertical)
LATERAL = Plane((1, 3, 5), pick_lateral, place_lateral)


class Oscillators(NamedTuple):
    """The state x of a section: the a and the r of (M3) [J^(1/2)]."""

    displacement: Vector3
    rate: Vector3


class Section(NamedTuple):
    """The numbers of a section's flow over one duration.

    Attributes:
        impulse: C in blocks of displacement and rate.
        propagator: P in blocks: displacement by displacement and by rate, rate by displacement and by rate.
        forcing: Q in blocks.
    """

    impulse: tuple[Matrix3, Matrix3]
    propagator: tuple[Matrix3, Matrix3, Matrix3, Matrix3]
    forcing: tuple[Matrix3, Matrix3]


class MemoryFlow(NamedTuple):
    """The numbers of all sections' flow over one duration.

    Attributes:
        velocity: (M + E/2)^-1.
        resistance: E.
        sections: a `Section` for each, nested.
    """

    velocity: Matrix6
    resistance: Matrix6
    sections: Any


AddImpulses: TypeAlias = Callable[[Any, Any, Spatial], Spatial]
AdvanceSections: TypeAlias = Callable[[Any, Any, Spatial], Any]
Combine: TypeAlias = Callable[[float, Any, float, Any], Any]
Flow: TypeAlias = Callable[[Any, Spatial, Any], tuple[Spatial, Any]]


@dataclass(frozen=True)
class FluidMemory:
    """The functions of a scene's fluid memory.

    Attributes:
        rest: the state of water that no waves have been made in.
        flow: (numbers, momentum, state) -> (momentum, state) at frozen pose.
        combine: (weight, state, weight, state) -> the weighted sum.
    """

    rest: Any
    flow: Flow
    combine: Combine


def no_states(weight: float, states: Any, other_weight: float, others: Any) -> Any:
    """Return the end of a nest."""
    return ()


def no_flow(numbers: Any, momentum: Spatial, state: Any) -> tuple[Spatial, Any]:
    """Return the momentum and the state as they are."""
    return momentum, state


NO_MEMORY = FluidMemory((), no_flow, no_states)
"""Water that forgets."""


def section_impulse(section: Section, state: Oscillators) -> Vector3:
    """Return C x."""
    return add(transform(section.impulse[0], state.displacement), transform(section.impulse[1], state.rate))


def section_after(section: Section, state: Oscillators, velocity: Vector3) -> Oscillators:
    """Return P x + Q v."""
    p, q = section.propagator, section.forcing
    displacement = add(transform(p[0], state.displacement), transform(p[1], state.rate))
    rate = add(transform(p[2], state.displacement), transform(p[3], state.rate))
    return Oscillators(
        add(displacement, transform(q[0], velocity)),
        add(rate, transform(q[1], velocity)),
    )


def no_impulse(sections: Any, states: Any, total: Spatial) -> Spatial:
    """Return the total as it is."""
    return total


def no_section(sections: Any, states: Any, twist: Spatial) -> Any:
    """Return the end of a nest."""
    return ()


def join_impulses(planes: tuple[Plane, ...]) -> AddImpulses:
    """Return (sections, states, total) -> total + C x of all sections."""

    def link(plane: Plane, rest: AddImpulses) -> AddImpulses:
        place = plane.place

        def add_impulses(sections: Any, states: Any, total: Spatial) -> Spatial:
            with_first = spatial_add(total, place(section_impulse(sections[0], states[0])))
            return rest(sections[1], states[1], with_first)

        return add_impulses

    return folded(link, planes, no_impulse)


def join_sections(planes: tuple[Plane, ...]) -> AdvanceSections:
    """Return (sections, states, twist) -> states after the duration."""

    def link(plane: Plane, rest: AdvanceSections) -> AdvanceSections:
        pick = plane.pick

        def advance_sections(sections: Any, states: Any, twist: Spatial) -> Any:
            first = section_after(sections[0], states[0], pick(twist))
            return (first, rest(sections[1], states[1], twist))

        return advance_sections

    return folded(link, planes, no_section)


def combined(weight: float, state: Oscillators, other_weight: float, other: Oscillators) -> Oscillators:
    """Return the weighted sum of two states of a section."""
    return Oscillators(
        add_scaled(scale(weight, state.displacement), other_weight, other.displacement),
        add_scaled(scale(weight, state.rate), other_weight, other.rate),
    )


def join_combined(planes: tuple[Plane, ...]) -> Combine:
    """Return (weight, states, weight, states) -> the weighted sum."""

    def link(_: Plane, rest: Combine) -> Combine:
        def combine(weight: float, states: Any, other_weight: float, others: Any) -> Any:
            first = combined(weight, states[0], other_weight, others[0])
            return (first, rest(weight, states[1], other_weight, others[1]))

        return combine

    return folded(link, planes, no_states)


@functools.cache
def make_fluid_memory(planes: tuple[Plane, ...]) -> FluidMemory:
    """Return the functions of sections in the given planes; equal planes have the same functions."""
    add_impulses, advance_sections = join_impulses(planes), join_sections(planes)

    def memory_flow(numbers: MemoryFlow, momentum: Spatial, state: Any) -> tuple[Spatial, Any]:
        impulse = add_impulses(numbers.sections, state, ZERO)
        twist = matrix6_transform(numbers.velocity, spatial_add_scaled(momentum, -0.5, impulse))
        left = spatial_subtract(momentum, impulse)
        after = spatial_subtract(left, matrix6_transform(numbers.resistance, twist))
        return after, advance_sections(numbers.sections, state, twist)

    undisturbed = nested([Oscillators(NO_VECTOR, NO_VECTOR)] * len(planes))
    return FluidMemory(undisturbed, memory_flow, join_combined(planes))
