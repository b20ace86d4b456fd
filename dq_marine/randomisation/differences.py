"""In what drawn vehicles are not the nominal one: factors and shifts of the numbers that a randomisation draws."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

LARGEST_DIFFERENCE = 100.0
"""Bound of factors, and of shifts [m]: a net that is told of more learns nothing from it."""

ROUND_OFF = 1e-9
"""Up to which vehicles count as alike in a number."""

Numbers = Callable[[Vehicle], Sequence[float] | Array]


class Difference(NamedTuple):
    """One kind of number, of one vehicle beside another.

    Attributes:
        name: in snake case.
        unit: "" for factors.
        meaning: one line for people.
        between: (drawn vehicle, nominal vehicle) -> numbers, shape (k,).
    """

    name: str
    unit: str
    meaning: str
    between: Callable[[Vehicle, Vehicle], Array]


class Spreading(NamedTuple):
    """A difference that is not the same for all vehicles, and its numbers, shape (vehicles, k)."""

    difference: Difference
    numbers: Array


def differences(vehicles: Sequence[Vehicle], nominal: Vehicle, actuation: str) -> tuple[Spreading, ...]:
    """Return in what vehicles differ from each other, relative to the nominal one.

    Correlations that a randomisation adds between axes are not among the numbers.

    Args:
        vehicles: drawn from the nominal one.
        nominal: the one that factors are 1 of, and shifts 0.
        actuation: "wrench" or "thrusters": which numbers of the actuators count.
    """
    own = WRENCHES if actuation == "wrench" else ACTUATORS
    found = []
    for difference in (*BODIES, *own):
        rows = [difference.between(vehicle, nominal) for vehicle in vehicles]
        numbers = np.clip(np.array(rows), -LARGEST_DIFFERENCE, LARGEST_DIFFERENCE)
        if numbers.size and np.ptp(numbers, axis=0).max() > ROUND_OFF:
            found.append(Spreading(difference, numbers))
    return tuple(found)


def factors(numbers: Numbers) -> Callable[[Vehicle, Vehicle], Array]:
    """Return (drawn, nominal) -> numbers of the one over those of the other, 1 where the other's is 0."""

    def between(drawn: Vehicle, nominal: Vehicle) -> Array:
        own, other = _array(numbers(drawn)), _array(numbers(nominal))
        return np.divide(own, other, out=np.ones_like(own), where=other != 0.0)

    return between


def shifts(numbers: Numbers) -> Callable[[Vehicle, Vehicle], Array]:
    """Return (drawn, nominal) -> numbers of the one less those of the other."""

    def between(drawn: Vehicle, nominal: Vehicle) -> Array:
        return _array(numbers(drawn)) - _array(numbers(nominal))

    return between


def _array(numbers: Sequence[float] | Array) -> Array:
    return np.asarray(numbers, dtype=np.float64)


def mass(vehicle: Vehicle) -> Sequence[float]:
    """Return the dry mass [kg]."""
    return (vehicle.rigid_body.mass,)


def inertia(vehicle: Vehicle) -> Array:
    """Return the moments of inertia about the body axes [kg m^2], shape (3,)."""
    return np.asarray(np.diag(vehicle.rigid_body_matrix)[3:])


def center_of_mass(vehicle: Vehicle) -> Sequence[float]:
    """Return r_G [m]."""
    return vehicle.rigid_body.center_of_mass


def net_weight(vehicle: Vehicle) -> Sequence[float]:
    """Return (W - B)/W."""
    return (1.0 - vehicle.buoyant_force / vehicle.weight,)


def righting_arm(vehicle: Vehicle) -> Array:
    """Return (W r_G - B r_B)/W [m], shape (3,)."""
    return np.asarray(vehicle.restoring_arm / vehicle.weight)


def stiffness(vehicle: Vehicle) -> Array:
    """Return the stiffness of heave, roll and pitch of a vessel that floats [N/m, N m], shape (3,); else zeros."""
    matrix = vehicle.waterplane_stiffness
    return np.zeros(3) if matrix is None else np.diag(matrix)


def added_mass(vehicle: Vehicle) -> Array:
    """Return the diagonal of M_A [kg, kg m^2], shape (6,)."""
    return np.diag(vehicle.added_mass_matrix)


def linear_damping(vehicle: Vehicle) -> Array:
    """Return the linear damping of each axis [N s/m, N m s], shape (6,), with blends that fade into nothing."""
    numbers = np.diag(vehicle.linear_damping).copy()
    for one in vehicle.damping.blended:
        numbers[one.index] += one.linear if one.quadratic == 0.0 else 0.0
    return numbers


def quadratic_damping(vehicle: Vehicle) -> Array:
    """Return the quadratic damping of each axis, shape (6,), with blends and the drag coefficients of strips.

    What is summed up of an axis is drawn by one factor, so that the sum has it, too, whatever its units.
    """
    numbers = vehicle.quadratic_damping.copy()
    for one in vehicle.damping.blended:
        numbers[one.index] += one.quadratic
    for strips in vehicle.cross_flow:
        numbers[1 if strips.plane == "sway" else 2] += strips.section_drag
    return numbers


def wrench_limits(vehicle: Vehicle) -> Array:
    """Return the wrench at full action [N, N m], shape (6,)."""
    return vehicle.wrench_limits


def thrust(vehicle: Vehicle) -> Sequence[float]:
    """Return what each propeller gives, ahead and astern together, those of azimuths last."""
    actuators = vehicle.actuators
    return [sum(one.gains) for one in (*actuators.thrusters, *actuators.azimuths)]


def fin_force(vehicle: Vehicle) -> Sequence[float]:
    """Return the magnitude of each fin's coefficients."""
    return [float(np.linalg.norm(one.coefficients)) for one in vehicle.actuators.fins]


OVER_NOMINAL = "over the nominal"

BODIES = (
    Difference("mass_factor", "", f"dry mass, {OVER_NOMINAL} one", factors(mass)),
    Difference("inertia_factors", "", f"moments of inertia, {OVER_NOMINAL} ones", factors(inertia)),
    Difference("center_of_mass_shift", "m", "centre of mass, less the nominal one", shifts(center_of_mass)),
    Difference("net_weight_shift", "", "(W - B)/W, less the nominal", shifts(net_weight)),
    Difference("righting_arm_shift", "m", "(W r_G - B r_B)/W, less the nominal", shifts(righting_arm)),
    Difference(
        "stiffness_factors",
        "",
        f"stiffness of heave, roll and pitch afloat, {OVER_NOMINAL}",
        factors(stiffness),
    ),
    Difference("added_mass_factors", "", f"added mass of each axis, {OVER_NOMINAL}", factors(added_mass)),
    Difference(
        "linear_damping_factors", "", f"linear damping of each axis, {OVER_NOMINAL}", factors(linear_damping)
    ),
    Difference(
        "quadratic_damping_factors",
        "",
        f"quadratic damping of each axis, {OVER_NOMINAL}",
        factors(quadratic_damping),
    ),
)
"""Of the body and the water around it."""

WRENCHES = (
    Difference("wrench_factors", "", f"wrench at full action, {OVER_NOMINAL}", factors(wrench_limits)),
)
"""Of vehicles that are driven by a wrench."""

ACTUATORS = (
    Difference("thrust_factors", "", f"thrust of each propeller, {OVER_NOMINAL}", factors(thrust)),
    Difference("fin_factors", "", f"force of each fin, {OVER_NOMINAL}", factors(fin_force)),
)
"""Of vehicles that are driven by their actuators."""
