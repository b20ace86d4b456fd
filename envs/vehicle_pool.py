"""The vehicles that an environment's episodes fly, prepared once: their numbers as rows that compiled code reads."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.engines.lane_vehicles import PoolLayout, member_index
from dq_marine.engines.packing import pack, structure_type
from dq_marine.envs.currents import EnvironmentCurrent
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.step import StepParameters
from dq_marine.randomisation import Randomisation
from dq_marine.scene import Scene
from dq_marine.vehicles import Vehicle

RandomisationChoice = Randomisation | str | os.PathLike[str]

DEFAULT_CURRENT = 0.3
"""Largest speed of the current [m/s] where nothing is said."""


@dataclass(frozen=True)
class VehicleDraw:
    """How the vehicles of an environment's episodes are drawn.

    Attributes:
        randomisation: from which distributions; None where all episodes fly the same vehicle.
        size: how many are drawn.
        seed: of the draws.
    """

    randomisation: Randomisation | None = None
    size: int = 1
    seed: int = 0

    def vehicles(self, vehicle: Vehicle) -> tuple[Vehicle, ...]:
        """Return the vehicles that are flown in place of one: itself, or those drawn.

        Raises:
            InvalidInputError: see `Randomisation.pool`.
        """
        if self.randomisation is None:
            return (vehicle,)
        return self.randomisation.pool(vehicle, self.size, self.seed)

    def current_or_default(self, current: EnvironmentCurrent | None) -> EnvironmentCurrent:
        """Return the current that was asked for, else the randomisation's largest speed, else the default."""
        if current is not None:
            return current
        if self.randomisation is None or self.randomisation.current is None:
            return DEFAULT_CURRENT
        return self.randomisation.current.speed


FIXED_VEHICLE = VehicleDraw()
"""All episodes fly the same vehicle."""


@dataclass(frozen=True)
class VehiclePool:
    """Vehicles alike in what is computed, one of which each episode flies.

    Attributes:
        vehicles: at least one.
        scene: of the first of them, which stands for all.
        parameters: of each one's step.
        aims: those of the task's parameters that are a vehicle's, of each one.
        aim_fields: their names.
        rows: `parameters` and `aims`, packed, shape (vehicles, numbers).
    """

    vehicles: tuple[Vehicle, ...]
    scene: Scene
    parameters: tuple[StepParameters, ...]
    aims: tuple[tuple[Any, ...], ...]
    aim_fields: tuple[str, ...]
    rows: NDArray[np.float64]

    @property
    def layout(self) -> PoolLayout | None:
        """What a row holds; None where there is nothing to choose."""
        if not self.has_choice:
            return None
        return PoolLayout(structure_type((self.parameters[0], self.aims[0])), self.aim_fields)

    @property
    def has_choice(self) -> bool:
        """Whether there is more than one vehicle: only then an episode draws."""
        return len(self.vehicles) > 1

    def drawn(self, random: np.random.Generator) -> int:
        """Return the number of a vehicle, drawn by one uniform random number if there is a choice."""
        return member_index(len(self.vehicles), random.random()) if self.has_choice else 0

    def fitted(self, aim: Any, number: int) -> Any:
        """Return the task's parameters with those of one vehicle."""
        return aim._replace(**dict(zip(self.aim_fields, self.aims[number], strict=True)))

    def check_number(self, number: int) -> None:
        """Refuse a number that is no vehicle's.

        Raises:
            InvalidInputError: it is not.
        """
        if not 0 <= number < len(self.vehicles):
            raise InvalidInputError(
                f"state['vehicle'] = {number}; the environment has vehicles 0 to {len(self.vehicles) - 1}"
            )


def prepared_pool(
    vehicles: tuple[Vehicle, ...],
    scene_of: Callable[[Vehicle], Scene],
    parameters_of: Callable[[Scene], StepParameters],
    vehicle_aim: Callable[[Vehicle], dict[str, Any]],
) -> VehiclePool:
    """Return vehicles with their numbers.

    Args:
        vehicles: at least one.
        scene_of: what is integrated with a vehicle.
        parameters_of: the numbers of its step.
        vehicle_aim: those of the task's parameters that are a vehicle's, by name.

    Raises:
        InvalidInputError: a vehicle cannot be integrated with the step, or the vehicles differ in what is computed.
    """
    scenes = [_scene(scene_of, vehicle, number, len(vehicles)) for number, vehicle in enumerate(vehicles)]
    first = scenes[0]
    for number, scene in enumerate(scenes):
        if scene.composition != first.composition:
            raise InvalidInputError(
                f"drawn vehicle {number} has the terms {list(scene.terms)}, vehicle 0 {list(first.terms)}; give "
                "distributions under which no term of the one is zero in another"
            )
    parameters = tuple(map(parameters_of, scenes))
    fields = [vehicle_aim(vehicle) for vehicle in vehicles]
    aims = tuple(tuple(own.values()) for own in fields)
    rows = np.array([pack(member) for member in zip(parameters, aims, strict=True)])
    return VehiclePool(vehicles, first, parameters, aims, tuple(fields[0]), rows)


def _scene(scene_of: Callable[[Vehicle], Scene], vehicle: Vehicle, number: int, count: int) -> Scene:
    try:
        return scene_of(vehicle)
    except InvalidInputError as error:
        if count == 1:
            raise
        raise InvalidInputError(f"drawn vehicle {number} of {count}: {error}") from error
