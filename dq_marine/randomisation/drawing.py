"""A vehicle's numbers, varied: one function for each table of a vehicle file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.randomisation.congruence import (
    drawn_coupling,
    moments_of_inertia,
    scaled_and_coupled,
    second_moments,
)
from dq_marine.randomisation.distributions import AnyDistribution, drawn, drawn_for_each
from dq_marine.randomisation.tables import (
    ActuatorsDraw,
    AddedMassDraw,
    BuoyancyDraw,
    DampingDraw,
    RigidBodyDraw,
)
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.model import RigidBody

Array = NDArray[np.float64]
Each = AnyDistribution | tuple[AnyDistribution, ...] | None
Content = dict[str, Any]

THRUST = ("thrust_forward", "thrust_reverse", "gain_forward", "gain_reverse")
"""What a propeller delivers, in a vehicle's file."""

NOTHING = 1e-6
"""Factor of what a propeller delivers that failed: it stays one, so that the vehicles of a pool are alike."""


def varied_rigid_body(draw: RigidBodyDraw, body: RigidBody, rng: np.random.Generator) -> Content:
    """Return the table of another body: heavier or lighter, its mass distributed otherwise."""
    if draw == RigidBodyDraw():
        return body.model_dump()
    mass = body.mass * _factor(draw.mass, rng)
    about_center = np.array(body.inertia) - _carried_inertia(body, body.mass, np.array(body.center_of_mass))
    moments = second_moments(about_center)
    if draw.inertia is None:
        moments = moments * (mass / body.mass)
    coupling = drawn_coupling(draw.inertia_coupling, 3, rng)
    moments = scaled_and_coupled(moments, _factors(draw.inertia, 3, rng), coupling, np.sqrt(np.diag(moments)))
    center = np.array(body.center_of_mass) + _offsets(draw.center_of_mass, rng)
    inertia = moments_of_inertia(moments) + _carried_inertia(body, mass, center)
    changed = {"mass": mass, "center_of_mass": center.tolist(), "inertia": inertia.tolist()}
    return body.model_dump() | changed


def varied_buoyancy(
    draw: BuoyancyDraw, vehicle: Vehicle, rigid_body: Content, rng: np.random.Generator
) -> Content:
    """Return the tables of other displaced water, for a body that is varied already."""
    if vehicle.hydrostatics is not None:
        return varied_flotation(draw, vehicle, rigid_body, rng)
    growth = rigid_body["mass"] / vehicle.rigid_body.mass
    volume = vehicle.buoyancy.volume * _factor(draw.volume, rng)
    if draw.net_weight is not None:
        # (W' - B')/W' = (W - B)/W + share, with W' and B' in the ratios of mass and of volume
        share = drawn(draw.net_weight, rng)
        volume *= growth * (1.0 - share * vehicle.weight / vehicle.buoyant_force)
    if draw.places_center:
        # arm' = W' r_G' - B' r_B', solved for r_B'
        arm = growth * _factor(draw.righting_lever, rng) * _rest_rotation(draw, rng) @ vehicle.restoring_arm
        buoyant_force = vehicle.buoyant_force * volume / vehicle.buoyancy.volume
        moment = vehicle.weight * growth * np.array(rigid_body["center_of_mass"])
        center = (moment - arm) / buoyant_force
    else:
        center = np.array(vehicle.buoyancy.center) + _offsets(draw.center, rng)
    return {
        "buoyancy": vehicle.buoyancy.model_dump() | {"volume": volume, "center": center.tolist()},
        "hull": _widened_hull(vehicle, volume / vehicle.buoyancy.volume),
    }


def varied_flotation(
    draw: BuoyancyDraw, vehicle: Vehicle, rigid_body: Content, rng: np.random.Generator
) -> Content:
    """Return the tables of another vessel that floats: as much wider as heavier, level, with other metacentric heights.

    It displaces its weight and its stiffness is given, so net weight, volume, centre, list and trim do not apply.
    """
    growth = rigid_body["mass"] / vehicle.rigid_body.mass
    righting = _factor(draw.righting_lever, rng)
    hydrostatics = vehicle.model_dump(include={"hydrostatics"})["hydrostatics"]
    if hydrostatics["stiffness"] is None:
        for name in ("metacentric_height_transverse", "metacentric_height_longitudinal"):
            hydrostatics[name] *= righting
    else:
        scale = np.sqrt([1.0, righting, righting])
        hydrostatics["stiffness"] = (np.array(hydrostatics["stiffness"]) * np.outer(scale, scale)).tolist()
    buoyancy = vehicle.buoyancy.model_dump() | {"volume": growth * vehicle.buoyancy.volume}
    return {"buoyancy": buoyancy, "hydrostatics": hydrostatics, "hull": _widened_hull(vehicle, growth)}


def varied_added_mass(draw: AddedMassDraw, vehicle: Vehicle, rng: np.random.Generator) -> Content:
    """Return the entries of another added mass: its symmetric part, by a congruence."""
    if draw == AddedMassDraw():
        return {}
    scale = np.sqrt(np.diag(vehicle.mass_matrix))
    coupling = drawn_coupling(draw.coupling, 6, rng)
    varied = scaled_and_coupled(vehicle.added_mass_matrix, _factors(draw.factor, 6, rng), coupling, scale)
    return {"added_mass": (0.5 * (varied + varied.T)).tolist(), "added_mass_asymmetry": 0.0}


