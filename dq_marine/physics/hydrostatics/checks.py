"""Checks of what makes a vessel float: stiffness, weight against buoyancy, hull and payloads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dq_marine.physics.hydrostatics.flotation import hull_at_rest
from dq_marine.physics.implausible import Implausible

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle

SYMMETRY_TOLERANCE = 1e-6
WEIGHT_TOLERANCE = 0.03  # weight against buoyancy of a vessel at rest
VOLUME_TOLERANCE = 0.05  # what the boxes of the hull displace at rest against the volume
WATERPLANE_LIMIT = 2.0  # largest waterplane over length x width


def check_floating(vehicle: Vehicle) -> None:
    """Check what a vehicle says of floating, if it does.

    Raises:
        Implausible: for the first contradiction found.
    """
    _check_weight(vehicle)
    _check_stiffness(vehicle)
    _check_waterplane(vehicle)
    _check_hull(vehicle)
    _check_payloads(vehicle)
    _check_draft(vehicle)


def _check_weight(vehicle: Vehicle) -> None:
    if vehicle.hydrostatics is None:
        return
    ratio = vehicle.weight / vehicle.buoyant_force
    if abs(ratio - 1.0) > WEIGHT_TOLERANCE:
        raise Implausible(
            "buoyancy.volume",
            f"{vehicle.buoyancy.volume:.6g} m^3",
            f"the vessel floats, but its weight is {ratio:.4g} times the weight of that much water, which differs by "
            f"more than {WEIGHT_TOLERANCE:.0%}",
            "give the volume under water at rest, mass over water_density",
        )


def _check_stiffness(vehicle: Vehicle) -> None:
    stiffness = vehicle.waterplane_stiffness
    if stiffness is None:
        return
    skewness = float(np.abs(stiffness - stiffness.T).max())
    if skewness > SYMMETRY_TOLERANCE * float(np.abs(stiffness).max()):
        raise Implausible(
            "hydrostatics.stiffness",
            f"entries that differ by {skewness:.4g}",
            "the matrix is not symmetric",
            "give the rows and columns heave, roll, pitch of the restoring matrix",
        )
    smallest = float(np.linalg.eigvalsh(stiffness).min())
    if smallest <= 0.0:
        raise Implausible(
            "hydrostatics",
            f"smallest eigenvalue of the stiffness = {smallest:.4g}",
            "the vessel does not right itself",
            'check the metacentric heights; one that capsizes has [[hull]] instead, for Scene(hydrostatics="hull")',
        )


def _check_waterplane(vehicle: Vehicle) -> None:
    stiffness = vehicle.waterplane_stiffness
    if stiffness is None:
        return
    area = float(stiffness[0, 0]) / vehicle.specific_weight
    largest = WATERPLANE_LIMIT * vehicle.dimensions.length * vehicle.dimensions.width
    if area > largest:
        raise Implausible(
            "hydrostatics",
            f"a waterplane of {area:.4g} m^2",
            f"it is more than {WATERPLANE_LIMIT:g} times length x width, {largest:.4g} m^2",
            "give the area in m^2, or the stiffness in heave in N/m",
        )


def _check_hull(vehicle: Vehicle) -> None:
    if not vehicle.hull:
        return
    volume = hull_at_rest(vehicle).volume
    if abs(volume / vehicle.buoyancy.volume - 1.0) > VOLUME_TOLERANCE:
        raise Implausible(
            "hull",
            f"{volume:.6g} m^3 of boxes {'under water at rest' if vehicle.hydrostatics else 'in all'}",
            f"it differs from buoyancy.volume = {vehicle.buoyancy.volume:.6g} m^3 by more than {VOLUME_TOLERANCE:.0%}",
            "check position and size of the boxes, in m, with z down from the body origin",
        )


def _check_payloads(vehicle: Vehicle) -> None:
    reach = max(vehicle.dimensions.length, vehicle.dimensions.width, vehicle.dimensions.height)
    for number, payload in enumerate(vehicle.payloads):
        if payload.mass > vehicle.rigid_body.mass:
            raise Implausible(
                f"payloads.{number}.mass",
                f"{payload.mass:.6g} kg",
                f"it is more than the vehicle's own, {vehicle.rigid_body.mass:.6g} kg",
                "give it in kg; a payload's mass is part of rigid_body.mass",
            )
        if float(np.linalg.norm(payload.position)) > reach:
            raise Implausible(
                f"payloads.{number}.position",
                payload.position,
                f"it lies {np.linalg.norm(payload.position):.3g} m from the origin of a vehicle {reach:.3g} m long",
                "give positions in m from the body origin",
            )


def _check_draft(vehicle: Vehicle) -> None:
    draft, height = vehicle.dimensions.draft, vehicle.dimensions.height
    if draft is not None and draft >= height:
        raise Implausible(
            "dimensions.draft",
            f"{draft:g} m",
            f"the keel would lie deeper than the height, {height:g} m, allows",
            "give the height from keel to deck, in m",
        )
