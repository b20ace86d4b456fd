"""From a hull's radiation model to the fluid memory of a step."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dq_marine.algebra.nesting import nested
from dq_marine.algebra.table import Table
from dq_marine.checks import one_of
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.fluid_memory import FluidMemory, MemoryFlow, Section, make_fluid_memory
from dq_marine.physics.matrices import angular_first, matrix6
from dq_marine.physics.radiation.identification import identified
from dq_marine.physics.radiation.model import Array, RadiationModel, SectionModel

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

CONSTANT, MEMORY = "constant", "memory"

RADIATIONS = (CONSTANT, MEMORY)
"""How the waves that a hull makes act on it, by name."""

TERMS = 20
"""Of the exponential's series."""

LARGEST_NORM = 0.5
"""Of the matrix whose series is summed: its last term is then below 1e-24."""


@dataclass(frozen=True)
class MemoryTerm:
    """The fluid memory of a vehicle.

    Attributes:
        model: of its radiation.
        mass_matrix: M with the A_inf that goes with the model, in Fossen's order, shape (6, 6).
    """

    model: RadiationModel
    mass_matrix: Array

    @property
    def memory(self) -> FluidMemory:
        """The functions."""
        return make_fluid_memory(self.model.planes)

    def numbers(self, duration: float) -> MemoryFlow:
        """Return the numbers of the flow (M4) over a duration [s]."""
        resistance, sections = np.zeros((6, 6)), []
        for model in self.model.sections:
            section, own = section_flow(model, duration)
            resistance[np.ix_(model.plane.motions, model.plane.motions)] += own
            sections.append(section)
        velocity = np.linalg.inv(self.mass_matrix + 0.5 * resistance)
        return MemoryFlow(matrix6(angular_first(0.5 * (velocity + velocity.T))), nested(sections))


def section_flow(model: SectionModel, duration: float) -> tuple[Section, Array]:
    """Return the numbers of a section's flow, and its E of (M4), shape (3, 3).

    All are blocks of one exponential, of the linear system of x, of v that stays, and of the impulse G^T int r dt.
    """
    system = np.zeros((12, 12))
    system[:6, :6] = model.dynamics
    system[3:6, 6:9] = model.gain
    system[9:, 3:6] = model.gain.T
    flow = exponential(duration * balanced(system, model.gain))
    size = np.linalg.norm(model.gain) or 1.0
    p, q, c = flow[:6, :6], flow[:6, 6:9] * size, flow[9:, :6] * size
    resistance = flow[9:, 6:9] * size**2
    resistance = 0.5 * (resistance + resistance.T)
    blocks = (
        *(c[:, :3], c[:, 3:]),
        *(p[:3, :3], p[:3, 3:], p[3:, :3], p[3:, 3:]),
        *(q[:3], q[3:]),
        resistance,
    )
    return Table(np.ravel(blocks).tolist()), resistance


def balanced(system: Array, gain: Array) -> Array:
    """Return the system with its gains, which are of the size of tonnes, scaled to 1."""
    scaled = system.copy()
    size = np.linalg.norm(gain) or 1.0
    scaled[3:6, 6:9] /= size
    scaled[9:, 3:6] /= size
    return scaled


def exponential(matrix: Array) -> Array:
    """Return the exponential of a matrix: its series for a small part of it, then squared."""
    doublings = max(
        0, math.ceil(math.log2(max(float(np.abs(matrix).sum(axis=0).max()), 1e-300) / LARGEST_NORM))
    )
    small = matrix / 2**doublings
    term = total = np.eye(len(matrix))
    for k in range(1, TERMS + 1):
        term = term @ small / k
        total = total + term
    for _ in range(doublings):
        total = total @ total
    return total


def memory_term(vehicle: Vehicle, radiation: str) -> MemoryTerm | None:
    """Return the fluid memory of a vehicle; None where its radiation is to have constant coefficients.

    Raises:
        InvalidInputError: the vehicle's file does not have what it takes, or no model fits it.
    """
    if radiation == CONSTANT:
        return None
    model = radiation_model(vehicle)
    mass_matrix = vehicle.mass_matrix + model.shift
    if np.linalg.eigvalsh(unit_diagonal(mass_matrix)).min() <= 0.0:
        raise InvalidInputError(
            f"the added mass at infinite frequency that goes with the radiation table of {vehicle.name!r} leaves no "
            'positive mass; mend the table, or give radiation="constant"'
        )
    return MemoryTerm(model, mass_matrix)


def radiation_model(vehicle: Vehicle) -> RadiationModel:
    """Return the model of a vehicle's radiation; it is made once for each table.

    Raises:
        InvalidInputError: the vehicle's file does not have what it takes, or no model fits it.
    """
    if vehicle.radiation is None:
        raise InvalidInputError(
            f"radiation = 'memory', but {vehicle.name!r} has no added mass and damping by frequency: its file has no "
            'table "radiation". Give radiation="constant", or another vehicle'
        )
    return identified(vehicle.radiation)


def unit_diagonal(matrix: Array) -> Array:
    """Return a symmetric matrix with rows and columns scaled to a diagonal of 1 or -1."""
    scale = np.sqrt(np.abs(np.diag(matrix)))
    return np.asarray(matrix / np.outer(scale, scale))


def checked_radiation(radiation: str, vehicle: Vehicle) -> None:
    """Refuse what is no kind of radiation, or one that the vehicle cannot have.

    Raises:
        InvalidInputError: with the reason.
    """
    one_of("radiation", radiation, RADIATIONS)
    if radiation == MEMORY and vehicle.radiation is not None and vehicle.damping.wave_share is None:
        raise InvalidInputError(
            f"radiation = 'memory', but the file of {vehicle.name!r} does not say how much of its linear damping "
            "stands for the waves that it makes, which would count twice; give damping.wave_share, six numbers from 0 "
            'to 1, or radiation="constant"'
        )
    memory_term(vehicle, radiation)
