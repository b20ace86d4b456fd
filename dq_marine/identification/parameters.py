"""What can be identified of a vehicle, as free numbers theta, 0 for the vehicle as its file has it.

Whatever theta is, the vehicle is physical: added mass and linear damping change by congruences S A S, or by their
Cholesky factor, and what must be positive by the exponential of theta.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.identification.hull_polynomials import hull_changed, hull_coefficient, hull_places
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.model import MOTIONS

Array = NDArray[np.float64]
Content = dict[str, Any]

CURRENT = "current"
"""The group of the water's velocity, north and east: no number of the vehicle, see `identification.model`."""

GROUPS = (
    "added_mass",
    "added_mass_full",
    "linear",
    "quadratic",
    "couplings",
    "cross_flow",
    "manoeuvring",
    "gains",
    CURRENT,
)
"""What `--fit` takes."""

DEFAULT_GROUPS = ("added_mass", "linear", "quadratic", "couplings", "cross_flow", "manoeuvring")
"""All that one log can tell at once: gains, masses and damping grow together, unless some are known."""

LARGEST_THETA = 2.3
"""Bound of theta: a factor of 10 to either side, or that many m/s of current."""

FLOOR = 1e-6
"""Of the mass matrix: added to an added mass that is not positive definite before it is factored."""


class Parameter(NamedTuple):
    """One free number.

    Attributes:
        group: it belongs to.
        label: for people.
        place: of what it changes, in its group.
    """

    group: str
    label: str
    place: tuple[int, ...]


class Quantity(NamedTuple):
    """A number of the vehicle that follows from the parameters.

    Attributes:
        label: for people.
        unit: of the value.
        value: in a vehicle.
    """

    label: str
    unit: str
    value: float


def parameters_of(vehicle: Vehicle, groups: Iterable[str]) -> tuple[Parameter, ...]:
    """Return the free numbers of some groups; what is zero in the file stays zero and has none.

    Raises:
        InvalidInputError: a group is unknown, both forms of the added mass are asked for, nothing is left, or the added
            mass has a negative eigenvalue.
    """
    chosen = tuple(dict.fromkeys(groups))
    unknown = [group for group in chosen if group not in GROUPS]
    if unknown or not chosen:
        raise InvalidInputError(f"fit = {','.join(unknown)!r} is unknown; give some of {', '.join(GROUPS)}")
    if {"added_mass", "added_mass_full"} <= set(chosen):
        raise InvalidInputError("fit = added_mass,added_mass_full names two forms of one matrix; give one")
    if {"added_mass", "added_mass_full"} & set(chosen):
        _check_added_mass(vehicle)
    found = tuple(parameter for group in chosen for parameter in _parameters(vehicle, group))
    if not found:
        raise InvalidInputError(
            f"{vehicle.name!r} has nothing of {', '.join(chosen)} to fit: what is zero in its file stays zero; give it "
            "a first estimate there, or fit something else"
        )
    return found


def _check_added_mass(vehicle: Vehicle) -> None:
    smallest = float(np.linalg.eigvalsh(vehicle.added_mass_matrix).min())
    if smallest < -FLOOR * float(np.abs(vehicle.added_mass_matrix).max()):
        raise InvalidInputError(
            f"added_mass of {vehicle.name!r} has an eigenvalue of {smallest:.4g}, so that no scale keeps the mass "
            "matrix positive; mend the file, or fit other groups"
        )


