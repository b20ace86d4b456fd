"""The coefficients of an MMG hull's polynomials, as numbers that can be fitted.

Resistance, Y'_v and N'_r keep their signs whatever theta is, because with another the hull would drive the ship in
surge, sway or yaw; the others may change theirs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from dq_marine.physics.manoeuvring.tables import LateralTable, Manoeuvring, SurgeTable
from dq_marine.vehicles import Vehicle

Place = tuple[int, ...]

AXES = (("surge", "X'"), ("sway", "Y'"), ("yaw", "N'"))
"""Tables of the hull, and what their polynomials are called."""

NAMES = (tuple(SurgeTable.model_fields), *[tuple(LateralTable.model_fields)] * 2)
"""Coefficients in the tables."""

OF_ONE_SIGN = {(0, "resistance"), (1, "v"), (2, "r")}


def hull_places(vehicle: Vehicle) -> list[tuple[str, Place]]:
    """Return label and place of each coefficient that is not zero; none of a vehicle without an MMG model."""
    if vehicle.manoeuvring is None:
        return []
    places = [(axis, number) for axis, names in enumerate(NAMES) for number in range(len(names))]
    return [(_label(place), place) for place in places if hull_coefficient(vehicle.manoeuvring, place)]


def hull_coefficient(ship: Manoeuvring, place: Place) -> float:
    """Return a coefficient of an MMG model."""
    axis, number = place
    table = getattr(ship.hull, AXES[axis][0])
    return float(getattr(table, NAMES[axis][number]))


def hull_changed(ship: Manoeuvring, values: Mapping[Place, float]) -> dict[str, Any]:
    """Return the table `manoeuvring` with coefficients at theta, by their places."""
    tables = ship.model_dump()
    for (axis, number), theta in values.items():
        name = NAMES[axis][number]
        factor = math.exp(theta) if (axis, name) in OF_ONE_SIGN else 1.0 + theta
        tables["hull"][AXES[axis][0]][name] *= factor
    return tables


def _label(place: Place) -> str:
    axis, number = place
    name = NAMES[axis][number]
    return f"hull, {AXES[axis][0]}, " + ("R'_0" if name == "resistance" else f"{AXES[axis][1]}_{name}")
