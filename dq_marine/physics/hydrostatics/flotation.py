"""Numbers that follow from a hull made of boxes: its columns, and what it displaces at rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.hydrostatics.tables import HullBox

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle

Array = NDArray[np.float64]

COLUMNS_OF_A_BOX = 64
"""About so many, where a file does not say."""

CROSSING_FRACTIONS = (0.1, 0.9)
"""Submerged fractions at rest for which a column's own waterplane inertia is exact; others take the nearest."""


class HullAtRest(NamedTuple):
    """The displacement of the boxes at rest.

    Attributes:
        volume: under water [m^3].
        center: its centroid in the body frame [m], shape (3,).
        waterplane: integrals of 1, x, y, x x, x y, y y over the waterplane [m^2 to m^4], shape (6,).
    """

    volume: float
    center: Array
    waterplane: Array


def cells_of(box: HullBox) -> tuple[int, int]:
    """Return how many columns a box has along x and y: as its file says, else squares, `COLUMNS_OF_A_BOX` of them."""
    if box.cells is not None:
        return box.cells
    length, width, _ = box.size
    edge = math.sqrt(length * width / COLUMNS_OF_A_BOX)
    return math.ceil(round(length / edge, 9)), math.ceil(round(width / edge, 9))


def submerged_fraction(box: HullBox, depth: float) -> float:
    """Return the part of a box that is under water, upright, with the body origin at a depth [m]."""
    return min(1.0, max(0.0, 0.5 + (depth + box.position[2]) / box.size[2]))


def own_inertia_factor(vehicle: Vehicle, box: HullBox) -> float:
    """Return c^2 of `physics.hydrostatics.formulas.hull`: of the fraction at rest, or of one half if nothing floats."""
    if vehicle.hydrostatics is None:
        fraction = 0.5
    else:
        low, high = CROSSING_FRACTIONS
        fraction = min(high, max(low, submerged_fraction(box, vehicle.equilibrium_depth)))
    return 1.0 / (6.0 * fraction * (1.0 - fraction))


def hull_at_rest(vehicle: Vehicle) -> HullAtRest:
    """Return what the boxes displace at the vehicle's equilibrium depth, upright; all of them, if it does not float."""
    volume, moment, waterplane = 0.0, np.zeros(3), np.zeros(6)
    for box in vehicle.hull:
        length, width, height = box.size
        x, y, z = box.position
        part = 1.0
        if vehicle.hydrostatics is not None:
            part = submerged_fraction(box, vehicle.equilibrium_depth)
        displaced = part * length * width * height
        volume += displaced
        moment += displaced * np.array([x, y, z + 0.5 * (1.0 - part) * height])
        if 0.0 < part < 1.0:
            integrals = [1.0, x, y, x * x + length**2 / 12.0, x * y, y * y + width**2 / 12.0]
            waterplane += length * width * np.array(integrals)
    return HullAtRest(volume, moment / volume if volume > 0.0 else moment, waterplane)


def hull_stiffness(vehicle: Vehicle) -> Array:
    """Return C of heave, roll and pitch about the body origin that the boxes give, upright, at rest, shape (3, 3).

    From the waterplane's second moments and the centres of gravity and buoyancy; of a hull that does not float,
    the latter alone.
    """
    rest = hull_at_rest(vehicle)
    specific_weight = vehicle.specific_weight
    area, x, y, xx, xy, yy = specific_weight * rest.waterplane
    below = vehicle.weight * vehicle.rigid_body.center_of_mass[2] - specific_weight * rest.volume * float(
        rest.center[2]
    )
    return np.array([[area, y, -x], [y, yy + below, -xy], [-x, -xy, xx + below]])
