"""Currents of scenes and environments: three components, or a current that varies with depth or with time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from dq_marine.algebra.nesting import nested
from dq_marine.checks import finite_array, finite_number, positive_integer, real_numbers, shown
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.water import CurrentDraw
from dq_marine.physics.current.formulas.sheared import Layer, ShearedCurrent, make_sheared_water
from dq_marine.physics.current.formulas.uniform import MOVING_WATER, STILL_WATER, UniformFlow
from dq_marine.physics.current.formulas.unsteady import (
    UNSTEADY_WATER,
    Course,
    Displacement,
    Process,
    UnsteadyCurrent,
)
from dq_marine.physics.matrices import Array, vector3
from dq_marine.physics.term import WaterTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

MOST_DEPTHS = 33
"""Depths of a profile: each is compiled into the step."""

FASTEST_WATER = 20.0
"""Fastest current that is one [m/s]; the fastest tidal streams reach about 8."""


@dataclass(frozen=True)
class CurrentProfile:
    """A steady horizontal current that varies with depth: linearly between some depths, constant beyond them.

    Attributes:
        depths: increasing, in NED [m], 2 to `MOST_DEPTHS` of them.
        velocities: north and east at each [m/s], shape (depths, 2).
    """

    depths: tuple[float, ...]
    velocities: tuple[tuple[float, float], ...]

    def __init__(self, depths: ArrayLike, velocities: ArrayLike) -> None:
        """Check depths and velocities.

        Raises:
            InvalidInputError: they are not as above, not finite, or too fast for water.
        """
        count = real_numbers("current.depths", depths, "a list of depths").size
        z = finite_array("current.depths", depths, count)
        if not 2 <= count <= MOST_DEPTHS:
            raise InvalidInputError(f"current.depths has {count} numbers; give 2 to {MOST_DEPTHS}")
        if not (np.diff(z) > 0.0).all():
            raise InvalidInputError(
                f"current.depths = {z.tolist()} do not increase; give them from the surface down"
            )
        rows = [finite_array(f"current.velocities[{k}]", row, 2) for k, row in enumerate(_rows(velocities))]
        if len(rows) != count:
            raise InvalidInputError(
                f"current.velocities has {len(rows)} rows for {count} depths; give north and east for each depth"
            )
        check_speed("current.velocities", np.array(rows))
        object.__setattr__(self, "depths", tuple(z.tolist()))
        object.__setattr__(self, "velocities", tuple((float(row[0]), float(row[1])) for row in rows))

    @classmethod
    def power_law(
        cls,
        surface_velocity: ArrayLike,
        water_depth: float,
        *,
        exponent: float = 1.0 / 7.0,
        layers: int = 8,
    ) -> CurrentProfile:
        """Return a tidal stream's profile, u(z) = u_surface (1 - z/H)^exponent (DNV-RP-C205, tidal currents).

        Args:
            surface_velocity: north and east [m/s].
            water_depth: H [m].
            exponent: 1/7 for a turbulent stream.
            layers: between which the curve is met exactly; they get thinner towards the bed.

        Raises:
            InvalidInputError: a value is wrong.
        """
        surface = finite_array("surface_velocity", surface_velocity, 2)
        depth = finite_number("water_depth", water_depth, above=0.0)
        power = finite_number("exponent", exponent, above=0.0)
        height = np.linspace(1.0, 0.0, positive_integer("layers", layers) + 1) ** 3
        return cls(depth * (1.0 - height), height[:, None] ** power * surface)

    def at(self, depth: ArrayLike) -> Array:
        """Return the velocity in NED [m/s] at depths [m] of shape (...), shape (..., 3)."""
        z = np.asarray(depth, dtype=np.float64)
        north, east = np.transpose(self.velocities)
        parts = (np.interp(z, self.depths, north), np.interp(z, self.depths, east), np.zeros_like(z))
        return np.stack(parts, axis=-1)

    def term(self, vehicle: Vehicle) -> WaterTerm:
        """Return what the step computes."""
        slopes = np.diff(self.velocities, axis=0) / np.diff(self.depths)[:, None]
        ends = zip(pairwise(self.depths), slopes.tolist(), strict=True)
        layers = nested([Layer(top, bottom, north, east) for (top, bottom), (north, east) in ends])
        parameters = ShearedCurrent((*self.velocities[0], 0.0), layers)
        return WaterTerm("current profile", make_sheared_water(len(slopes)), parameters)


@dataclass(frozen=True)
class GaussMarkovCurrent:
    """A uniform current whose horizontal components vary about a mean as first-order Gauss-Markov processes.

    An environment draws the first velocity from the stationary distribution and a new one for every control period,
    within which the current changes linearly from one to the next. A stepper starts at the mean, where it stays until
    `OneBody.change_current` says otherwise; `sample` gives such velocities.

    Attributes:
        mean: velocity in NED [m/s].
        standard_deviation: of each horizontal component [m/s].
        correlation_time: after which a deviation is expected to have shrunk to 1/e [s].
    """

    mean: tuple[float, float, float] = (0.0, 0.0, 0.0)
    standard_deviation: float = field(default=0.1)
    correlation_time: float = field(default=60.0)

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            InvalidInputError: a value is not finite, or too fast for water.
        """
        mean = finite_array("current.mean", self.mean, 3)
        deviation = finite_number("current.standard_deviation", self.standard_deviation)
        if deviation < 0.0:
            raise InvalidInputError(f"current.standard_deviation = {deviation:g} m/s; give 0 or more")
        check_speed("current.mean", mean)
        check_speed("current.standard_deviation", np.array([deviation]))
        object.__setattr__(self, "mean", vector3(mean))
        object.__setattr__(self, "standard_deviation", deviation)
        time = finite_number("current.correlation_time", self.correlation_time, above=0.0)
        object.__setattr__(self, "correlation_time", time)

    def process(self, period: float) -> Process:
        """Return the process in steps of a period [s], as the step has it."""
        decay = period / self.correlation_time
        gust = self.standard_deviation * math.sqrt(-math.expm1(-2.0 * decay))
        return Process(self.mean, math.exp(-decay), gust, period)

    def sample(self, period: float, count: int, *, seed: int | None = None) -> Array:
        """Return velocities in NED [m/s] at 0, T, ..., (count - 1) T of one realisation, shape (count, 3).

        Args:
            period: T [s].
            count: how many.
            seed: of NumPy's generator.

        Raises:
            InvalidInputError: a value is wrong.
        """
        process = self.process(finite_number("period", period, above=0.0))
        normal = np.random.default_rng(seed).standard_normal((positive_integer("count", count), 2))
        deviations = np.zeros((len(normal), 3))
        deviations[0, :2] = self.standard_deviation * normal[0]
        for k in range(1, len(normal)):
            deviations[k, :2] = process.memory * deviations[k - 1, :2] + process.gust * normal[k]
        deviations += self.mean
        return deviations

    def term(self, vehicle: Vehicle) -> WaterTerm:
        """Return what the step computes."""
        excess = (vehicle.buoyant_force - vehicle.weight) / vehicle.gravity
        moment = -vehicle.restoring_arm / vehicle.gravity
        parameters = UnsteadyCurrent(
            Course(self.mean, (0.0, 0.0, 0.0), 0.0), Displacement(excess, vector3(moment)), self.process(1.0)
        )
        return WaterTerm("Gauss-Markov current", UNSTEADY_WATER, parameters)


