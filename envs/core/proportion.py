"""Currents, winds and seas in proportion to a vehicle, for the levels of tasks that suit small and large ones.

A speed is a share of the cruising speed. A sea's significant height is a share of the vessel's length, and at the peak
its waves are as long as the vessel, or as five of its beams: shorter ones are not what forces by long waves are good
for. By the dispersion of deep water, w^2 = g k (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, ch. 2),
waves of a length have the period

    T = sqrt(2 pi length / g).                                                                         (1)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from dq_marine.envs.core.definition import ForVehicle
from dq_marine.envs.core.suitability import cruising_speed

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

BEAMS = 5.0
"""Least length of waves at the peak of a sea, over the beam."""


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


def sea_for(share: float) -> ForVehicle:
    """Return the weather of a sea as high as a share of the vessel's length, with its slow drift; none under water."""
    return ForVehicle(
        lambda vehicle: [_sea(share, vehicle)] if vehicle.hydrostatics is not None else [],
        f"for vessels that float, a sea of {share:g} of the length, its waves about as long as the vessel",
    )


def _sea(share: float, vehicle: Vehicle) -> dict[str, Any]:
    size = vehicle.dimensions
    longest = max(size.length, BEAMS * size.width)
    period = math.sqrt(math.tau * longest / vehicle.gravity)  # (1)
    return {
        "kind": "sea",
        "height": share * size.length,
        "period": period,
        "direction": math.pi,
        "slow_drift": True,
    }


def _wind(share: float, vehicle: Vehicle) -> dict[str, Any]:
    speed = share * cruising_speed(vehicle)
    return {"kind": "wind", "speed": speed, "direction_from": 0.5 * math.pi, "gusts": True}
