"""Checks of a vehicle's damping: that it takes energy, is said once, and fits the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dq_marine.physics.implausible import Implausible, check_water_density

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle

STRIP_REACH = 1.5  # strips lie within this many overall lengths of the origin


def check_damping(vehicle: Vehicle) -> None:
    """Check a vehicle whose fields are each valid on their own.

    Raises:
        Implausible: for the first contradiction found.
    """
    _check_dissipative(vehicle)
    _check_couplings(vehicle)
    _check_cross_flow(vehicle)
    _check_blended(vehicle)


def _check_dissipative(vehicle: Vehicle) -> None:
    linear = vehicle.linear_damping
    smallest = float(np.linalg.eigvalsh(0.5 * (linear + linear.T)).min())
    if smallest < -1e-9 * float(np.abs(linear).max()):
        raise Implausible(
            "damping.linear",
            f"smallest eigenvalue of its symmetric part = {smallest:.4g}",
            "the linear damping feeds energy in",
            "write damping positive: minus the derivatives X_u, Y_v, ...",
        )


def _check_couplings(vehicle: Vehicle) -> None:
    seen: set[tuple[tuple[int, int, int], bool]] = set()
    for number, coupling in enumerate(vehicle.damping.couplings):
        field, indices = f"damping.couplings.{number}", coupling.indices
        named = coupling.name
        if (indices, coupling.signed) in seen:
            raise Implausible(field, named, "it is given twice", "write one entry with the sum")
        seen.add((indices, coupling.signed))
        if coupling.signed and coupling.force == coupling.velocity:
            raise Implausible(
                f"{field}.signed",
                named,
                f"a force in {coupling.force} along its own velocity that turns over feeds energy in",
                "leave signed out",
            )
        if len(set(indices)) == 1:
            axis = indices[0]
            raise Implausible(
                field, named, "this is damping in one axis", f"write it into damping.quadratic[{axis}]"
            )
        if coupling.force == coupling.velocity and coupling.coefficient < 0.0:
            raise Implausible(
                f"{field}.coefficient",
                coupling.coefficient,
                f"a force in {coupling.force} along its own velocity feeds energy in",
                "write damping positive: minus the derivatives Y_uv, M_uq, ...",
            )


def _check_cross_flow(vehicle: Vehicle) -> None:
    reach = max(vehicle.dimensions.length, vehicle.dimensions.width, vehicle.dimensions.height)
    for number, drag in enumerate(vehicle.cross_flow):
        field = f"cross_flow.{number}"
        if (drag.drag_coefficient is None) == (drag.beam is None):
            raise Implausible(
                field,
                f"drag_coefficient {drag.drag_coefficient}, beam {drag.beam}",
                "the drag of a strip is given by one of the two",
                "give drag_coefficient, or beam for Hoerner's curve at beam / (2 depth)",
            )
        for part, extent in (("length", drag.length), ("depth", drag.depth)):
            if not 0.001 * reach <= extent <= STRIP_REACH * reach:
                raise Implausible(
                    f"{field}.{part}",
                    extent,
                    f"it does not fit a vehicle {reach:.3g} m long (0.001 to {STRIP_REACH:g} lengths)",
                    "give it in m",
                )
        if drag.water_density is not None:
            check_water_density(f"{field}.water_density", drag.water_density)
        if abs(drag.center) + 0.5 * drag.length > STRIP_REACH * reach:
            raise Implausible(
                f"{field}.center",
                drag.center,
                f"strips reach more than {STRIP_REACH:g} lengths of the vehicle, {reach:.3g} m, from the origin",
                "give it in m from the body origin",
            )


def _check_blended(vehicle: Vehicle) -> None:
    seen: set[str] = set()
    for number, blended in enumerate(vehicle.damping.blended):
        field = f"damping.blended.{number}"
        if blended.axis in seen:
            raise Implausible(
                f"{field}.axis", blended.axis, "it is given twice", "write one entry for each axis"
            )
        seen.add(blended.axis)
        if blended.linear == blended.quadratic == 0.0:
            raise Implausible(
                field, f"linear 0, quadratic 0 in {blended.axis}", "it does nothing", "leave it out"
            )
        fall = blended.falls_at()
        if fall is not None:
            raise Implausible(
                field,
                f"linear {blended.linear:g}, quadratic {blended.quadratic:g}, crossover {blended.crossover:g}",
                f"the resistance in surge falls as the speed grows beyond {fall:.3g} m/s: there is more at rest than "
                "under way",
                "give a smaller linear damping, a larger quadratic one, or leave the linear one out",
            )
