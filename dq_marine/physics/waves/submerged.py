"""How waves take hold of a hull below the surface: from the vehicle's numbers to those of the formulas."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.matrices import matrix3, skew, vector3
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.formulas.drag import WaveDrag, wave_drag_in_deep_water, wave_drag_over_bottom
from dq_marine.physics.waves.formulas.kinematics import (
    SubmergedHull,
    SubmergedWaves,
    submerged_waves_in_deep_water,
    submerged_waves_over_bottom,
)
from dq_marine.physics.waves.sea import Sea, table

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SHORT_HULL = 0.05
"""Phase of the waves over half a hull [rad] below which it counts as a point."""

MOST_STATIONS = 12

COUNTED_ENERGY = 0.95
"""Share of a sea's energy whose waves decide how finely a hull is cut."""


def submerged_terms(sea: Sea, vehicle: Vehicle) -> tuple[ForceTerm, ...]:
    """Return the forces of waves on a submerged vehicle, with drag where it has quadratic damping."""
    quadratic = vehicle.quadratic_damping[:3]
    if not quadratic.any():
        return (submerged_wave_term(sea, vehicle),)
    drag = wave_drag_in_deep_water if sea.depth is None else wave_drag_over_bottom
    parameters = WaveDrag(sea.field, vector3(np.array(vehicle.buoyancy.center)), vector3(quadratic))
    return (
        submerged_wave_term(sea, vehicle),
        ForceTerm("drag in waves", drag, parameters, uses_velocity=True),
    )


def submerged_wave_term(sea: Sea, vehicle: Vehicle) -> ForceTerm:
    """Return the first-order wave force on a submerged vehicle, in the long-wave approximation.

    Froude-Krylov force and diffraction are (rho V E + M_A) times the water's acceleration, and linear damping acts on
    the velocity through the water that the waves move. The hull is cut into stations along its length, over which
    volume, added mass and damping are spread evenly: waves as short as the hull are averaged along it, but not across
    it. Good for waves longer than some five times the hull's width and height, and for hulls that stay submerged.
    """
    mass = vehicle.buoyancy.water_density * vehicle.buoyancy.volume
    added = vehicle.added_mass_matrix
    damping = vehicle.damping_at_rest
    centre = np.array(vehicle.buoyancy.center)
    places, shares = stations(sea, vehicle.dimensions.length)
    hull = SubmergedHull(
        centre=vector3(centre),
        force_by_acceleration=matrix3(mass * np.eye(3) + added[:3, :3]),
        moment_by_acceleration=matrix3(mass * skew(centre) + added[3:, :3]),
        force_by_velocity=matrix3(damping[:3, :3]),
        moment_by_velocity=matrix3(damping[3:, :3]),
        places=table(places),
        shares=table(shares),
    )
    force = submerged_waves_in_deep_water if sea.depth is None else submerged_waves_over_bottom
    return ForceTerm("waves", force, SubmergedWaves(sea.field, hull))


def stations(sea: Sea, length: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the places [m] along a hull of a length [m], from its middle, and their shares: Gauss's quadrature.

    As many as the sea's waves need: n for a phase of up to n - 1 over half the hull.
    """
    counted = min(len(sea.wave_numbers) - 1, int(COUNTED_ENERGY * len(sea.wave_numbers)))
    half_phase = 0.5 * length * float(sea.wave_numbers[counted])
    count = 1 if half_phase < SHORT_HULL else min(MOST_STATIONS, 1 + math.ceil(half_phase))
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * length * nodes, 0.5 * weights
