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
from dq_marine.algebra.table import Table
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


Section: TypeAlias = Table
"""The numbers of a section's flow over one duration: 3 x 3 blocks, row by row, from the places below on.

They stay in memory: as variables, hundreds of numbers would fill the registers of a step over and over.
"""

IMPULSE, PROPAGATOR, FORCING, RESISTANCE = 0, 18, 54, 72
"""Where C, by displacement and by rate, P, displacement by both and rate by both, Q and E begin."""


class MemoryFlow(NamedTuple):
    """The numbers of all sections' flow over one duration.

    Attributes:
        velocity: (M + E/2)^-1.
        sections: a `Section` for each, nested.
    """

    velocity: Matrix6
    sections: Any


AddImpulses: TypeAlias = Callable[[Any, Any, Spatial], Spatial]
AddResistances: TypeAlias = Callable[[Any, Spatial, Spatial], Spatial]
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


def block_transform(section: Section, place: int, vector: Vector3) -> Vector3:
    """Return the product of the block at a place with a vector."""
    x, y, z = vector
    return (
        section[place] * x + section[place + 1] * y + section[place + 2] * z,
        section[place + 3] * x + section[place + 4] * y + section[place + 5] * z,
        section[place + 6] * x + section[place + 7] * y + section[place + 8] * z,
    )


def section_impulse(section: Section, state: Oscillators) -> Vector3:
    """Return C x."""
    by_displacement = block_transform(section, IMPULSE, state.displacement)
    return add(by_displacement, block_transform(section, IMPULSE + 9, state.rate))


def section_after(section: Section, state: Oscillators, velocity: Vector3) -> Oscillators:
    """Return P x + Q v."""
    a, r = state.displacement, state.rate
    displacement = add(block_transform(section, PROPAGATOR, a), block_transform(section, PROPAGATOR + 9, r))
    rate = add(block_transform(section, PROPAGATOR + 18, a), block_transform(section, PROPAGATOR + 27, r))
    return Oscillators(
        add(displacement, block_transform(section, FORCING, velocity)),
        add(rate, block_transform(section, FORCING + 9, velocity)),
    )


def no_impulse(sections: Any, states: Any, total: Spatial) -> Spatial:
    """Return the total as it is."""
    return total


def no_resistance(sections: Any, twist: Spatial, total: Spatial) -> Spatial:
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


def join_resistances(planes: tuple[Plane, ...]) -> AddResistances:
    """Return (sections, twist, total) -> total + E v of all sections."""

    def link(plane: Plane, rest: AddResistances) -> AddResistances:
        pick, place = plane.pick, plane.place

        def add_resistances(sections: Any, twist: Spatial, total: Spatial) -> Spatial:
            first = place(block_transform(sections[0], RESISTANCE, pick(twist)))
            return rest(sections[1], twist, spatial_add(total, first))

        return add_resistances

    return folded(link, planes, no_resistance)


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
    add_impulses, add_resistances = join_impulses(planes), join_resistances(planes)
    advance_sections = join_sections(planes)

    def memory_flow(numbers: MemoryFlow, momentum: Spatial, state: Any) -> tuple[Spatial, Any]:
        sections = numbers.sections
        impulse = add_impulses(sections, state, ZERO)
        twist = matrix6_transform(numbers.velocity, spatial_add_scaled(momentum, -0.5, impulse))
        after = spatial_subtract(momentum, add_resistances(sections, twist, impulse))
        return after, advance_sections(sections, state, twist)

    undisturbed = nested([Oscillators(NO_VECTOR, NO_VECTOR)] * len(planes))
    return FluidMemory(undisturbed, memory_flow, join_combined(planes))
