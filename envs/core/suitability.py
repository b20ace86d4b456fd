"""Why tasks cannot be done with some vehicles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SURGE, SWAY, HEAVE, PITCH, YAW = 0, 1, 2, 4, 5

CRUISE = 0.6
"""Speed of journeys over the largest."""

CREEP = 0.05
"""Speed at which a vehicle has to be able to slow down yet, to stop where it should, over that of journeys."""

PERIODS_A_LENGTH = 15.0
"""Control periods in which a vehicle at full speed goes its own length, where these are longer than the shortest."""

SHORTEST_PERIOD, LONGEST_PERIOD = 0.1, 5.0
"""Control periods [s]; beyond the longer one, the explicit steps of ships that roll get coarse."""

SLOWEST = 5.0
"""Time in which a vehicle that is quick enough for episodes of half a minute goes its own length [s]."""


def speed_ahead(vehicle: Vehicle) -> float:
    """Return the speed through the water at which a vehicle's drag equals the most that drives it ahead [m/s]."""
    from dq_marine.vehicles.analysis.sheet import terminal_speed  # here: `import dq_marine` stays light

    return terminal_speed(vehicle, SURGE)


def cruising_speed(vehicle: Vehicle) -> float:
    """Return a speed for journeys [m/s]: three fifths of the largest, and of that at which a free pitch gets unstable.

    Below the surface, Munk's moment (A_33 - A_11) u^2 theta of the added mass turns a vehicle across its way; where
    nothing drives pitch, it is the righting moment alone that holds it (Fossen 2021, Handbook of Marine Craft, 6.3).
    """
    speed = speed_ahead(vehicle)
    added, righting = vehicle.added_mass_matrix, float(vehicle.restoring_arm[2])
    munk = float(added[HEAVE, HEAVE] - added[SURGE, SURGE])
    if vehicle.hydrostatics is None and not vehicle.wrench_limits[PITCH] and munk > 0.0:
        speed = min(speed, math.sqrt(max(0.0, righting) / munk))
    return CRUISE * speed


def paced(vehicle: Vehicle) -> float:
    """Return a control period for journeys: a fifteenth of the time for its own length, rounded, and 0.1 s or more.

    A ship of 170 m that goes 9 m/s acts every second, and goes as many lengths in an episode as a vehicle of 3 m.
    """
    speed = speed_ahead(vehicle)
    if not 0.0 < speed < math.inf:
        return SHORTEST_PERIOD
    period = max(SHORTEST_PERIOD, vehicle.dimensions.length / speed / PERIODS_A_LENGTH)
    digits = -math.floor(math.log10(period))
    return min(LONGEST_PERIOD, round(period, digits))


def unable_to_hold_a_pose(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot hold a pose in a current; None if it can."""
    axes = {SURGE: "surge", SWAY: "sway", YAW: "yaw"}
    lacking = [name for axis, name in axes.items() if not vehicle.wrench_limits[axis]]
    return (
        f"the task holds a pose, and nothing drives the vehicle in {' and '.join(lacking)}"
        if lacking
        else None
    )


def steers_only_under_way(vehicle: Vehicle) -> bool:
    """Whether a vehicle cannot stop and hold a pose, and must come to a place at speed."""
    return unable_to_hold_a_pose(vehicle) is not None


def unable_to_travel(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot go from place to place; None if it can."""
    limits = vehicle.wrench_limits
    if limits[SURGE] and (limits[SWAY] or limits[YAW]):
        return None
    return "the task goes from place to place, and the vehicle cannot drive ahead and turn"


def unable_to_sail(vehicle: Vehicle) -> str | None:
    """Return why a vehicle is no vessel that goes from place to place at the surface; None if it is."""
    if vehicle.hydrostatics is None:
        return "the task is for vessels that float"
    return unable_to_travel(vehicle)


def unable_to_berth(vehicle: Vehicle) -> str | None:
    """Return why a vehicle is no vessel that comes to a place at the surface and stops there; None if it is."""
    return unable_to_sail(vehicle) or unable_to_slow_down(vehicle)


def unable_to_slow_down(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot slow down to `CREEP`; None if it can."""
    from dq_marine.vehicles.analysis.sheet import drag_of  # here: `import dq_marine` stays light

    slow = CREEP * cruising_speed(vehicle)
    drag, astern = drag_of(vehicle, SURGE)(slow), float(vehicle.wrench_limits[SURGE])
    if astern + drag > 0.0:
        return None
    return (
        f"the task is to slow down, and the vehicle's model has a propeller in it that is still driving it ahead with "
        f"{-drag:.3g} N at {slow:.2g} m/s, against {astern:.3g} N astern"
    )


def unable_to_dive_under_way(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot change depth while it goes ahead and turns; None if it can."""
    limits = vehicle.wrench_limits
    if vehicle.hydrostatics is not None:
        return "the task is to dive, and the vehicle floats"
    if limits[SURGE] and limits[YAW] and (limits[HEAVE] or limits[PITCH]):
        return None
    return "the task is to go ahead, turn and dive, and the vehicle cannot drive all three"


def unable_to_keep_up(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot keep a pose that moves, in half a minute; None if it can."""
    return unable_to_hold_a_pose(vehicle) or too_slow(vehicle)


def unable_to_track(vehicle: Vehicle) -> str | None:
    """Return why a vehicle cannot follow a point that moves, by its pose or by steering; None if it can."""
    if unable_to_keep_up(vehicle) is None:
        return None
    return unable_to_travel(vehicle) or unable_to_slow_down(vehicle)


def tracks_by_steering(vehicle: Vehicle) -> bool:
    """Whether a vehicle follows a point that moves by speed and course alone, its bow about along its way."""
    return unable_to_keep_up(vehicle) is not None


def turning_radius(vehicle: Vehicle, speed: float) -> float:
    """Return the radius of the tightest steady turn at a speed [m], by the turn rate that damping of yaw allows."""
    from dq_marine.vehicles.analysis.sheet import terminal_speed  # here: `import dq_marine` stays light

    return speed / max(terminal_speed(vehicle, YAW), 1e-9)


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
