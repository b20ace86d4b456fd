"""Checks of a ship's MMG model: that it fits the ship and resists motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dq_marine.physics.fields import MOTIONS
from dq_marine.physics.implausible import Implausible
from dq_marine.physics.manoeuvring.build import own_axis_drag
from dq_marine.physics.manoeuvring.tables import Manoeuvring

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Dimensions, Vehicle

SIZE_RANGE = (0.5, 1.2)  # length between perpendiculars and draft, over overall length and height
LONGEST_LEVER = 1.5  # of propeller and rudder, over the length
IN_THE_PLANE = (0, 1, 5)  # surge, sway and yaw


def check_manoeuvring(vehicle: Vehicle) -> None:
    """Check a vehicle whose fields are each valid on their own.

    Raises:
        Implausible: for the first contradiction found.
    """
    if vehicle.manoeuvring is not None:
        _check_size(vehicle.manoeuvring, vehicle.dimensions)
        _check_levers(vehicle.manoeuvring)
        _check_resistance(vehicle)


def _check_size(tables: Manoeuvring, size: Dimensions) -> None:
    low, high = SIZE_RANGE
    for part, value, whole in (
        ("length", tables.length, size.length),
        ("draft", tables.draft, size.draft or size.height),
    ):
        if not low * whole <= value <= high * whole:
            raise Implausible(
                f"manoeuvring.{part}",
                value,
                f"it does not fit dimensions with {whole:.4g} m ({low:g} to {high:g} of it)",
                "give both in m",
            )


def _check_levers(tables: Manoeuvring) -> None:
    levers = {
        "propeller.position": tables.propeller.position,
        "rudder.position": tables.rudder.position,
        "rudder.increase_position": tables.rudder.increase_position,
        "rudder.lever": tables.rudder.lever,
    }
    for field, value in levers.items():
        if not -LONGEST_LEVER <= value < 0.0:
            raise Implausible(
                f"manoeuvring.{field}",
                value,
                f"it lies outside -{LONGEST_LEVER:g} to 0 lengths: propeller and rudder are aft of midship",
                "give it over the length between perpendiculars, negative aft",
            )


def _check_resistance(vehicle: Vehicle) -> None:
    for axis in IN_THE_PLANE:
        drag = own_axis_drag(vehicle, axis)
        if drag <= 0.0:
            raise Implausible(
                f"manoeuvring.hull.{MOTIONS[axis]}",
                f"{-drag:.4g} at unit speed",
                f"at its limits the hull drives {MOTIONS[axis]} instead of resisting it",
                "check the signs; the published derivatives Y'_v, Y'_vvv, N'_r and N'_rrr are negative",
            )
