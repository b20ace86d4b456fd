"""A solid: a shape, where it stands, and what its surface is like."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dq_marine.algebra.vector3 import Vector3
from dq_marine.checks import finite_array, finite_number, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.contact.formulas import Place
from dq_marine.physics.contact.shapes import LARGEST, SolidShape
from dq_marine.physics.matrices import vector3

SHARPEST_FRICTION = 100.0


@dataclass(frozen=True)
class Solid:
    """Something solid that does not move.

    Attributes:
        shape: `Plane`, `Ball`, `Box`, `Pillar` or `Rod`, a `dq_marine.SolidChart`, or your own `SolidShape`.
        position_ned: of the shape's origin [m].
        heading: of the shape's x axis, from north towards east [rad].
        friction: Coulomb's coefficient, between hull and surface.
        stiffness: force per depth at each place of contact [N/m]; None for one with which the vehicle, on one place
            alone, swings at 20 rad/s: its weight in air would press it in by 2.5 cm at most.
        damping_ratio: of that swinging. 1 for critical damping; 0 for none, so that what hits rebounds.
    """

    shape: SolidShape
    position_ned: Vector3 = (0.0, 0.0, 0.0)
    heading: float = 0.0
    friction: float = 0.4
    stiffness: float | None = None
    damping_ratio: float = 1.0

    def __post_init__(self) -> None:
        """Check every value.

        Raises:
            InvalidInputError: with the reason.
        """
        _check_shape(self.shape)
        position = finite_array("position_ned of a solid", self.position_ned, 3)
        if np.abs(position).max() > LARGEST:
            raise InvalidInputError(
                f"position_ned of a solid = {shown(self.position_ned)}; give at most {LARGEST:g} m"
            )
        object.__setattr__(self, "position_ned", vector3(position))
        object.__setattr__(self, "heading", finite_number("heading of a solid", self.heading))
        friction = finite_number("friction", self.friction, least=0.0, most=SHARPEST_FRICTION)
        object.__setattr__(self, "friction", friction)
        ratio = finite_number("damping_ratio", self.damping_ratio, least=0.0, most=1e3)
        object.__setattr__(self, "damping_ratio", ratio)
        if self.stiffness is not None:
            object.__setattr__(
                self, "stiffness", finite_number("stiffness", self.stiffness, above=0.0, most=1e15)
            )

    @property
    def place(self) -> Place:
        """Its numbers, as the step has them."""
        return Place(self.position_ned, math.cos(self.heading), math.sin(self.heading), self.shape.numbers)


def _check_shape(shape: Any) -> None:
    """Refuse what is no shape, by its distance from the origin."""
    try:
        fine = math.isfinite(shape.distance(shape.numbers, (0.0, 0.0, 0.0)))
    except Exception as error:  # a shape of the user's own may raise anything
        raise InvalidInputError(
            f"a solid's shape = {shown(shape)} has no distance: {type(error).__name__}: {error}; give Plane(...), "
            "Ball(...), Box(...), Pillar(...), Rod(...), a SolidChart, or a SolidShape of your own"
        ) from error
    if not fine:
        raise InvalidInputError(f"a solid's shape = {shown(shape)} is not a finite distance from its origin")