class UniformCurrent(NamedTuple):
    """A uniform steady current: velocity in NED [m/s]."""

    velocity_ned: tuple[float, float, float]

    def term(self, vehicle: Vehicle) -> WaterTerm:
        """Return what the step computes: nothing in still water."""
        return uniform_water(np.array(self.velocity_ned))


class DrawnCurrent(NamedTuple):
    """A uniform current that is drawn: horizontal, in any direction, with a speed [m/s] of up to `speed`.

    An environment draws it for each episode; a body in a scene of its own begins in water at rest.
    """

    speed: float

    def term(self, vehicle: Vehicle) -> WaterTerm:
        """Return what the step computes: nothing if there is no speed."""
        if self.speed == 0.0:
            return WaterTerm("", STILL_WATER, ())
        return WaterTerm("current", MOVING_WATER, UniformFlow((0.0, 0.0, 0.0)))


Varying: TypeAlias = CurrentProfile | GaussMarkovCurrent
Current: TypeAlias = UniformCurrent | DrawnCurrent | Varying
CurrentLike: TypeAlias = Sequence[float] | Array | Varying | Mapping[str, Any]

KINDS: tuple[type[Varying], ...] = (CurrentProfile, GaussMarkovCurrent)


def current_of(current: Any) -> Current:
    """Return a current from three components, a largest speed, one of `KINDS`, or a dictionary of its attributes.

    Raises:
        InvalidInputError: it is none of these, or a value is wrong.
    """
    if isinstance(current, UniformCurrent | DrawnCurrent | CurrentProfile | GaussMarkovCurrent):
        return current
    if isinstance(current, Mapping):
        return _from_mapping(current)
    if isinstance(current, Sequence) or (isinstance(current, np.ndarray) and current.ndim):
        velocity = finite_array("current", current, 3)
        check_speed("current", velocity)
        return UniformCurrent(vector3(velocity))
    return DrawnCurrent(finite_number("current", current, least=0.0, most=FASTEST_WATER))


