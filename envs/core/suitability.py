"""Why tasks cannot be done with some vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SURGE, SWAY, YAW = 0, 1, 5


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
