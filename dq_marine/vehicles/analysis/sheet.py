"""A vehicle's sheet: numbers that determine its behaviour, computed from its model."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from dq_marine.checks import finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.physics.abkowitz.build import own_axis_force
from dq_marine.physics.hydrostatics.restoring import heave_period, natural_periods, restoring_frequencies
from dq_marine.physics.manoeuvring.build import own_axis_drag
from dq_marine.physics.radiation.build import radiation_model
from dq_marine.vehicles.analysis.munk import munk_growth_rate
from dq_marine.vehicles.coupling import asymmetry, largest_coupling, unit_free
from dq_marine.vehicles.model import MOTIONS, Vehicle

FASTEST = 1e6
"""Speed [m/s, rad/s] beyond which drag is not looked for."""

BISECTIONS = 60


@dataclass(frozen=True)
class Sheet:
    """The numbers that `vehicle_sheet` computes.

    Attributes:
        name: the vehicle's.
        description: the vehicle's.
        dry_mass: m [kg].
        weight: W [N].
        buoyancy: B [N].
        added_mass: diagonal of M_A, by motion [kg, kg m^2].
        added_mass_asymmetry: largest |A_ij - A_ji| / sqrt(M_ii M_jj) of M_A as its file has it; the model takes the
            symmetric part.
        condition_number: of M in SI units.
        unit_free_condition_number: of M_ij / sqrt(M_ii M_jj).
        coupling: largest |M_ij| / sqrt(M_ii M_jj) off the diagonal.
        coupled: the two motions that it couples; empty if none.
        heave_period: undamped natural period [s]; infinite for a vehicle that does not float.
        roll_period: undamped natural period [s]; infinite without a righting moment.
        pitch_period: likewise [s].
        terminal_speed: by motion, at the wrench's limit in that axis alone, against damping alone [m/s, rad/s]; 0 where
            the vehicle is not actuated, infinite where it is not damped. In surge of a ship by polynomials, the limit
            acts besides the propeller in them.
        speed: U through the water along x, for what follows [m/s].
        munk_growth_rate: of deviations from straight motion at U [1/s], see `munk_growth_rate`.
        restoring_step: step [s] at which the explicit restoring forces become unstable, h omega = 2; larger steps are
            refused. Infinite without.
        translation_step: step [s] up to which translation at U is solved directly, h sigma = 2; larger steps are split.
            Infinite where nothing grows.
        service_speed: that the propeller in a ship's polynomials holds [m/s]; None for vehicles without.
        validity: limits of the motions and seas that the file's numbers hold for, each for reading; empty if unknown.
        radiation_memory: how well a model of the waves that the hull makes reproduces its table by frequency, for
            reading, or why there is none; empty without a table.
    """

    name: str
    description: str
    dry_mass: float
    weight: float
    buoyancy: float
    added_mass: dict[str, float]
    added_mass_asymmetry: float
    condition_number: float
    unit_free_condition_number: float
    coupling: float
    coupled: tuple[str, ...]
    heave_period: float
    roll_period: float
    pitch_period: float
    terminal_speed: dict[str, float]
    speed: float
    munk_growth_rate: float
    restoring_step: float
    translation_step: float
    service_speed: float | None = None
    validity: tuple[str, ...] = ()
    radiation_memory: tuple[str, ...] = ()

    @property
    def largest_step(self) -> float:
        """Largest step that is stable and solved directly at the speed [s]; a tenth of it is accurate."""
        return min(self.restoring_step, self.translation_step)

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON has it: numbers that are infinite become None."""
        content = {**asdict(self), "largest_step": self.largest_step}
        return {key: _json_value(value) for key, value in content.items()}


