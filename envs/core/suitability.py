"""Why tasks cannot be done with some vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SURGE, SWAY, YAW = 0, 1, 5

SLOWEST = 5.0
"""Time in which a vehicle that is quick enough for episodes of half a minute goes its own length [s]."""


def speed_ahead(vehicle: Vehicle) -> float:
    """Return the speed through the water at which a vehicle's drag equals the most that drives it ahead [m/s]."""
    from dq_marine.vehicles.analysis.sheet import terminal_speed  # here: `import dq_marine` stays light

    return terminal_speed(vehicle, SURGE)


def unable_to_hold_a_pose(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot hold a pose in a current; None if it can."""
    axes = {SURGE: "surge", SWAY: "sway", YAW: "yaw"}
    lacking = [name for axis, name in axes.items() if not vehicle.wrench_limits[axis]]
    return (
        f"the task holds a pose, and nothing drives the vehicle in {' and '.join(lacking)}"
        if lacking
        else None
    )


def unable_to_travel(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot go from place to place; None if it can."""
    limits = vehicle.wrench_limits
    if limits[SURGE] and (limits[SWAY] or limits[YAW]):
        return None
    return "the task goes from place to place, and the vehicle cannot drive ahead and turn"


def unable_to_keep_up(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot keep a pose that moves, in half a minute; None if it can."""
    return unable_to_hold_a_pose(vehicle) or too_slow(vehicle)


def too_slow(vehicle: Vehicle) -> str | None:
    """Return why a vehicle gets nowhere in an episode of half a minute; None if it does."""
    speed = speed_ahead(vehicle)
    if speed * SLOWEST >= vehicle.dimensions.length:
        return None
    return (
        f"the task takes half a minute, and the vehicle needs more than {SLOWEST:g} s to go its own length, "
        f"{vehicle.dimensions.length:g} m, at {speed:.2g} m/s"
    )


def unable_to_position(vehicle: Vehicle) -> str | None:
    """Return why a vehicle is no vessel that keeps its place by thrusters; None if it is."""
    if vehicle.hydrostatics is None:
        return "the task is for vessels that float"
    sideways = any(abs(thruster.direction[1]) > 0.5 for thruster in vehicle.thrusters)
    if not (sideways or vehicle.azimuths):
        return "the task is done by thrusters, and the vehicle's file has none that push sideways"
    return unable_to_hold_a_pose(vehicle)