def _parameters(vehicle: Vehicle, group: str) -> list[Parameter]:
    if group == "added_mass":
        return _of_axes(group, "added mass", np.diag(vehicle.added_mass_matrix))
    if group == "added_mass_full":
        pairs = [(i, j) for i in range(6) for j in range(i + 1)]
        return [Parameter(group, f"added mass, {_pair_name(i, j)}", (i, j)) for i, j in pairs]
    if group == "linear":
        return _of_axes(group, "linear damping", np.diag(vehicle.linear_damping))
    if group == "quadratic":
        return _of_axes(group, "quadratic damping", vehicle.quadratic_damping)
    if group == "couplings":
        return [
            Parameter(group, f"coupling, {coupling.name}", (number,))
            for number, coupling in enumerate(vehicle.damping.couplings)
            if coupling.coefficient
        ]
    if group == "cross_flow":
        return [
            Parameter(group, f"cross-flow drag {number}, {drag.plane}", (number,))
            for number, drag in enumerate(vehicle.cross_flow)
            if drag.section_drag
        ]
    if group == "manoeuvring":
        return [Parameter(group, label, place) for label, place in hull_places(vehicle)]
    if group == CURRENT:
        return [
            Parameter(group, f"current, {name}", (place,)) for place, name in enumerate(("north", "east"))
        ]
    return [Parameter(group, f"gain of {name}", (number,)) for number, name in enumerate(_actuators(vehicle))]


def _of_axes(group: str, what: str, diagonal: Array) -> list[Parameter]:
    return [Parameter(group, f"{what}, {MOTIONS[i]}", (int(i),)) for i in np.flatnonzero(diagonal > 0.0)]


def _pair_name(i: int, j: int) -> str:
    return MOTIONS[i] if i == j else f"{MOTIONS[j]} with {MOTIONS[i]}"


def _actuators(vehicle: Vehicle) -> list[str]:
    """Return the names of what has a gain: driven thrusters, azimuths, fins."""
    found = vehicle.actuators
    named = [
        *(("thruster", thruster.name) for thruster in found.thrusters),
        *(("azimuth", azimuth.name) for azimuth in found.azimuths),
        *(("fin", fin.name) for fin in found.fins),
    ]
    return [name or f"{kind} {number}" for number, (kind, name) in enumerate(named)]


def vehicle_with(vehicle: Vehicle, parameters: Iterable[Parameter], theta: Iterable[float]) -> Vehicle:
    """Return the vehicle with its parameters at theta.

    Args:
        vehicle: as its file has it.
        parameters: those that differ, none of the current.
        theta: their values, of the same number.

    Raises:
        ValueError: the numbers leave what a vehicle file may say, such as added mass of 50 times the mass.
    """
    by_group: dict[str, dict[tuple[int, ...], float]] = {}
    for parameter, value in zip(parameters, theta, strict=True):
        by_group.setdefault(parameter.group, {})[parameter.place] = float(value)
    changed: Content = {}
    damping: Content = {}
    for group, values in by_group.items():
        if group in ("added_mass", "added_mass_full"):
            added = _scaled if group == "added_mass" else _refactored
            matrix = added(vehicle.added_mass_matrix, values, vehicle.mass_matrix)
            changed |= {"added_mass": matrix.tolist(), "added_mass_asymmetry": 0.0}
        elif group == "linear":
            damping["linear"] = _scaled(vehicle.linear_damping, values, vehicle.mass_matrix).tolist()
        elif group == "quadratic":
            damping["quadratic"] = (vehicle.quadratic_damping * _factors(values, 6)).tolist()
        elif group == "couplings":
            damping["couplings"] = _couplings(vehicle, values)
        elif group == "cross_flow":
            changed["cross_flow"] = _cross_flow(vehicle, values)
        elif group == "manoeuvring" and vehicle.manoeuvring is not None:
            changed["manoeuvring"] = hull_changed(vehicle.manoeuvring, values)
        else:
            changed |= _actuation(vehicle, values)
    if damping:
        changed["damping"] = vehicle.damping.model_dump() | damping
    return Vehicle.model_validate(dict(vehicle) | changed)


def _factors(values: Mapping[tuple[int, ...], float], size: int) -> Array:
    factors = np.ones(size)
    for (index, *_), theta in values.items():
        factors[index] = math.exp(theta)
    return factors


def _scaled(matrix: Array, values: Mapping[tuple[int, ...], float], mass: Array) -> Array:
    """Return S A S with the diagonal scaled by exp(theta): what is (semi)definite stays so, what is zero too."""
    scale = np.sqrt(_factors(values, len(matrix)))
    return np.asarray(scale[:, None] * matrix * scale)


