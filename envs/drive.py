"""What an action does to the vehicle: a wrench on its body, or commands of its actuators."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from dq_marine.engines.packing import unpack
from dq_marine.envs.episode import Episode
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.actuated import make_actuator_wrench
from dq_marine.kernel.actuated_task import with_actuators
from dq_marine.kernel.inertia import twist_from_momentum
from dq_marine.kernel.push import AXES
from dq_marine.kernel.spatial import to_fossen
from dq_marine.kernel.step import StepParameters
from dq_marine.kernel.task import Task
from dq_marine.scene import Scene
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.model import MOTIONS


class Drive(Protocol):
    """What an environment needs to know of its actions."""

    @property
    def size(self) -> int:
        """How many numbers the kernel takes."""

    @property
    def places(self) -> NDArray[np.intp]:
        """Where the numbers of an action stand among these."""

    @property
    def names(self) -> tuple[str, ...]:
        """What each number of an action drives."""

    def task(self, task: Task) -> Task:
        """Return a task for this drive."""

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return what acts on the body now, in Fossen's order, shape (6,) [N, N m]."""


class WrenchDrive:
    """An action is the thrust and torque of the actuated axes over their limits."""

    def __init__(self, limits: NDArray[np.float64]) -> None:
        """Take the largest force and moment of each axis, shape (6,): which are 0 is the same in all of a pool."""
        self.size = AXES
        self.places = np.flatnonzero(limits)
        self.names = tuple(MOTIONS[axis] for axis in self.places)

    def task(self, task: Task) -> Task:
        """Return the task as it is."""
        return task

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return the wrench of the last action."""
        return episode.action * vehicle.wrench_limits


class ActuatorsDrive:
    """An action is the command of every channel over its limit on that side."""

    def __init__(self, scene: Scene) -> None:
        """Take a scene with actuators."""
        self._actuation = scene.composition.actuation
        self._wrench = make_actuator_wrench(scene.composition)
        self.size = self._actuation.channels
        self.places = np.arange(self.size)
        self.names = tuple(channel.name for channel in scene.vehicle.channels)

    def task(self, task: Task) -> Task:
        """Return the task, made to remember what the channels have reached."""
        return with_actuators(task, self._actuation)

    def wrench_body(
        self, vehicle: Vehicle, parameters: StepParameters, episode: Episode
    ) -> NDArray[np.float64]:
        """Return what the actuators do now; their channels are what the memory ends with."""
        values = unpack(self._actuation.rest, episode.memory[-self.size :])
        twist = twist_from_momentum(parameters.inertia, episode.body.momentum)
        return np.array(to_fossen(self._wrench(parameters, values, twist)))


def drive_of(scene: Scene) -> Drive:
    """Return what drives a scene's vehicle."""
    if scene.composition.actuation.channels:
        return ActuatorsDrive(scene)
    return WrenchDrive(scene.vehicle.wrench_limits)


def commanded(drive: Drive, action: Any) -> NDArray[np.float64]:
    """Return an action as the kernel takes it, not saturated yet: the compiled code does that.

    Raises:
        InvalidInputError: it is not numeric, or of a wrong shape.
    """
    try:
        given = np.asarray(action, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"action = {action!r} is not numeric") from error
    shape = (len(drive.places),)
    if given.shape != shape:
        raise InvalidInputError(f"action has shape {given.shape}; give shape {shape}")
    command = np.zeros(drive.size)
    command[drive.places] = given
    return command
