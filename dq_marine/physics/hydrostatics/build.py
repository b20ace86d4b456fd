"""A vehicle's weight and buoyancy as forces of a scene: under water, on a waterplane, or by its hull."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dq_marine.checks import one_of
from dq_marine.errors import InvalidInputError
from dq_marine.physics.hydrostatics.flotation import cells_of, hull_stiffness, own_inertia_factor
from dq_marine.physics.hydrostatics.formulas.hull import Columns, make_box_buoyancy
from dq_marine.physics.hydrostatics.formulas.submerged import (
    NetWeight,
    RightingMoment,
    net_weight,
    net_weight_potential,
    righting_moment,
    righting_potential,
)
from dq_marine.physics.hydrostatics.formulas.waterplane import (
    WaterplaneRestoring,
    waterplane_restoring,
    waterplane_restoring_in_body_axes,
)
from dq_marine.physics.hydrostatics.restoring import floating_modes, restoring_frequencies
from dq_marine.physics.hydrostatics.tables import HullBox, Hydrostatics
from dq_marine.physics.matrices import Array, matrix3, vector3
from dq_marine.physics.term import ForceTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

HYDROSTATICS = ("linear", "hull")
"""Names of the ways to compute buoyancy: for small motions about rest, or from the hull at any depth and attitude."""

WATERPLANE_FORCES = {"earth": waterplane_restoring, "body": waterplane_restoring_in_body_axes}
"""Force of a waterplane, by the axes that it acts along."""

NEUTRAL_TOLERANCE = 1e-9
"""Net weight over weight, and righting arm over the vehicle's length, below which a term counts as absent."""


def checked_hydrostatics(kind: str, vehicle: Vehicle) -> str:
    """Return how buoyancy is computed, if the vehicle has what that needs.

    Raises:
        InvalidInputError: there is no such kind, or the vehicle has no hull.
    """
    one_of("hydrostatics", kind, HYDROSTATICS)
    if kind == "hull" and not vehicle.hull:
        raise InvalidInputError(
            f"hydrostatics = 'hull', but {vehicle.name} has no hull; add [[hull]] boxes to its file, or give 'linear'"
        )
    return kind


def hydrostatic_terms(vehicle: Vehicle, kind: str) -> tuple[ForceTerm, ...]:
    """Return the forces of weight and buoyancy, without those that are zero but for round-off."""
    if kind == "hull":
        return hull_terms(vehicle)
    floating = vehicle.hydrostatics
    return submerged_terms(vehicle) if floating is None else floating_terms(vehicle, floating)


def submerged_terms(vehicle: Vehicle) -> tuple[ForceTerm, ...]:
    """Return net weight and righting moment of a vehicle under water."""
    excess = vehicle.weight - vehicle.buoyant_force + vehicle.payload_weight
    arm = vehicle.restoring_arm + vehicle.payload_moment
    if abs(excess) <= NEUTRAL_TOLERANCE * vehicle.weight:
        excess = 0.0
    if np.abs(arm).max() <= NEUTRAL_TOLERANCE * vehicle.weight * vehicle.dimensions.length:
        arm = np.zeros(3)
    return restoring_terms(excess, arm)


def floating_terms(vehicle: Vehicle, hydrostatics: Hydrostatics) -> tuple[ForceTerm, ...]:
    """Return the restoring force of a vessel's waterplane, and of its payloads."""
    stiffness = hydrostatics.stiffness_about_origin(vehicle.specific_weight, vehicle.buoyant_force)
    symmetric = matrix3(0.5 * (stiffness + stiffness.T))
    waterplane = WaterplaneRestoring(symmetric, hydrostatics.equilibrium_depth)
    term = ForceTerm("waterplane restoring", WATERPLANE_FORCES[hydrostatics.force_axes], waterplane)
    return (term, *restoring_terms(vehicle.payload_weight, vehicle.payload_moment))


def hull_terms(vehicle: Vehicle) -> tuple[ForceTerm, ...]:
    """Return weight, and the buoyancy of each box of the hull."""
    arm = vehicle.weight * np.array(vehicle.rigid_body.center_of_mass) + vehicle.payload_moment
    boxes = [
        ForceTerm(
            f"buoyancy of hull box {number}", make_box_buoyancy(*cells_of(box)), columns_of(vehicle, box)
        )
        for number, box in enumerate(vehicle.hull)
    ]
    return (*restoring_terms(vehicle.weight + vehicle.payload_weight, arm), *boxes)


def columns_of(vehicle: Vehicle, box: HullBox) -> Columns:
    """Return the columns that a box is cut into."""
    (along, across), (length, width, height) = cells_of(box), box.size
    a, b = length / along, width / across
    x, y, z = box.position
    factor = own_inertia_factor(vehicle, box)
    return Columns(
        corner=(x - 0.5 * (length - a), y - 0.5 * (width - b), z),
        spacing=(a, b),
        reach_squares=(factor * a * a, factor * b * b, height * height),
        weight=vehicle.specific_weight * a * b * height,
    )


def natural_frequencies(vehicle: Vehicle, kind: str) -> Array:
    """Return the undamped natural angular frequencies [rad/s] of what `hydrostatic_terms` returns.

    Of roll and pitch, shape (2,), or with heave, shape (3,), of a vessel that floats or has a hull: at rest, upright.
    """
    if kind == "hull":
        return floating_modes(vehicle, hull_stiffness(vehicle)).frequencies
    return restoring_frequencies(vehicle)


def restoring_terms(excess_weight: float, arm: Array) -> tuple[ForceTerm, ...]:
    """Return the restoring forces that are present.

    Args:
        excess_weight: W - B [N].
        arm: W r_G - B r_B [N m], shape (3,).
    """
    terms: list[ForceTerm] = []
    if excess_weight != 0.0:
        weight = NetWeight(excess_weight)
        terms.append(ForceTerm("net weight", net_weight, weight, potential=net_weight_potential))
    if arm.any():
        moment = RightingMoment(vector3(arm))
        terms.append(ForceTerm("righting moment", righting_moment, moment, potential=righting_potential))
    return tuple(terms)
