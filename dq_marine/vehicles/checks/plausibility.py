"""Checks across the fields of a vehicle: physics that must hold, and magnitudes that betray a wrong unit.

Each check raises `Implausible` with the field, the value, the limit and the remedy.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.abkowitz.checks import check_whole_ship
from dq_marine.physics.damping.checks import check_damping
from dq_marine.physics.hydrostatics.checks import check_floating
from dq_marine.physics.implausible import Implausible as Implausible
from dq_marine.physics.implausible import check_gravity, check_water_density
from dq_marine.physics.manoeuvring.checks import check_manoeuvring
from dq_marine.vehicles.coupling import asymmetry

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle

SYMMETRY_TOLERANCE = 1e-6
DENSITY_RANGE = (0.05, 25.0)  # mean density over that of water
ADDED_MASS_LIMIT = 50.0  # largest added over rigid-body mass, seen along a flat plate's normal
ACCELERATION_LIMIT = 500.0  # largest force over mass [m/s^2]
BOX_FILL_RANGE = (0.002, 3.0)  # displaced volume over length x width x height
TRIANGLE_TOLERANCE = 0.02  # of the largest moment: published ships have rounded radii of gyration
REACH = 1.0  # centres lie within this many overall lengths of the origin


def check_vehicle(vehicle: Vehicle) -> None:
    """Check a vehicle whose fields are each valid on their own.

    Raises:
        Implausible: for the first contradiction found.
    """
    check_gravity("gravity", vehicle.gravity)
    _check_inertia_symmetry(vehicle)
    _check_added_mass_sign(vehicle)
    _check_density(vehicle)
    _check_dimensions(vehicle)
    _check_rigid_inertia(vehicle)
    _check_added_mass_symmetry(vehicle)
    _check_mass_matrix(vehicle)
    check_damping(vehicle)
    _check_added_mass_size(vehicle)
    _check_limits(vehicle)
    _check_thrusters(vehicle)
    check_floating(vehicle)
    check_whole_ship(vehicle)
    check_manoeuvring(vehicle)
    _check_actuator_size(vehicle)


def _check_inertia_symmetry(vehicle: Vehicle) -> None:
    inertia = np.array(vehicle.rigid_body.inertia)
    skewness = np.abs(inertia - inertia.T)
    largest = float(np.abs(inertia).max())
    if skewness.max() > SYMMETRY_TOLERANCE * largest:
        i, j = np.unravel_index(int(skewness.argmax()), inertia.shape)
        raise Implausible(
            "rigid_body.inertia",
            _pair(inertia, int(i), int(j)),
            f"the matrix is not symmetric: entries differ by {skewness.max():.3g}, more than "
            f"{SYMMETRY_TOLERANCE:g} of the largest, {largest:.4g}",
            "check the products of inertia",
        )


def _check_added_mass_symmetry(vehicle: Vehicle) -> None:
    added = np.array(vehicle.added_mass)
    value, i, j = asymmetry(added, vehicle.mass_matrix)
    limit = max(SYMMETRY_TOLERANCE, vehicle.added_mass_asymmetry)
    if value > limit:
        raise Implausible(
            "added_mass",
            _pair(added, i, j),
            f"the matrix is not symmetric: these differ by {value:.2g} of sqrt(M_{i}{i} M_{j}{j}), more than {limit:g}",
            "check the signs of the off-diagonal entries, or write the symmetric part (M + M^T)/2; if it was published "
            f"like this, say so with added_mass_asymmetry = {_rounded_up(value):g}, and the symmetric part is taken",
        )


def _pair(matrix: NDArray[np.float64], i: int, j: int) -> str:
    return f"[{i}][{j}] = {matrix[i, j]:.6g}, [{j}][{i}] = {matrix[j, i]:.6g}"


def _rounded_up(value: float) -> float:
    """Return the next larger number of two digits."""
    if not math.isfinite(value):
        return value
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / unit) * unit


def _check_added_mass_sign(vehicle: Vehicle) -> None:
    diagonal = np.diag(np.array(vehicle.added_mass))
    if diagonal.min() < 0.0:
        i = int(diagonal.argmin())
        raise Implausible(
            "added_mass",
            f"[{i}][{i}] = {diagonal[i]:.6g}",
            "a diagonal entry of the added mass is negative",
            "published hydrodynamic derivatives (X_udot, Y_vdot, ...) are negative; write minus them",
        )


def _check_rigid_inertia(vehicle: Vehicle) -> None:
    body = vehicle.rigid_body
    mass, center = body.mass, np.array(body.center_of_mass)
    about_com = np.array(body.inertia)
    if body.inertia_about == "body_origin":
        about_com = about_com - mass * (center @ center * np.eye(3) - np.outer(center, center))
    moments = np.linalg.eigvalsh(about_com)
    if moments[0] <= 0.0 or moments[0] + moments[1] < moments[2] * (1.0 - TRIANGLE_TOLERANCE):
        raise Implausible(
            "rigid_body.inertia",
            [float(f"{m:.6g}") for m in moments],
            "the principal moments about the centre of mass are not those of a body: each must be positive and "
            "at most the sum of the other two",
            "check products of inertia, center_of_mass and inertia_about",
        )
    longest = max(vehicle.dimensions.length, vehicle.dimensions.width, vehicle.dimensions.height)
    radius = float(np.sqrt(moments[2] / mass))
    if not 0.02 * longest <= radius <= longest:
        raise Implausible(
            "rigid_body.inertia",
            f"{moments[2]:.6g} kg m^2",
            f"its radius of gyration, {radius:.3g} m, does not fit a vehicle {longest:.3g} m long (0.02 to 1 "
            "lengths)",
            "give the inertia in kg m^2 and the dimensions in m",
        )


def _check_mass_matrix(vehicle: Vehicle) -> None:
    smallest = float(np.linalg.eigvalsh(vehicle.mass_matrix).min())
    if smallest <= 0.0:
        raise Implausible(
            "added_mass",
            f"smallest eigenvalue of M_RB + M_A = {smallest:.4g}",
            "the mass matrix is not positive definite",
            "check the signs and the reference point of the off-diagonal entries",
        )


def _check_density(vehicle: Vehicle) -> None:
    ratio = vehicle.rigid_body.mass / (vehicle.buoyancy.volume * vehicle.buoyancy.water_density)
    low, high = DENSITY_RANGE
    if not low <= ratio <= high:
        raise Implausible(
            "rigid_body.mass",
            f"{vehicle.rigid_body.mass:.6g} kg in {vehicle.buoyancy.volume:.6g} m^3",
            f"the mean density is {ratio:.3g} times that of the water, outside {low:g} to {high:g}",
            "give the mass in kg, the volume in m^3 and the water density in kg/m^3",
        )
    check_water_density("buoyancy.water_density", vehicle.buoyancy.water_density)


def _check_dimensions(vehicle: Vehicle) -> None:
    size = vehicle.dimensions
    fill = vehicle.buoyancy.volume / (size.length * size.width * size.height)
    low, high = BOX_FILL_RANGE
    if not low <= fill <= high:
        raise Implausible(
            "dimensions",
            f"{size.length:g} x {size.width:g} x {size.height:g} m",
            f"the displaced volume is {fill:.3g} times this box, outside {low:g} to {high:g}",
            "give lengths in m and the volume in m^3",
        )
    reach = REACH * max(size.length, size.width, size.height)
    for field, center in (
        ("rigid_body.center_of_mass", vehicle.rigid_body.center_of_mass),
        ("buoyancy.center", vehicle.buoyancy.center),
    ):
        if float(np.linalg.norm(center)) > reach:
            raise Implausible(
                field,
                center,
                f"it lies {np.linalg.norm(center):.3g} m from the origin of a vehicle {reach:.3g} m long",
                "give positions in m from the body origin",
            )


def _check_added_mass_size(vehicle: Vehicle) -> None:
    added = np.diag(np.array(vehicle.added_mass))
    rigid = np.diag(vehicle.rigid_body_matrix)
    ratio = added / rigid
    if ratio.max() > ADDED_MASS_LIMIT:
        i = int(ratio.argmax())
        raise Implausible(
            "added_mass",
            f"[{i}][{i}] = {added[i]:.6g}",
            f"it is {ratio[i]:.3g} times the rigid body's {rigid[i]:.4g}, more than {ADDED_MASS_LIMIT:g}",
            "give added mass in kg, kg m and kg m^2, not as dimensionless derivatives",
        )


def _check_limits(vehicle: Vehicle) -> None:
    limits = np.array(vehicle.limits.wrench)
    if limits.max() == 0.0:
        raise Implausible(
            "limits.wrench",
            vehicle.limits.wrench,
            "no axis is actuated",
            "give at least one axis a force or moment",
        )
    reach = max(vehicle.dimensions.length, vehicle.dimensions.width, vehicle.dimensions.height)
    largest = ACCELERATION_LIMIT * vehicle.rigid_body.mass
    bounds = np.array([largest] * 3 + [largest * reach] * 3)
    if (limits > bounds).any():
        i = int((limits / bounds).argmax())
        raise Implausible(
            "limits.wrench",
            f"[{i}] = {limits[i]:.6g}",
            f"it would accelerate the vehicle's {vehicle.rigid_body.mass:.4g} kg beyond "
            f"{ACCELERATION_LIMIT:g} m/s^2",
            "give forces in N and moments in N m",
        )


def _check_thrusters(vehicle: Vehicle) -> None:
    for i, thruster in enumerate(vehicle.thrusters):
        if not any(thruster.direction):
            raise Implausible(
                f"thrusters.{i}.direction",
                thruster.direction,
                "the direction is the zero vector",
                "give the direction of the force at positive thrust",
            )
    known = [thruster.driven for thruster in vehicle.thrusters]
    if any(known) and not all(known):
        raise Implausible(
            f"thrusters.{known.index(False)}",
            vehicle.thrusters[known.index(False)].name or "one without thrust",
            "its thrust is missing, though others have theirs",
            "give thrust_forward and thrust_reverse, or gains and speeds, for all thrusters or for none",
        )


def _check_actuator_size(vehicle: Vehicle) -> None:
    """Thrust and distance of each actuator, by the same measure as the limits."""
    reach = REACH * max(vehicle.dimensions.length, vehicle.dimensions.width, vehicle.dimensions.height)
    largest = ACCELERATION_LIMIT * vehicle.rigid_body.mass
    for field in ("thrusters", "azimuths"):
        for i, propulsion in enumerate(getattr(vehicle, field)):
            distance = float(np.linalg.norm(propulsion.position))
            if distance > reach:
                raise Implausible(
                    f"{field}.{i}.position",
                    propulsion.position,
                    f"it lies {distance:.3g} m from the origin of a vehicle {reach:.3g} m long",
                    "give positions in m from the body origin",
                )
            thrust = max(map(abs, propulsion.thrust_range))
            if thrust > largest:
                raise Implausible(
                    f"{field}.{i}",
                    f"thrust of up to {thrust:.6g} N",
                    f"it would accelerate the vehicle's {vehicle.rigid_body.mass:.4g} kg beyond "
                    f"{ACCELERATION_LIMIT:g} m/s^2",
                    "give thrust in N, gains in N s^2 and speeds in rad/s",
                )