def draw_of(current: Current) -> CurrentDraw:
    """Return what an environment draws the current of an episode from."""
    if isinstance(current, UniformCurrent):
        return CurrentDraw(current.velocity_ned, 0.0)
    if isinstance(current, DrawnCurrent):
        return CurrentDraw((0.0, 0.0, 0.0), current.speed)
    if isinstance(current, GaussMarkovCurrent):
        return CurrentDraw(current.mean, current.standard_deviation)
    return CurrentDraw((0.0, 0.0, 0.0), 0.0)


def plain(current: Current) -> Any:
    """Return a current as text, lists and numbers that `current_of` takes."""
    if isinstance(current, UniformCurrent):
        return list(current.velocity_ned)
    if isinstance(current, DrawnCurrent):
        return current.speed
    return {one.name: getattr(current, one.name) for one in fields(current)}


def _from_mapping(given: Mapping[str, Any]) -> Varying:
    for kind in KINDS:
        names = {one.name for one in fields(kind)}
        if given and set(given) <= names:
            try:
                return kind(**given)
            except TypeError as error:
                raise InvalidInputError(
                    f"current = {shown(dict(given))} lacks some of {sorted(names)}"
                ) from error
    known = " or ".join(str([one.name for one in fields(kind)]) for kind in KINDS)
    raise InvalidInputError(f"current has keys {sorted(map(shown, given))}; give {known}")


def _rows(velocities: Any) -> Iterator[Any]:
    try:
        return iter(velocities)
    except Exception as error:  # the value's own __iter__ may do anything
        raise InvalidInputError(
            f"current.velocities = {shown(velocities)}; give a row for each depth"
        ) from error


def check_speed(name: str, velocities: Array) -> None:
    """Check that no component of a current is faster than `FASTEST_WATER`.

    Raises:
        InvalidInputError: one is.
    """
    fastest = float(np.abs(velocities).max())
    if fastest > FASTEST_WATER:
        raise InvalidInputError(f"{name} has {fastest:g} m/s; give at most {FASTEST_WATER:g} m/s")


def uniform_water(current_ned: Array) -> WaterTerm:
    """Return water that moves with a velocity in NED [m/s], shape (3,): still water if that is zero."""
    if not current_ned.any():
        return WaterTerm("", STILL_WATER, ())
    return WaterTerm("current", MOVING_WATER, UniformFlow(vector3(current_ned)))
