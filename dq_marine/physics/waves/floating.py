"""Waves on a hull that floats, where no force transfer functions are known: the long-wave approximation.

In waves much longer than the hull is wide, the water around it moves as one with it could: a plane that rises and
tilts, and is carried to and fro. With q the displacement and tilt of that plane along the hull, in Fossen's order, the
hull feels

    F = C q_p + B dq/dt + (M_A + M_w) d^2q/dt^2

C the hydrostatic stiffness, with q_p after Smith's correction, the pressure under the hull at its draft T; B the linear
damping and M_A the added mass, on the motion of the water at the hull (the relative-motion hypothesis: radiation tells
diffraction); and M_w the displaced water in surge, sway and yaw, whose Froude-Krylov force stands in no stiffness. It
acts at the centre of mass: C has the weight's moment in it, and a hull that goes with long waves must feel none
(Faltinsen 1990, ch. 3; Newman 1977, Marine Hydrodynamics, ch. 6).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.rao import ForceRAO
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.submerged import stations
from dq_marine.physics.waves.tables import check_rising, check_table

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

HEADINGS: Array = np.arange(72, dtype=np.float64) * math.radians(5.0)
"""Headings at which the approximation is evaluated."""

LARGEST_EXPONENT = 700.0
"""Largest exponent that stays finite in double precision."""


@dataclass(frozen=True, eq=False)
class Radiation:
    """Added mass and damping that depend on the frequency, as strip or panel programs give them.

    Attributes:
        frequencies: rising, shape (n,) [rad/s].
        added_mass: in Fossen's order about the body origin, shape (n, 6, 6) [kg, kg m, kg m^2].
        damping: the same [N s/m, N s, N m s].
    """

    frequencies: Array
    added_mass: Array
    damping: Array

    def __post_init__(self) -> None:
        """Refuse what does not fit together.

        Raises:
            InvalidInputError: with the reason.
        """
        check_rising("frequencies", self.frequencies)
        for name in ("added_mass", "damping"):
            check_table(name, getattr(self, name), (len(self.frequencies), 6, 6))

    def at(self, frequencies: Array) -> tuple[Array, Array]:
        """Return added mass and damping at frequencies, each (len(frequencies), 6, 6); held beyond the ends."""
        both = np.stack([self.added_mass, self.damping]).reshape(2, len(self.frequencies), 36)
        found = [[np.interp(frequencies, self.frequencies, column) for column in part.T] for part in both]
        added, damping = (np.array(part).T.reshape(-1, 6, 6) for part in found)
        return added, damping


def radiation_of(vehicle: Vehicle) -> Radiation | None:
    """Return what a vehicle's file has of radiation, None if nothing."""
    own = vehicle.radiation
    return None if own is None else Radiation(*map(np.array, (own.frequencies, own.added_mass, own.damping)))


def draft_of(vehicle: Vehicle, stiffness: Array) -> float:
    """Return a vessel's mean draft [m], the volume over the area of the waterplane, from its stiffness in heave."""
    return float(vehicle.buoyancy.volume * vehicle.specific_weight / stiffness[0, 0])


def long_wave_rao(
    sea: Sea, vehicle: Vehicle, stiffness: Array, radiation: Radiation | None = None
) -> ForceRAO:
    """Return force transfer functions at a sea's frequencies, in the long-wave approximation.

    Good for waves longer than some five beams; along its length the hull is cut into stations.

    Args:
        sea: whose frequencies, depth and gravity.
        vehicle: a vessel at rest with its body origin in the still waterline, or near it.
        stiffness: of heave, roll and pitch about the body origin, shape (3, 3) [N/m, N, N m].
        radiation: added mass and damping by frequency, where known; else the vehicle's own for all.
    """
    omega, k = sea.frequencies, sea.wave_numbers
    water = Water.of(sea, vehicle, stiffness)
    restoring = np.zeros((6, 6))
    restoring[2:5, 2:5] = stiffness
    if radiation is None:
        added = np.broadcast_to(vehicle.added_mass_matrix, (omega.size, 6, 6))
        damping = np.broadcast_to(vehicle.damping_at_rest, (omega.size, 6, 6))
    else:
        added, damping = radiation.at(omega)
    pressed = water.plane(k, water.pressure, water.pressure)
    moved = water.plane(k, water.across, water.down)
    transfer = (
        np.einsum("ab,jmb->jma", restoring, pressed)
        + 1j * omega[:, None, None] * np.einsum("jab,jmb->jma", damping, moved)
        - (omega**2)[:, None, None] * np.einsum("jab,jmb->jma", added, moved)
        - (omega**2)[:, None, None] * displaced_water(vehicle, water, moved)
    )
    return ForceRAO(omega, HEADINGS, transfer)


