"""Spread of drawn vehicles in the numbers that determine their behaviour."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from dq_marine.vehicles import Vehicle, vehicle_sheet
from dq_marine.vehicles.model import MOTIONS

ROTATIONS = MOTIONS[3:]

ROUND_OFF = 5e-9
"""Net weight over weight below which a vehicle counts as neutral: the rounding of a file's numbers."""


@dataclass(frozen=True)
class Spread:
    """One number of a vehicle, and of those drawn from it.

    Attributes:
        name: what it is.
        unit: its SI unit.
        nominal: the vehicle's own.
        least: smallest of all drawn.
        mean: of all drawn.
        largest: of all drawn.
    """

    name: str
    unit: str
    nominal: float
    least: float
    mean: float
    largest: float

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON has it: numbers that are infinite become None."""
        infinite = {key: None for key, value in asdict(self).items() if value == math.inf}
        return asdict(self) | infinite


def spread_of(vehicle: Vehicle, drawn: Sequence[Vehicle]) -> list[Spread]:
    """Return the spreads of masses, periods and terminal speeds, without axes that are not actuated."""
    own = _numbers(vehicle)
    rows = [_numbers(one) for one in drawn]
    spreads = []
    for key, nominal in own.items():
        values = np.array([row[key] for row in rows])
        spreads.append(Spread(*key, nominal, float(values.min()), float(values.mean()), float(values.max())))
    return spreads


def _numbers(vehicle: Vehicle) -> dict[tuple[str, str], float]:
    """Return a vehicle's numbers by name and unit."""
    sheet = vehicle_sheet(vehicle)
    net = sheet.weight - sheet.buoyancy
    moments = dict(zip(MOTIONS, np.diag(vehicle.rigid_body_matrix).tolist(), strict=True))
    numbers = {
        ("mass", "kg"): sheet.dry_mass,
        ("volume", "m^3"): vehicle.buoyancy.volume,
        ("weight less buoyancy", "N"): 0.0 if abs(net) < ROUND_OFF * sheet.weight else net,
        ("natural period of roll", "s"): sheet.roll_period,
        ("natural period of pitch", "s"): sheet.pitch_period,
    }
    for motion in MOTIONS:
        unit = "kg m^2" if motion in ROTATIONS else "kg"
        if motion in ROTATIONS:
            numbers[f"inertia in {motion}", unit] = moments[motion]
        numbers[f"added mass in {motion}", unit] = sheet.added_mass[motion]
    for motion, speed in sheet.terminal_speed.items():
        if speed > 0.0:
            numbers[f"terminal speed in {motion}", "rad/s" if motion in ROTATIONS else "m/s"] = speed
    return numbers
