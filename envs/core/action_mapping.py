"""What an action does to the vehicle: a wrench on its body, or commands of its actuators."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import Spatial, to_fossen
from dq_marine.backend.packing import unpack
from dq_marine.checks import real_numbers
from dq_marine.envs.core.episode import Episode
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import StepParameters
from dq_marine.physics.actuators.build import actuator_parts
from dq_marine.physics.actuators.formulas.stepping import actuators_reader, make_actuator_wrench
from dq_marine.physics.actuators.mounting import each_force, mounting_points
from dq_marine.simulation.scene import Scene
from dq_marine.task.action import AXES
from dq_marine.task.actuated_task import with_actuators
from dq_marine.task.episode import EpisodeTask
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.model import MOTIONS
from dq_marine.viewer.snapshot import Thrust


class ActionMapping(Protocol):
    """What an environment needs to know of its actions."""

    @property
    def size(self) -> int:
        """How many numbers compiled code takes."""

    @property
    def places(self) -> NDArray[np.intp]:
        """Where the numbers of an action stand among these."""

    @property
    def names(self) -> tuple[str, ...]:
        """What each number of an action drives."""

    def task(self, task: EpisodeTask) -> EpisodeTask:
        """Return a task for this mapping."""

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return what acts on the body now, in Fossen's order, shape (6,) [N, N m]."""

    def thrusts(self, vehicle: Vehicle, parameters: StepParameters, episode: Episode) -> tuple[Thrust, ...]:
        """Return the force of each actuator now; none where actions are wrenches."""


class WrenchMapping:
    """An action is the thrust and torque of the actuated axes over their limits."""

    def __init__(self, limits: NDArray[np.float64]) -> None:
        """Take the largest force and moment of each axis, shape (6,): which are 0 is the same in all of a pool."""
        self.size = AXES
        self.places = np.flatnonzero(limits)
        self.names = tuple(MOTIONS[axis] for axis in self.places)

    def task(self, task: EpisodeTask) -> EpisodeTask:
        """Return the task as it is."""
        return task

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return the wrench of the last action."""
        return episode.action * vehicle.wrench_limits

    def thrusts(self, vehicle: Vehicle, parameters: StepParameters, episode: Episode) -> tuple[Thrust, ...]:
        """Return none: nobody knows which actuators make the wrench."""
        return ()


class ActuatorsMapping:
    """An action is the command of every channel over its limit on that side."""

    def __init__(self, scene: Scene) -> None:
        """Take a scene with actuators."""
        self._actuation = scene.composition.actuation
        self._wrench = make_actuator_wrench(scene.composition)
        self._read = actuators_reader(scene.composition)
        self._effects = tuple(part.kind.effect for part in actuator_parts(scene.vehicle))
        self.size = self._actuation.channels
        self.places = np.arange(self.size)
        self.names = tuple(channel.name for channel in scene.vehicle.channels)

    def task(self, task: EpisodeTask) -> EpisodeTask:
        """Return the task, made to remember what the channels have reached."""
        return with_actuators(task, self._actuation)

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return what the actuators do now; their channels are what the memory ends with."""
        return np.array(to_fossen(self._wrench(parameters, *self._state(parameters, episode))))

    def thrusts(self, vehicle: Vehicle, parameters: StepParameters, episode: Episode) -> tuple[Thrust, ...]:
        """Return what each actuator does now, where it is mounted."""
        numbers = self._read(parameters).effects
        forces = each_force(self._effects, numbers, *self._state(parameters, episode))
        return tuple(Thrust(*pair) for pair in zip(mounting_points(vehicle), forces, strict=True))

    def _state(self, parameters: StepParameters, episode: Episode) -> tuple[Any, Spatial]:
        """Return the channels' values, nested, and the twist relative to the water."""
        values = unpack(self._actuation.rest, episode.memory[-self.size :])
        return values, twist_from_momentum(parameters.inertia, episode.body.momentum)


class LateMapping:
    """An action does the same as by another mapping, but some control periods later: see `dq_marine.task.delays`."""

    def __init__(self, mapping: ActionMapping) -> None:
        """Take what an action does when it has arrived."""
        self._mapping = mapping
        self.size, self.places, self.names = mapping.size, mapping.places, mapping.names

    def task(self, task: EpisodeTask) -> EpisodeTask:
        """Return the task as for an action at once: the delay is put around it."""
        return self._mapping.task(task)

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return the wrench of the action that arrives next, with which the memory begins, or of the actuators."""
        arriving = replace(episode, action=episode.memory[: self.size])
        return self._mapping.wrench_body(vehicle, parameters, arriving)

    def thrusts(self, vehicle: Vehicle, parameters: StepParameters, episode: Episode) -> tuple[Thrust, ...]:
        """Return the force of each actuator now; none where actions are wrenches."""
        return self._mapping.thrusts(vehicle, parameters, episode)


def action_mapping_of(scene: Scene, action_delay: int = 0) -> ActionMapping:
    """Return what an action does in a scene, so many control periods later."""
    if action_delay:
        return LateMapping(action_mapping_of(scene))
    if scene.composition.actuation.channels:
        return ActuatorsMapping(scene)
    return WrenchMapping(scene.vehicle.wrench_limits)


def whole_action(mapping: ActionMapping, action: Any) -> NDArray[np.float64]:
    """Return an action as compiled code takes it, not saturated yet: the compiled code does that.

    Raises:
        InvalidInputError: it is not numeric, or of a wrong shape.
    """
    given = real_numbers("action", action, "an array of the action space")
    if given.shape != mapping.places.shape:
        raise InvalidInputError(f"action has shape {given.shape}; give shape {mapping.places.shape}")
    if mapping.size == given.size:
        return given
    whole = np.zeros(mapping.size)
    whole[mapping.places] = given
    return whole
