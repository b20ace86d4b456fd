"""Shapes of solids, each in axes of its own; `dq_marine.SolidChart` is one more, from a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np

from dq_marine.algebra.vector3 import Vector3
from dq_marine.checks import finite_array, finite_number, length_of, shown
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.contact import Distance
from dq_marine.physics.contact.formulas import (
    distance_of_ball,
    distance_of_box,
    distance_of_pillar,
    distance_of_plane,
    distance_of_rod,
)
from dq_marine.physics.matrices import vector3

LARGEST = 1e5
"""Of a solid's measures [m]."""


@runtime_checkable
class SolidShape(Protocol):
    """A shape that is known by its signed distance, which changes by no more than the point moves."""

    @property
    def distance(self) -> Distance:
        """The pure function (numbers, point) -> signed distance [m], negative inside."""

    @property
    def numbers(self) -> Any:
        """What the function takes: nested tuples of numbers."""


@dataclass(frozen=True)
class Plane:
    """All that is behind a plane through the origin.

    Attributes:
        normal: where the plane looks, away from what is solid; up by default, as a level seabed. Any length.
    """

    normal: Vector3 = (0.0, 0.0, -1.0)
    distance = staticmethod(distance_of_plane)

    def __post_init__(self) -> None:
        """Check the normal.

        Raises:
            InvalidInputError: it is no direction.
        """
        normal = finite_array("normal", self.normal, 3)
        length = float(length_of(normal))
        if not 1e-9 < length < 1e9:
            raise InvalidInputError(
                f"normal = {shown(self.normal)} is no direction; give one such as (0, 0, -1)"
            )
        object.__setattr__(self, "normal", vector3(normal))

    @property
    def numbers(self) -> Vector3:
        """See `SolidShape`: the unit normal."""
        normal = np.array(self.normal)
        return vector3(normal / length_of(normal))


@dataclass(frozen=True)
class _Round:
    """A shape that is known by its radius [m]."""

    radius: float

    def __post_init__(self) -> None:
        """Check the radius."""
        object.__setattr__(self, "radius", _measure("radius", self.radius))

    @property
    def numbers(self) -> tuple[float]:
        """See `SolidShape`."""
        return (self.radius,)


@dataclass(frozen=True)
class Ball(_Round):
    """A ball about the origin, of a radius [m]."""

    distance = staticmethod(distance_of_ball)


@dataclass(frozen=True)
class Pillar(_Round):
    """A vertical cylinder through the origin, as long as the water is deep, of a radius [m]."""

    distance = staticmethod(distance_of_pillar)


@dataclass(frozen=True)
class Box:
    """A box about the origin, of whole sizes along its axes [m]."""

    size: Vector3
    distance = staticmethod(distance_of_box)

    def __post_init__(self) -> None:
        """Check the sizes."""
        sides = [
            _measure(f"size[{axis}]", side) for axis, side in enumerate(finite_array("size", self.size, 3))
        ]
        object.__setattr__(self, "size", tuple(sides))

    @property
    def numbers(self) -> Vector3:
        """See `SolidShape`."""
        return (0.5 * self.size[0], 0.5 * self.size[1], 0.5 * self.size[2])


@dataclass(frozen=True)
class Rod:
    """A straight pipe with round ends, from the origin to `end` [m], of a radius [m]."""

    end: Vector3
    radius: float
    distance = staticmethod(distance_of_rod)

    def __post_init__(self) -> None:
        """Check end and radius.

        Raises:
            InvalidInputError: one is wrong, or the rod has no length.
        """
        end = finite_array("end", self.end, 3)
        _measure("length of a rod", float(length_of(end)))
        object.__setattr__(self, "end", vector3(end))
        object.__setattr__(self, "radius", _measure("radius", self.radius))

    @property
    def numbers(self) -> tuple[Vector3, float]:
        """See `SolidShape`."""
        return (self.end, self.radius)


Simple: TypeAlias = Plane | Ball | Box | Pillar | Rod

SHAPES: dict[str, type[Simple]] = {
    "plane": Plane,
    "ball": Ball,
    "box": Box,
    "pillar": Pillar,
    "rod": Rod,
}
"""By their kinds in dictionaries."""


def _measure(name: str, value: Any) -> float:
    return finite_number(name, value, above=0.0, most=LARGEST)
