"""One body that is driven by its actuators."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import types
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import finite_array, positive_integer
from dq_marine.engines.compilation import compile_function
from dq_marine.engines.one_body import AT_REST, OneBody
from dq_marine.engines.packing import make_load, store, structure_type, unpack
from dq_marine.kernel.actuated import (
    actuators_reader,
    actuators_writer,
    driven_by,
    make_actuated_advance,
    make_actuator_wrench,
)
from dq_marine.kernel.actuation import Drive
from dq_marine.kernel.spatial import from_fossen, to_fossen
from dq_marine.kernel.step import ACCEPTED, Composition, StepParameters

BODY_NUMBERS = 15
"""Of a body's state without actuators: time, pose, momentum."""


class ActuatedBody(OneBody):
    """A body with thrusters, azimuths and fins, each with its limits and lags.

    Commands stand in the order of `Vehicle.channels`, in their units: shaft speeds [rad/s, or share of the largest],
    azimuth angles and deflections [rad]. A command is held until the next.
    """

    def __init__(
        self,
        composition: Composition,
        parameters_at: Callable[[float], StepParameters],
        step: float,
    ) -> None:
        self._channels = composition.actuation.channels
        self._values = np.zeros(self._channels)
        self._commands = np.zeros(self._channels)
        super().__init__(composition, parameters_at, step)

    def reset(
        self,
        position_ned: ArrayLike = (0.0, 0.0, 0.0),
        quaternion_body_to_ned: ArrayLike = (1.0, 0.0, 0.0, 0.0),
        velocity_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Place the body with its actuators at rest and set the time to 0; see `OneBody.reset`."""
        super().reset(position_ned, quaternion_body_to_ned, velocity_body)
        self._values[:] = self._commands[:] = 0.0

    def actuate(
        self,
        command: ArrayLike,
        steps: int = 1,
        wrench_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Advance by `steps` steps under a command, which is held until the next.

        Args:
            command: of every channel, shape (n,); beyond a channel's limits it counts as the limit.
            steps: how many, at least 1.
            wrench_body: what else acts on the body, as in `step`.

        Raises:
            InvalidInputError: a shape or value is wrong; nothing is changed.
            StepNotSolvableError: the integrator refused; nothing is changed.
        """
        given = finite_array("command", command, self._channels)
        finite_array("wrench_body", wrench_body, 6)
        positive_integer("steps", steps)
        held = self._commands.copy()
        self._commands[:] = given
        try:
            self.step(wrench_body, steps)
        except Exception:
            self._commands[:] = held
            raise

    @property
    def command(self) -> NDArray[np.float64]:
        """The command that is held, as given, shape (n,)."""
        return self._commands.copy()

    @property
    def actuator_values(self) -> NDArray[np.float64]:
        """What the channels have reached, shape (n,)."""
        return self._values.copy()

    @property
    def actuator_wrench_body(self) -> NDArray[np.float64]:
        """What the actuators do to the body now [X, Y, Z, K, M, N], shape (6,) [N, N m]."""
        values = unpack(self._composition.actuation.rest, self._values)
        twist = from_fossen(tuple(self.relative_velocity_body.tolist()))
        return np.array(to_fossen(make_actuator_wrench(self._composition)(self.parameters, values, twist)))

    def get_state(self) -> NDArray[np.float64]:
        """Return time, pose, momentum, channel values and commands, shape (15 + 2 n,)."""
        return np.concatenate([super().get_state(), self._values, self._commands])

    def set_state(self, state: ArrayLike) -> None:
        """Restore what `get_state` returned, bit for bit.

        Raises:
            InvalidInputError: shape or value is wrong; nothing is changed.
        """
        numbers = finite_array("state", state, BODY_NUMBERS + 2 * self._channels)
        super().set_state(numbers[:BODY_NUMBERS])
        self._values[:] = numbers[BODY_NUMBERS : BODY_NUMBERS + self._channels]
        self._commands[:] = numbers[BODY_NUMBERS + self._channels :]

    def _compiled_advance(self) -> Callable[..., Any]:
        compiled = compiled_actuated_advance(self._composition, structure_type(self.parameters))
        return functools.partial(compiled, self._values, self._commands)

    def _as_driven(self, parameters: StepParameters) -> StepParameters:
        actuation = self._composition.actuation
        actuators = actuators_reader(self._composition)(parameters)
        values, commands = (unpack(actuation.rest, a) for a in (self._values, self._commands))
        targets = actuation.aim(actuators.channels, values, commands)
        drive = Drive(values, targets, self.time)
        return actuators_writer(self._composition)(parameters, driven_by(actuators, drive))


def body_of(
    composition: Composition, parameters_at: Callable[[float], StepParameters], step: float
) -> OneBody:
    """Return a body, with actuators if the composition has them."""
    return (ActuatedBody if composition.actuation.channels else OneBody)(composition, parameters_at, step)


@functools.cache
def compiled_actuated_advance(composition: Composition, layout: types.Type) -> Callable[..., Any]:
    """Compile (values, commands, parameters, state, wrench, time, steps), otherwise as `compiled_advance` does.

    `values` and `commands` of the channels are float64 arrays; `values` is changed in place as `state` is.
    """
    advance = make_actuated_advance(composition)
    load_parameters, load_state = make_load(layout), make_load(structure_type(AT_REST))
    load_channels = make_load(structure_type(composition.actuation.rest))

    def actuated_arrays(
        values: Any, commands: Any, parameters: Any, state: Any, wrench: Any, time: float, steps: int
    ) -> Any:
        force = from_fossen((wrench[0], wrench[1], wrench[2], wrench[3], wrench[4], wrench[5]))
        outcome = advance(
            load_parameters(parameters),
            load_state(state),
            load_channels(values),
            load_channels(commands),
            force,
            time,
            steps,
        )
        step = outcome.step
        if step.status == ACCEPTED:
            store(state, step.state)
            store(values, outcome.values)
        return (step.status, step.completed, step.iterations, step.rescued, step.residual_squared)

    return compile_function(actuated_arrays, str(layout), apart=(composition.rescue,))