def vehicle_sheet(vehicle: Vehicle, *, speed: float = 1.0) -> Sheet:
    """Return a vehicle's sheet.

    Args:
        vehicle: a validated vehicle.
        speed: through the water along x, for growth rate and steps [m/s].

    Raises:
        InvalidInputError: the speed is not finite and above 0.
    """
    speed = finite_number("speed", speed, above=0.0)
    mass_matrix, added = vehicle.mass_matrix, np.array(vehicle.added_mass)
    coupling = largest_coupling(mass_matrix)
    roll, pitch = natural_periods(vehicle)
    growth = munk_growth_rate(vehicle, speed)
    fastest = float(restoring_frequencies(vehicle).max())
    return Sheet(
        name=vehicle.name,
        description=vehicle.description,
        dry_mass=vehicle.rigid_body.mass,
        weight=vehicle.weight,
        buoyancy=vehicle.buoyant_force,
        added_mass=_by_motion(np.diag(added).tolist()),
        added_mass_asymmetry=asymmetry(added, mass_matrix).value,
        condition_number=float(np.linalg.cond(mass_matrix)),
        unit_free_condition_number=float(np.linalg.cond(unit_free(mass_matrix, mass_matrix))),
        coupling=coupling.value,
        coupled=(MOTIONS[coupling.row], MOTIONS[coupling.column]) if coupling.value > 0.0 else (),
        heave_period=heave_period(vehicle),
        roll_period=roll,
        pitch_period=pitch,
        terminal_speed=_by_motion([terminal_speed(vehicle, axis) for axis in range(6)]),
        speed=speed,
        munk_growth_rate=growth,
        restoring_step=2.0 / fastest if fastest > 0.0 else math.inf,
        translation_step=2.0 / growth if growth > 0.0 else math.inf,
        service_speed=None if vehicle.whole_ship is None else vehicle.whole_ship.service_speed,
        validity=() if vehicle.validity is None else vehicle.validity.limits(),
        radiation_memory=() if vehicle.radiation is None else _radiation_memory(vehicle),
    )


def _radiation_memory(vehicle: Vehicle) -> tuple[str, ...]:
    try:
        return radiation_model(vehicle).summary()
    except InvalidInputError as error:
        return (f"none: {error}",)


def terminal_speed(vehicle: Vehicle, axis: int) -> float:
    """Return the speed at which drag is the limit F, for one axis with the others held [m/s, rad/s].

    In closed form, d v + q v^2 = F; by bisection where damping is blended, or polynomials have it.
    """
    limit = float(vehicle.wrench_limits[axis])
    if limit == 0.0:
        return 0.0
    linear, quadratic = _own_axis_coefficients(vehicle, axis)
    # The root in the form that stands without a quadratic part.
    denominator = linear + math.sqrt(linear * linear + 4.0 * quadratic * limit)
    in_closed_form = 2.0 * limit / denominator if denominator > 0.0 else math.inf
    if vehicle.whole_ship is not None or any(one.index == axis for one in vehicle.damping.blended):
        return _first_speed_with(drag_of(vehicle, axis), limit, in_closed_form)
    return in_closed_form


def drag_of(vehicle: Vehicle, axis: int) -> Callable[[float], float]:
    """Return (speed of 0 or more) -> drag, for one axis with the others held [N, N m].

    Of a ship by polynomials that is what is left of it by the propeller in them.
    """
    linear, quadratic = _own_axis_coefficients(vehicle, axis)
    blends = [blended for blended in vehicle.damping.blended if blended.index == axis]
    of_polynomials = own_axis_force(vehicle, axis)

    def drag_at(speed: float) -> float:
        own = linear * speed + quadratic * speed**2 - of_polynomials(speed)
        return own + sum(blended.alone(speed) for blended in blends)

    return drag_at


def _own_axis_coefficients(vehicle: Vehicle, axis: int) -> tuple[float, float]:
    """Return the linear and the quadratic damping of an axis by itself."""
    quadratic = float(vehicle.quadratic_damping[axis]) + own_axis_drag(vehicle, axis)
    quadratic += sum(
        float(drag.own_axis_coefficients(vehicle.buoyancy.water_density)[axis]) for drag in vehicle.cross_flow
    )
    return float(vehicle.linear_damping[axis, axis]), quadratic


def _first_speed_with(drag_at: Callable[[float], float], force: float, most: float) -> float:
    """Return the speed at which a drag that grows with it is a force; most if it is never that large."""
    high = min(1.0, most)
    while drag_at(high) < force and high < FASTEST:
        high *= 2.0
    if drag_at(high) < force:
        return most
    low = 0.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if drag_at(middle) < force else (low, middle)
    return high


def _by_motion(values: list[float]) -> dict[str, float]:
    return dict(zip(MOTIONS, values, strict=True))


def _json_value(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _json_value(item) for key, item in value.items()}
    return None if isinstance(value, float) and math.isinf(value) else value