@dataclass(frozen=True, eq=False)
class Water:
    """The water at a hull in unit waves, one entry for each frequency.

    Attributes:
        pressure: at the draft, over that at the surface.
        across: amplitude of the horizontal motion, mean over the draft.
        down: amplitude of the vertical motion at the draft.
        places: of the stations along the hull, from its middle [m].
        shares: of the stations.
        middle: x of the hull's middle [m].
        spread: mean square of the places [m^2].
    """

    pressure: Array
    across: Array
    down: Array
    places: Array
    shares: Array
    middle: float
    spread: float

    @staticmethod
    def of(sea: Sea, vehicle: Vehicle, stiffness: Array) -> Water:
        """Return the water at a vehicle; its draft is the volume over the waterplane's area."""
        k, omega = sea.wave_numbers, sea.frequencies
        draft = draft_of(vehicle, stiffness)
        depth = math.inf if sea.depth is None else sea.depth
        if draft >= depth:
            raise InvalidInputError(
                f"the vessel's draft of {draft:.3g} m is more than the water's depth of {depth:g} m; give deeper water"
            )
        fall = np.exp(-k * draft)
        echo = np.exp(-np.minimum(2.0 * k * depth, LARGEST_EXPONENT)) if sea.depth else np.zeros_like(k)
        rise = echo / fall
        places, shares = stations(sea, vehicle.dimensions.length)
        if places.size == 1:  # two stations can tell a slope
            half = 0.5 * vehicle.dimensions.length / math.sqrt(3.0)
            places, shares = np.array([-half, half]), np.array([0.5, 0.5])
        return Water(
            pressure=(fall + rise) / (1.0 + echo),
            across=sea.gravity / omega**2 * ((1.0 - fall) + echo * (1.0 / fall - 1.0)) / (1.0 + echo) / draft,
            down=(fall - rise) / (1.0 - echo),
            places=places,
            shares=shares,
            middle=vehicle.buoyancy.center[0],
            spread=float(shares @ places**2),
        )

    def plane(self, k: Array, across: Array, down: Array) -> ComplexArray:
        """Return the plane's displacement and tilt about the body origin, by frequency and heading, (n, m, 6).

        Complex amplitudes in waves of unit amplitude: the surface's rise at the origin is 1. The plane is the one of
        least squares along the hull.
        """
        cosine, sine = np.cos(HEADINGS), np.sin(HEADINGS)
        x = self.places + self.middle
        waves = np.exp(-1j * k[:, None, None] * cosine[:, None] * x)
        mean, slope = waves @ self.shares, waves @ (self.shares * self.places) / self.spread
        across_, down_ = across[:, None], down[:, None]
        pitch = down_ * slope
        yaw = -1j * across_ * sine * slope
        return np.stack(
            [
                -1j * across_ * cosine * mean,
                -1j * across_ * sine * mean - self.middle * yaw,
                -down_ * mean + self.middle * pitch,
                1j * k[:, None] * down_ * sine * mean,
                pitch,
                yaw,
            ],
            axis=2,
        )


def displaced_water(vehicle: Vehicle, water: Water, moved: ComplexArray) -> ComplexArray:
    """Return what the displaced water's mass makes of horizontal motion, by frequency and heading, (n, m, 6).

    Spread evenly along the hull, at the height of the centre of mass.
    """
    mass = vehicle.buoyancy.water_density * vehicle.buoyancy.volume
    height = vehicle.rigid_body.center_of_mass[2]
    surge, yaw = moved[..., 0], moved[..., 5]
    sway = moved[..., 1] + water.middle * yaw
    nothing = np.zeros_like(surge)
    turning = water.middle * sway + water.spread * yaw
    return mass * np.stack([surge, sway, nothing, -height * sway, height * surge, turning], axis=2)