def _refactored(matrix: Array, values: Mapping[tuple[int, ...], float], mass: Array) -> Array:
    """Return L L^T, the diagonal of L scaled by exp(theta / 2), the rest moved by theta sqrt(M_ii) / 10."""
    units = np.sqrt(np.diag(mass))
    floor = 0.0 if np.linalg.eigvalsh(matrix).min() > 0.0 else FLOOR
    factor = np.linalg.cholesky(matrix + floor * np.diag(np.diag(mass)))
    for (i, j), theta in values.items():
        factor[i, j] = (
            factor[i, i] * math.exp(0.5 * theta) if i == j else factor[i, j] + 0.1 * theta * units[i]
        )
    return np.asarray(factor @ factor.T)


def _couplings(vehicle: Vehicle, values: Mapping[tuple[int, ...], float]) -> list[Content]:
    """Return the couplings; one along its own velocity keeps its sign, for it must take energy."""
    tables = [coupling.model_dump() for coupling in vehicle.damping.couplings]
    for (number,), theta in values.items():
        table = tables[number]
        table["coefficient"] *= math.exp(theta) if table["force"] == table["velocity"] else 1.0 + theta
    return tables


def _cross_flow(vehicle: Vehicle, values: Mapping[tuple[int, ...], float]) -> list[Content]:
    tables = [drag.model_dump() for drag in vehicle.cross_flow]
    for (number,), theta in values.items():
        drag = vehicle.cross_flow[number].section_drag * math.exp(theta)
        tables[number] |= {"drag_coefficient": drag, "beam": None}
    return tables


def _actuation(vehicle: Vehicle, values: Mapping[tuple[int, ...], float]) -> Content:
    tables = vehicle.model_dump(include={"thrusters", "azimuths", "fins"})
    driven = [table for table, one in zip(tables["thrusters"], vehicle.thrusters, strict=True) if one.driven]
    for (number,), theta in values.items():
        table, factor = [*driven, *tables["azimuths"], *tables["fins"]][number], math.exp(theta)
        for name in ("thrust_forward", "thrust_reverse", "gain_forward", "gain_reverse"):
            if table.get(name) is not None:
                table[name] *= factor
        if "coefficients" in table:
            table["coefficients"] = [factor * value for value in table["coefficients"]]
    return tables


def quantities_of(vehicle: Vehicle, parameters: Iterable[Parameter]) -> tuple[Quantity, ...]:
    """Return the number of the vehicle that each parameter stands for, in its unit."""
    return tuple(_quantity(vehicle, parameter) for parameter in parameters)


def _quantity(vehicle: Vehicle, parameter: Parameter) -> Quantity:
    group, index = parameter.group, parameter.place
    if group in ("added_mass", "added_mass_full"):
        i, j = index[0], index[-1]
        unit = ("kg", "kg m", "kg m^2")[(i > 2) + (j > 2)]
        return Quantity(parameter.label, unit, float(vehicle.added_mass_matrix[i, j]))
    i = index[0]
    if group == "linear":
        unit = "N s/m" if i < 3 else "N m s"
        return Quantity(parameter.label, unit, float(vehicle.linear_damping[i, i]))
    if group == "quadratic":
        unit = "N s^2/m^2" if i < 3 else "N m s^2"
        return Quantity(parameter.label, unit, float(vehicle.quadratic_damping[i]))
    if group == "couplings":
        return Quantity(parameter.label, "SI", vehicle.damping.couplings[i].coefficient)
    if group == "cross_flow":
        return Quantity(parameter.label, "1", vehicle.cross_flow[i].section_drag)
    if group == "manoeuvring" and vehicle.manoeuvring is not None:
        return Quantity(parameter.label, "1", hull_coefficient(vehicle.manoeuvring, index))
    actuators = vehicle.actuators
    propulsion = (*actuators.thrusters, *actuators.azimuths)
    if i < len(propulsion):
        unit = "N" if propulsion[i].unit == "1" else "N s^2"
        return Quantity(parameter.label, unit, propulsion[i].gains[0])
    fin = actuators.fins[i - len(propulsion)]
    return Quantity(parameter.label, "SI", max(fin.coefficients, key=abs))