def varied_damping(draw: DampingDraw, vehicle: Vehicle, rng: np.random.Generator) -> Content:
    """Return the tables of other damping and cross-flow drag, which take energy as the vehicle's own do."""
    changed: Content = {}
    blended = [one.model_dump() for one in vehicle.damping.blended]
    # A blend is drawn as a whole: its two parts apart could make resistance that falls as the speed grows.
    if draw.linear is not None or draw.linear_coupling > 0.0:
        linear = vehicle.linear_damping
        # What damps an axis that has no linear damping is said elsewhere in the file, and is not added to.
        scale = np.sqrt(np.diag(vehicle.mass_matrix)) * (linear.any(axis=0) | linear.any(axis=1))
        coupling = drawn_coupling(draw.linear_coupling, 6, rng)
        factors = _factors(draw.linear, 6, rng)
        changed["linear"] = scaled_and_coupled(linear, factors, coupling, scale).tolist()
        for one, own in zip(blended, vehicle.damping.blended, strict=True):
            if own.quadratic == 0.0:
                one["linear"] *= factors[own.index]
    cross_flow = [strips.model_dump() for strips in vehicle.cross_flow]
    if draw.quadratic is not None:
        factors = _factors(draw.quadratic, 6, rng)
        changed["quadratic"] = (vehicle.quadratic_damping * factors).tolist()
        changed["couplings"] = [
            # |nu_k| Q_k becomes |nu_k| S Q_k S: a congruence, as that of the linear part
            coupling.model_dump()
            | {"coefficient": coupling.coefficient * _root(factors, *coupling.indices[:2])}
            for coupling in vehicle.damping.couplings
        ]
        for one, own in zip(blended, vehicle.damping.blended, strict=True):
            if own.quadratic > 0.0:
                one["linear"] *= factors[own.index]
                one["quadratic"] *= factors[own.index]
        for strips, drag in zip(cross_flow, vehicle.cross_flow, strict=True):
            across = factors[1 if drag.plane == "sway" else 2]
            strips |= {"drag_coefficient": drag.section_drag * across, "beam": None}
    changed["blended"] = blended
    return {"damping": vehicle.damping.model_dump() | changed, "cross_flow": cross_flow}


def check_lost(draw: ActuatorsDraw, vehicle: Vehicle) -> None:
    """Check that a vehicle has a propeller left.

    Raises:
        InvalidInputError: it loses all that it has.
    """
    propellers = len(vehicle.thrusters) + len(vehicle.azimuths)
    if draw.lost and draw.lost >= propellers:
        raise InvalidInputError(
            f"actuators.lost = {draw.lost}, and {vehicle.name} has {propellers} to lose; give a vehicle with more "
            "propellers, or lose fewer"
        )


def varied_actuators(draw: ActuatorsDraw, vehicle: Vehicle, rng: np.random.Generator) -> Content:
    """Return the tables of stronger or weaker actuators; an axis that is not actuated stays so."""
    limits = vehicle.limits.model_dump()
    if draw.wrench is not None:
        limits["wrench"] = (vehicle.wrench_limits * _factors(draw.wrench, 6, rng)).tolist()
    tables = vehicle.model_dump(include={"thrusters", "azimuths", "fins"})
    propellers = [*tables["thrusters"], *tables["azimuths"]]
    if draw.thrust is not None:
        for propeller in propellers:
            _scale(propeller, THRUST, drawn(draw.thrust, rng))
    if draw.fins is not None:
        for fin in tables["fins"]:
            fin["coefficients"] = (np.array(fin["coefficients"]) * drawn(draw.fins, rng)).tolist()
    if draw.lost:
        for index in rng.choice(len(propellers), draw.lost, replace=False):
            _scale(propellers[index], (*THRUST, "inflow"), NOTHING)
    return tables | {"limits": limits}


def _scale(table: Content, names: tuple[str, ...], factor: float) -> None:
    for name in names:
        if table.get(name) is not None:
            table[name] *= factor


def _root(factors: Array, row: int, column: int) -> float:
    return math.sqrt(factors[row] * factors[column])


def _widened_hull(vehicle: Vehicle, growth: float) -> list[Content]:
    """Return the boxes of a hull, as much wider as they are to displace more."""
    boxes = [box.model_dump() for box in vehicle.hull]
    for box in boxes:
        length, width, height = box["size"]
        box["size"] = (length, growth * width, height)
    return boxes


def _rest_rotation(draw: BuoyancyDraw, rng: np.random.Generator) -> Array:
    """Return what turns "down" of an upright body into that of one with the drawn list and trim, shape (3, 3).

    Both seen from the body: the transpose of R_y(trim) R_x(list), body to level.
    """
    roll, pitch = (
        0.0 if angle is None else math.radians(drawn(angle, rng))
        for angle in (draw.list_angle, draw.trim_angle)
    )
    across, ahead = (math.cos(roll), math.sin(roll)), (math.cos(pitch), math.sin(pitch))
    turn_x = np.array([[1.0, 0.0, 0.0], [0.0, across[0], -across[1]], [0.0, across[1], across[0]]])
    turn_y = np.array([[ahead[0], 0.0, ahead[1]], [0.0, 1.0, 0.0], [-ahead[1], 0.0, ahead[0]]])
    return np.asarray((turn_y @ turn_x).T)


def _carried_inertia(body: RigidBody, mass: float, center: Array) -> Array:
    """Return what a mass at its centre adds to the inertia as the body's table has it, shape (3, 3)."""
    if body.inertia_about == "center_of_mass":
        return np.zeros((3, 3))
    return np.asarray(mass * (center @ center * np.eye(3) - np.outer(center, center)))


def _factor(distribution: AnyDistribution | None, rng: np.random.Generator) -> float:
    return 1.0 if distribution is None else drawn(distribution, rng)


def _factors(distributions: Each, size: int, rng: np.random.Generator) -> Array:
    return np.ones(size) if distributions is None else drawn_for_each(distributions, size, rng)


def _offsets(distributions: Each, rng: np.random.Generator) -> Array:
    return np.zeros(3) if distributions is None else drawn_for_each(distributions, 3, rng)
