"""Currents, winds and seas in proportion to a vehicle, for the levels of tasks that suit small and large ones.

A speed is a share of the cruising speed. A wave's height and length are shares of the vehicle's length L, so that its
period, 2 pi / w with w^2 = g k in deep water (Fossen 2021, Handbook of Marine Craft, eq. 10.65), is that of

    T = sqrt(2 pi (wave length / L) L / g).                                                            (1)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from dq_marine.envs.core.definition import ForVehicle
from dq_marine.envs.core.suitability import cruising_speed

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

STANDARD_GRAVITY = 9.81
"""For the periods of waves [m/s^2]."""


def disturbed(current: float, wind: float) -> dict[str, ForVehicle]:
    """Return the keywords of a level with a current and a wind, as shares of the cruising speed."""
    return {"current": current_for(current), "weather": wind_for(wind)}


def current_for(share: float) -> ForVehicle:
    """Return a current to draw, of at most a share of the cruising speed."""
    return ForVehicle(lambda vehicle: share * cruising_speed(vehicle), f"{share:g} of the cruising speed")


def current_or(usual: float, slight: Callable[[Vehicle], bool], share: float) -> ForVehicle:
    """Return a current of a speed [m/s], and of at most a share of the cruising speed for vehicles that are told by it.

    Args:
        usual: for all others.
        slight: (vehicle) -> whether it is one of those.
        share: of the cruising speed.
    """
    return ForVehicle(
        lambda vehicle: share * cruising_speed(vehicle) if slight(vehicle) else usual,
        f"{usual:g}, or {share:g} of the cruising speed of vehicles that only steer",
    )


def wind_for(share: float) -> ForVehicle:
    """Return the weather of a gusty wind of a share of the cruising speed at 10 m."""
    return ForVehicle(
        lambda vehicle: [_wind(share, vehicle)], f"a gusty wind of {share:g} of the cruising speed"
    )


def _wind(share: float, vehicle: Vehicle) -> dict[str, Any]:
    speed = share * cruising_speed(vehicle)
    return {"kind": "wind", "speed": speed, "direction_from": 0.5 * math.pi, "gusts": True}
