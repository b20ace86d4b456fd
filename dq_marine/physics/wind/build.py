"""Wind, and the part of a vessel on which it acts."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_number, positive_integer, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.matrices import vector3
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.floating import draft_of
from dq_marine.physics.waves.sea import MOST_COMPONENTS, generator
from dq_marine.physics.wind.formulas import WindForce, gusty_wind, steady_wind
from dq_marine.physics.wind.gusts import gust_harmonics, mean_speed

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

AIR_DENSITY = 1.225
"""Density of air at 15 degrees Celsius [kg/m^3]."""

STRONGEST = 100.0
"""Mean wind [m/s]."""

LOWEST = 0.1
"""Height at which the wind's profile still means something [m]."""


@dataclass(frozen=True)
class Windage:
    """The part of a vessel above the water, and its coefficients.

    Coefficients of ships are about c_x = 0.5 to 0.9, c_y = 0.7 to 0.95 and c_n = 0.05 to 0.2 (Fossen 2021, sec. 10.1).

    Attributes:
        frontal_area: A_F, seen from ahead [m^2].
        lateral_area: A_L, seen from the side [m^2].
        length: L, overall [m].
        height: of the force above the water, where the wind's speed is taken [m].
        above_origin: height of the force above the body origin [m].
        c_x: in surge.
        c_y: in sway.
        c_n: in yaw.
    """

    frontal_area: float
    lateral_area: float
    length: float
    height: float
    above_origin: float = 0.0
    c_x: float = 0.7
    c_y: float = 0.8
    c_n: float = 0.1

    def __post_init__(self) -> None:
        """Refuse what is no windage.

        Raises:
            InvalidInputError: with the reason.
        """
        for field in fields(self):
            value = finite_number(f"windage.{field.name}", getattr(self, field.name))
            if value < 0.0 and field.name not in ("above_origin", "c_n"):
                raise InvalidInputError(f"windage.{field.name} = {value:g}; give 0 or more")
            object.__setattr__(self, field.name, value)

    @staticmethod
    def of(vehicle: Vehicle) -> Windage:
        """Return that of a vessel as a box of its overall size, as far as it stands out of the water.

        Raises:
            InvalidInputError: the vehicle is submerged.
        """
        stiffness = vehicle.waterplane_stiffness
        if stiffness is None:
            raise InvalidInputError(
                f"{vehicle.name} is submerged, where there is no wind; give Wind(..., windage=Windage(...)) for what "
                "stands out of the water, or leave the wind out"
            )
        size = vehicle.dimensions
        freeboard = max(size.height - draft_of(vehicle, stiffness), 0.1 * size.height)
        return Windage(
            frontal_area=size.width * freeboard,
            lateral_area=size.length * freeboard,
            length=size.length,
            height=0.5 * freeboard,
            above_origin=0.5 * freeboard,
        )


@dataclass(frozen=True)
class Wind:
    """A mean wind, with gusts if wanted.

    It blows past the vehicle, which may move: over the ground, that is with a current as far as that is known when the
    forces are made. Where an environment draws its current, the wind does not know what was drawn.

    Attributes:
        speed: mean over an hour, at 10 m above the sea [m/s].
        direction_from: where it comes from, an angle from north towards east [rad].
        windage: what it has hold of; None for that of the vehicle's size.
        gusts: whether there are any, of the Norwegian Petroleum Directorate's spectrum (ISO 19901-1).
        components: harmonics of the gusts.
        seed: of the gusts.
        air_density: [kg/m^3].
    """

    speed: float
    direction_from: float
    windage: Windage | None = None
    gusts: bool = False
    components: int = 40
    seed: int = 0
    air_density: float = AIR_DENSITY

    def __post_init__(self) -> None:
        """Refuse what is no wind.

        Raises:
            InvalidInputError: with the reason.
        """
        speed = finite_number("speed", self.speed)
        if not 0.0 <= speed <= STRONGEST:
            raise InvalidInputError(f"speed = {speed:g} m/s; give 0 to {STRONGEST:g}")
        object.__setattr__(self, "speed", speed)
        object.__setattr__(self, "direction_from", finite_number("direction_from", self.direction_from))
        object.__setattr__(self, "air_density", finite_number("air_density", self.air_density, above=0.0))
        if positive_integer("components", self.components) > MOST_COMPONENTS:
            raise InvalidInputError(f"components = {self.components}; give at most {MOST_COMPONENTS}")
        if self.windage is not None and not isinstance(self.windage, Windage):
            raise InvalidInputError(f"windage = {shown(self.windage)}; give a Windage, or None")
        generator(self.seed)

    @property
    def changes(self) -> bool:
        """Gusts do."""
        return self.gusts and self.speed > 0.0

    @property
    def along(self) -> NDArray[np.float64]:
        """Unit vector of where it goes, shape (3,)."""
        return -np.array([math.cos(self.direction_from), math.sin(self.direction_from), 0.0])

    @property
    def mean_ned(self) -> NDArray[np.float64]:
        """Velocity of the mean wind at 10 m above the sea, shape (3,) [m/s]."""
        return self.speed * self.along

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the force on a vehicle in a current [m/s], shape (3,).

        Raises:
            InvalidInputError: the vehicle is submerged, and no windage was given.
        """
        hold = self._windage(vehicle)
        height = max(hold.height, LOWEST)
        mean = max(mean_speed(self.speed, height), 0.0)
        parameters = WindForce(
            air=vector3(mean * self.along - current_ned),
            along=vector3(self.along),
            surge=0.5 * self.air_density * hold.c_x * hold.frontal_area,
            sway=0.5 * self.air_density * hold.c_y * hold.lateral_area,
            yaw=self.air_density * hold.c_n * hold.lateral_area * hold.length,
            height=hold.above_origin,
            gusts=gust_harmonics(self.speed, height, self.components, self.seed) if self.changes else (),
        )
        return (
            ForceTerm("wind", gusty_wind if self.changes else steady_wind, parameters, uses_velocity=True),
        )

    def of_hull(self, vehicle: Vehicle) -> Wind:
        """Return this wind on a vehicle's hull, for any other vehicle that has this hull.

        Raises:
            InvalidInputError: the vehicle is submerged, and no windage was given.
        """
        return replace(self, windage=self._windage(vehicle))

    def _windage(self, vehicle: Vehicle) -> Windage:
        return Windage.of(vehicle) if self.windage is None else self.windage
