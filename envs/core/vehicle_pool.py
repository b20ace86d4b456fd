"""The vehicles that an environment's episodes fly, prepared once: their numbers as rows that compiled code reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.packing import pack, structure_type
from dq_marine.backend.simd.vehicles import PoolLayout, member_index
from dq_marine.checks import whole_number
from dq_marine.envs.core.currents import numbers_of
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.step import StepParameters
from dq_marine.physics.weather.choice import weather_of_hull
from dq_marine.randomisation import Randomisation
from dq_marine.simulation.scene import Scene
from dq_marine.simulation.settings import Settings
from dq_marine.task.episode import EpisodeParameters
from dq_marine.vehicles import Vehicle

VehicleFields: TypeAlias = tuple[tuple[float, float, float, float, float, float], tuple[float, ...]]

VEHICLE_FIELDS = ("wrench_limits", "vehicle")
"""Of an episode's parameters, those that are a vehicle's."""


@dataclass(frozen=True)
class VehiclePool:
    """Vehicles alike in what is computed, one of which each episode flies.

    Attributes:
        vehicles: at least one.
        scene: of the first of them, which stands for all.
        parameters: of each one's step.
        told: of each one, in what it is not the nominal one, where that is revealed; else nothing.
    """

    vehicles: tuple[Vehicle, ...]
    scene: Scene
    parameters: tuple[StepParameters, ...]
    told: tuple[tuple[float, ...], ...]

    @cached_property
    def rows(self) -> NDArray[np.float64]:
        """The parameters of the step and the `VEHICLE_FIELDS` of the episode, packed, shape (vehicles, numbers)."""
        return np.array([pack(self._member(number)) for number in range(len(self.vehicles))])

    @property
    def layout(self) -> PoolLayout | None:
        """What a row holds; None where there is nothing to choose."""
        if not self.has_choice:
            return None
        return PoolLayout(structure_type(self._member(0)), VEHICLE_FIELDS)

    @property
    def has_choice(self) -> bool:
        """Whether there is more than one vehicle: only then an episode draws."""
        return len(self.vehicles) > 1

    def drawn(self, random: np.random.Generator) -> int:
        """Return the number of a vehicle, drawn by one uniform random number if there is a choice."""
        return member_index(len(self.vehicles), random.random()) if self.has_choice else 0

    def fitted(self, episode_parameters: EpisodeParameters, number: int) -> EpisodeParameters:
        """Return an episode's parameters with those of one vehicle."""
        wrench_limits, told = self._fields(number)
        return episode_parameters._replace(wrench_limits=wrench_limits, vehicle=told)

    def telling(self, told: Sequence[tuple[float, ...]]) -> VehiclePool:
        """Return the pool with what is told of each vehicle."""
        return replace(self, told=tuple(told))

    def checked_number(self, number: Any) -> int:
        """Return the number of a vehicle in a saved state.

        Raises:
            InvalidInputError: it is no vehicle's.
        """
        return whole_number("state['vehicle']", number, least=0, most=len(self.vehicles) - 1)

    def _fields(self, number: int) -> VehicleFields:
        """Return a vehicle's `VEHICLE_FIELDS`."""
        return wrench_limits_of(self.vehicles[number]), self.told[number]

    def _member(self, number: int) -> tuple[StepParameters, VehicleFields]:
        """Return what a row holds of a vehicle."""
        return self.parameters[number], self._fields(number)


def prepared_pool(settings: Settings) -> VehiclePool:
    """Return the vehicles of settings with their numbers: the vehicle itself, or those drawn from it.

    Sea and wind push drawn vessels that float as they push the one that these are drawn from.

    Raises:
        InvalidInputError: a vehicle cannot be integrated with the step, or the vehicles differ in what is computed, or
            in how many numbers their forces are made of.
    """
    vehicles = drawn_vehicles(settings)
    if len(vehicles) > 1:  # what sea and wind make of a hull is not drawn
        settings = replace(settings, weather=weather_of_hull(settings.weather, settings.flown))
    scenes: list[Scene] = []
    parameters: list[StepParameters] = []
    for number, vehicle in enumerate(vehicles):
        scenes.append(_scene(settings.with_vehicle(vehicle), number, len(vehicles)))
        parameters.append(numbers_of(scenes[-1]))
        _check_last_is_computed_as_first(scenes, parameters)
    return VehiclePool(vehicles, scenes[0], tuple(parameters), told=((),) * len(vehicles))


def drawn_vehicles(settings: Settings) -> tuple[Vehicle, ...]:
    """Return the vehicles that episodes fly.

    Raises:
        InvalidInputError: see `Randomisation.pool`; or propellers are to be lost of a body that none drive.
    """
    if settings.randomise is None:
        return (settings.flown,)
    randomisation = Randomisation.load(settings.randomise)
    lost = randomisation.actuators.lost
    if lost and settings.actuation == "wrench":
        raise InvalidInputError(
            f"randomise loses {lost} of the propellers, and actuation = 'wrench' has none; give actuation = 'thrusters'"
        )
    return randomisation.pool(settings.flown, settings.vehicle_pool, settings.vehicle_seed)


def wrench_limits_of(vehicle: Vehicle) -> tuple[float, float, float, float, float, float]:
    """Return the wrench at full action [N, N m], Fossen's order."""
    x, y, z, k, m, n = vehicle.wrench_limits.tolist()
    return (x, y, z, k, m, n)


def _check_last_is_computed_as_first(scenes: list[Scene], parameters: list[StepParameters]) -> None:
    """Check that what is compiled for the first vehicle so far computes the last one, too."""
    number, first, last = len(scenes) - 1, scenes[0], scenes[-1]
    if last.composition != first.composition:
        raise InvalidInputError(
            f"drawn vehicle {number} has the terms {list(last.terms)}, vehicle 0 {list(first.terms)}; give "
            "distributions under which no term of the one is zero in another"
        )
    size, wanted = pack(parameters[-1]).size, pack(parameters[0]).size
    if size != wanted:  # the last one's numbers would be read as if they were the first one's
        raise InvalidInputError(
            f"the forces on drawn vehicle {number} have {size} numbers, those on vehicle 0 {wanted}; give weather and "
            "forces whose tables have the same length for all, or leave randomise out"
        )


def _scene(settings: Settings, number: int, count: int) -> Scene:
    try:
        return Scene.from_settings(settings)
    except InvalidInputError as error:
        if count == 1:
            raise
        raise InvalidInputError(f"drawn vehicle {number} of {count}: {error}") from error
