"""What a vehicle from a mesh is made with, besides the mesh; checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from dq_marine.checks import finite_array, finite_number, one_of, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.meshes.panels import MOST_PANELS
from dq_marine.meshes.surface import Array
from dq_marine.physics.constants import GRAVITY
from dq_marine.physics.gravity import checked_gravity
from dq_marine.vehicles.appearance import METRES, axes_rotation
from dq_marine.vehicles.model import Dimensions

AXES: dict[str, Array] = {axes: axes_rotation(axes) for axes in ("flu", "fsd")}
"""Rotations to forward-starboard-down: from forward-port-up, usual in CAD, and from the body frame itself."""

ORIGINS = ("center", "mesh")
MOST_FREQUENCIES = 200
SHAPES: tuple[str, ...] = get_args(Dimensions.model_fields["shape"].annotation)


@dataclass(frozen=True)
class Choices:
    """What a vehicle is made with; None for what follows from the mesh.

    Attributes:
        mass: m [kg]; None for the displaced water's.
        draft: of a hull afloat, from its keel [m].
        afloat: whether it floats, at the draft that its mass asks for.
        unit: of the mesh, a key of `METRES`.
        axes: of the mesh, a key of `AXES`.
        origin: where the body origin is: "center", the centre of buoyancy, or of a hull afloat amidships in the still
            waterline; or "mesh", the mesh's own origin.
        center_of_mass: about the body origin, forward-starboard-down [m], shape (3,).
        inertia: moments about the centre of mass [kg m^2], shape (3,).
        water_density: [kg/m^3]; None for 1000, or 1025 of a hull afloat.
        speed: that the damping is estimated for [m/s].
        shape: kind of hull.
        limits: largest force and moment of the actuators, shape (6,) [N, N m].
        panels: at least so many.
        frequencies: how many radiation is solved for; 0 for none.
        gravity: [m/s^2].
        name: of the vehicle.
    """

    mass: float | None = None
    draft: float | None = None
    afloat: bool = False
    unit: str = "m"
    axes: str = "flu"
    origin: str = "center"
    center_of_mass: Sequence[float] | None = None
    inertia: Sequence[float] | None = None
    water_density: float | None = None
    speed: float | None = None
    shape: str | None = None
    limits: Sequence[float] | None = None
    panels: int = 1500
    frequencies: int = 0
    gravity: float = GRAVITY
    name: str | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be.

        Raises:
            InvalidInputError: with the value, the limit and the remedy.
        """
        for key in ("mass", "draft", "speed"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, finite_number(key, getattr(self, key), above=0.0))
        if self.water_density is not None:
            density = finite_number("water_density", self.water_density, least=500.0, most=1500.0)
            object.__setattr__(self, "water_density", density)
        one_of("unit", self.unit, METRES)
        one_of("axes", self.axes, AXES)
        one_of("origin", self.origin, ORIGINS)
        if self.shape is not None:
            one_of("shape", self.shape, SHAPES)
        for key, size in (("center_of_mass", 3), ("inertia", 3), ("limits", 6)):
            _check_numbers(key, getattr(self, key), size)
        object.__setattr__(self, "gravity", checked_gravity(self.gravity))
        if not isinstance(self.afloat, bool | np.bool_):
            raise InvalidInputError(f"afloat = {shown(self.afloat)}; give True or False")
        if self.name is not None and not (isinstance(self.name, str) and self.name.strip()):
            raise InvalidInputError(f"name = {shown(self.name)}; give a text")
        panels = whole_number("panels", self.panels, least=100, most=MOST_PANELS)
        frequencies = whole_number("frequencies", self.frequencies, least=0, most=MOST_FREQUENCIES)
        object.__setattr__(self, "panels", panels)
        object.__setattr__(self, "frequencies", frequencies)
        if self.draft is not None and (self.mass is not None or self.afloat):
            raise InvalidInputError(
                f"draft = {self.draft:g} says the mass, too; give the draft alone, or the mass and that it is afloat"
            )
        if self.afloat and self.mass is None:
            raise InvalidInputError("a hull afloat needs its mass or its draft; give one of the two")
        if self.frequencies and not self.floats:
            raise InvalidInputError(
                "radiation is of a hull afloat; give its draft, or its mass and that it is afloat"
            )

    @property
    def floats(self) -> bool:
        """Whether the hull is at the surface."""
        return self.afloat or self.draft is not None

    @property
    def density(self) -> float:
        """Of the water [kg/m^3]."""
        return self.water_density or (1025.0 if self.floats else 1000.0)


def _check_numbers(key: str, value: ArrayLike | None, size: int) -> None:
    if value is None:
        return
    numbers = finite_array(key, value, size)
    if key != "center_of_mass" and numbers.min() < 0.0:
        raise InvalidInputError(f"{key} = {shown(value)} has a number below 0; give none")
