"""A hull in its body frame: read, checked, turned, and put into the water."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.choices import AXES, Choices
from dq_marine.meshes.repair import closed_surface
from dq_marine.meshes.stl import read_stl
from dq_marine.meshes.surface import Array, Solid, Surface, enclosed
from dq_marine.meshes.waterline import Flotation, draft_of_mass, flotation, wet_part
from dq_marine.vehicles.appearance import METRES

SHORTEST, LONGEST = 0.02, 500.0
"""Lengths of hulls [m]: the longest ship has 458 m."""

NOISE = 1e-7
"""Over a hull's length: coordinates in STL files have seven digits."""

LIGHTEST, HEAVIEST = 0.2, 5.0
"""Mean density of a vehicle under water over that of the water: beyond, the unit is wrong."""


@dataclass(frozen=True, eq=False)
class Hull:
    """A hull about its body origin, axes forward-starboard-down.

    Attributes:
        surface: all of it.
        solid: what it encloses.
        wet: triangles under water, shape (n, 3, 3) [m].
        volume: displaced [m^3].
        center_of_buoyancy: [m], shape (3,).
        mass: [kg].
        waterline: z of the still waterline [m]; None under water.
        waterplane: hydrostatics about the body origin; None under water.
        turned: triangles of the mesh that had to be turned.
        origin: the body origin in the mesh, turned forward-starboard-down [m], shape (3,).
    """

    surface: Surface
    solid: Solid
    wet: Array
    volume: float
    center_of_buoyancy: Array
    mass: float
    waterline: float | None
    waterplane: Flotation | None
    turned: int
    origin: Array

    @property
    def draft(self) -> float | None:
        """From the keel to the still waterline [m]; None under water."""
        return None if self.waterline is None else float(self.surface.vertices[:, 2].max()) - self.waterline


def read_hull(mesh: Path, choices: Choices) -> Hull:
    """Return the hull of an STL file.

    Raises:
        InvalidInputError: the mesh is unfit, its size or density is no vehicle's, or it cannot float as asked.
    """
    name = str(mesh)
    surface, turned = closed_surface(read_stl(mesh), name)
    surface = surface.moved(AXES[choices.axes], METRES[choices.unit], np.zeros(3))
    _check_size(surface, name, choices)
    if choices.floats:
        return _afloat(surface, turned, name, choices)
    solid = enclosed(surface.corners)
    mass = choices.mass or choices.density * solid.volume
    _check_density(mass / (choices.density * solid.volume), mass, solid.volume, name, choices)
    origin = solid.center if choices.origin == "center" else np.zeros(3)
    moved = surface.moved(np.eye(3), 1.0, -origin)
    solid = enclosed(moved.corners)
    center = without_noise(solid.center, moved)
    return Hull(moved, solid, moved.corners, solid.volume, center, mass, None, None, turned, origin)


def without_noise(place: Array, surface: Surface) -> Array:
    """Return a place whose coordinates are 0 where they are round-off beside the size of a surface."""
    return np.asarray(np.where(np.abs(place) < NOISE * float(surface.extent.max()), 0.0, place))


def _afloat(surface: Surface, turned: int, name: str, choices: Choices) -> Hull:
    """Return a hull at its draft."""
    draft = choices.draft
    if draft is None and choices.mass is not None:
        draft = draft_of_mass(surface, choices.mass / choices.density, name)
    height = float(surface.extent[2])
    if draft is None or not draft < height:
        raise InvalidInputError(
            f"{name}: draft = {draft:g} m, but the hull is {height:.6g} m high; give less, or check --unit and --axes"
        )
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    waterline = np.array([0.0, 0.0, high[2] - draft])
    origin = np.zeros(3)
    if choices.origin == "center":
        origin = np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), waterline[2]])
    wet = wet_part(surface.corners - waterline)
    # Moments are about the body origin's place in the waterline; only z differs, and only that of the centre.
    plane = flotation(wet - np.array([origin[0], origin[1], 0.0]))
    if plane.area <= 0.0 or plane.volume <= 0.0:
        raise InvalidInputError(
            f"{name}: at a draft of {draft:.6g} m nothing of it crosses the waterline; check the draft and --axes"
        )
    level = float(waterline[2] - origin[2])
    center = without_noise(plane.center + np.array([0.0, 0.0, level]), surface)
    moved = surface.moved(np.eye(3), 1.0, -origin)
    mass = choices.mass or choices.density * plane.volume
    about = Flotation(plane.volume, center, plane.area, plane.first_moments, plane.second_moments)
    wet_body = wet + waterline - origin
    return Hull(
        moved, enclosed(moved.corners), wet_body, plane.volume, center, mass, level, about, turned, origin
    )


def _check_size(surface: Surface, name: str, choices: Choices) -> None:
    longest = float(surface.extent.max())
    if SHORTEST <= longest <= LONGEST and math.isfinite(longest):
        return
    raise InvalidInputError(
        f"{name} is {longest:.6g} m long, read in {choices.unit}; hulls have {SHORTEST:g} to {LONGEST:g} m: "
        f"give the unit of the file, as --unit mm (one of {', '.join(METRES)})"
    )


def _check_density(ratio: float, mass: float, volume: float, name: str, choices: Choices) -> None:
    if LIGHTEST <= ratio <= HEAVIEST:
        return
    raise InvalidInputError(
        f"{name} encloses {volume:.6g} m^3, read in {choices.unit}: with {mass:.6g} kg it is {ratio:.3g} times as "
        f"dense as water ({LIGHTEST:g} to {HEAVIEST:g}); give the unit of the file, as --unit mm, and the mass in kg, "
        "or say with --afloat that it floats"
    )
