"""One body, stepped by a function compiled for its scene."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.spatial import from_fossen, to_fossen
from dq_marine.backend.packing import pack, structure_type, unpack
from dq_marine.checks import (
    finite_array,
    finite_number,
    length_of,
    positive_integer,
    unit_quaternion,
)
from dq_marine.errors import InvalidInputError, StepNotSolvableError
from dq_marine.integrator.body import BODY_NUMBERS, BodyState, kinetic_energy, spatial_momentum
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import (
    ACCEPTED,
    REFUSALS,
    Composition,
    StepParameters,
    in_water,
    make_motion,
    make_placement,
)
from dq_marine.physics.current.formulas.unsteady import UnsteadyCurrent, head_for, settled
from dq_marine.simulation.body_step import compiled_actuated_advance, compiled_advance
from dq_marine.simulation.channels import BodyChannels
from dq_marine.simulation.states import check_size, check_states

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
"""Quaternion of a body whose axes are those of the world."""

SMALLEST_FRACTION = 2.0**-20
"""Of the scene's step: the smallest that is tried when an admissible one is sought."""

MOST_STEPS_TRIED = 64
"""Steps that an admissible step is tried for, at most."""


class OneBody:
    """A body in a scene: its state, and the compiled step.

    Made by `Scene.stepper`. Time starts at 0; position is in NED, velocity over ground in the body frame and
    in Fossen's order [u, v, w, p, q, r].

    In a scene with actuators it has thrusters, azimuths and fins, each with its limits and lags. Commands stand in the
    order of `Vehicle.channels`, in their units: shaft speeds [rad/s, or share of the largest], azimuth angles and
    deflections [rad]. A command is held until the next. Without actuators there are n = 0 channels.

    Attributes:
        step_size: h [s].
        time: since the last reset [s].
        parameters: the numbers of the scene, as the step has them.
        steps_taken: since the stepper was made.
        newton_iterations: of all of them.
        fallback_steps: of them, those that plain Newton did not solve (see `integrator.drift`).
    """

    def __init__(
        self,
        composition: Composition,
        parameters_at: Callable[[float], StepParameters],
        step: float,
    ) -> None:
        self._composition = composition
        self._parameters_at = parameters_at
        self.parameters = parameters_at(step)
        self._numbers = pack(self.parameters)
        self._channels = BodyChannels(composition)
        self._advance = self._compiled_advance()
        self._motion = make_motion(composition)
        self._state = pack(place_body(composition, self.parameters, np.zeros(3), UPRIGHT, np.zeros(6)))
        self._beginning = self.parameters.water
        self.step_size = step
        self.time = 0.0
        self.steps_taken = self.newton_iterations = self.fallback_steps = 0

    def __reduce__(self) -> Any:
        """Refuse to be pickled: a scene makes a new stepper, and `get_state` carries the state over."""
        raise TypeError("a stepper is not picklable; pickle the Scene and get_state() instead")

    def reset(
        self,
        position_ned: ArrayLike = (0.0, 0.0, 0.0),
        quaternion_body_to_ned: ArrayLike = (1.0, 0.0, 0.0, 0.0),
        velocity_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Place the body with its actuators at rest, in water without waves of its own, and set the time to 0.

        Args:
            position_ned: shape (3,) [m].
            quaternion_body_to_ned: shape (4,), scalar first, of unit length to 1e-6; it is normalised.
            velocity_body: over ground, shape (6,) [m/s, rad/s].

        Raises:
            InvalidInputError: a shape or value is wrong; nothing is changed.
        """
        position = finite_array("position_ned", position_ned, 3)
        q = unit_quaternion("quaternion_body_to_ned", quaternion_body_to_ned)
        velocity = finite_array("velocity_body", velocity_body, 6)
        beginning = in_water(self.parameters, self._beginning)
        state = pack(place_body(self._composition, beginning, position, q, velocity))
        check_momentum(state)
        self._state = state
        self._set_water(self._beginning)
        self._channels.come_to_rest()
        self.time = 0.0

    def change_current(self, velocity_ned: ArrayLike, duration: float) -> None:
        """Let the current go linearly from what it is to another velocity, where it goes on changing as fast.

        In a scene with a `dq_marine.physics.current.build.GaussMarkovCurrent`. Call it again at the end of
        `duration`. What it sets is not part of `get_state`; `reset` undoes it.

        Args:
            velocity_ned: of the water after `duration`, shape (3,) [m/s].
            duration: in which it gets there [s].

        Raises:
            InvalidInputError: a value is wrong, or the scene has another current; nothing is changed.
        """
        velocity = finite_array("velocity_ned", velocity_ned, 3)
        span = finite_number("duration", duration, above=0.0)
        water = self.parameters.water
        if not isinstance(water, UnsteadyCurrent):
            raise InvalidInputError(
                "the scene's current does not change; make it with current=GaussMarkovCurrent(...)"
            )
        x, y, z = velocity.tolist()
        self._set_water(head_for(water, (x, y, z), self.time, span))

    def _set_water(self, water: Any) -> None:
        if water is not self.parameters.water:
            self.parameters = in_water(self.parameters, water)
            self._numbers = pack(self.parameters)

    def step(self, wrench_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), steps: int = 1) -> None:
        """Advance by `steps` steps under a constant wrench.

        Between the steps of one call two half kicks are taken as one: the pose and velocity agree with
        single-step calls to the scheme's order, and exactly where nothing is damped.

        Args:
            wrench_body: [X, Y, Z, K, M, N] in the body frame about its origin, shape (6,) [N, N m].
            steps: how many, at least 1.

        Raises:
            InvalidInputError: a shape or value is wrong; nothing is changed.
            StepNotSolvableError: the integrator refused; nothing is changed.
        """
        wrench = finite_array("wrench_body", wrench_body, 6)
        count = positive_integer("steps", steps)
        status, completed, iterations, fallbacks, residual_squared = self._advance(
            self._numbers, self._state, wrench, self.time, count
        )
        if status != ACCEPTED:
            raise self._refusal(status, completed, wrench, residual_squared)
        self.steps_taken += count
        self.newton_iterations += iterations
        self.fallback_steps += fallbacks
        self.time += count * self.step_size

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
            InvalidInputError: a shape or value is wrong, or the scene has no actuators; nothing is changed.
            StepNotSolvableError: the integrator refused; nothing is changed.
        """
        held = self._channels.hold(command)
        try:
            self.step(wrench_body, steps)
        except Exception:
            self._channels.hold(held)
            raise

    @property
    def command(self) -> NDArray[np.float64]:
        """The command that is held, as given, shape (n,)."""
        return self._channels.commands.copy()

    @property
    def actuator_values(self) -> NDArray[np.float64]:
        """What the channels have reached, shape (n,)."""
        return self._channels.values.copy()

    @property
    def actuator_wrench_body(self) -> NDArray[np.float64]:
        """What the actuators do to the body now [X, Y, Z, K, M, N], shape (6,) [N, N m]."""
        twist = twist_from_momentum(self.parameters.inertia, self.state.momentum)
        return np.array(to_fossen(self._channels.wrench(self.parameters, twist)))

    def _compiled_advance(self) -> Callable[..., Any]:
        layout = structure_type(self.parameters)
        channels = self._channels
        if not channels.count:
            return compiled_advance(self._composition, layout)
        compiled = compiled_actuated_advance(self._composition, layout)
        return functools.partial(compiled, channels.values, channels.commands)

    def _refusal(
        self, status: int, completed: int, wrench: NDArray[np.float64], residual_squared: float
    ) -> StepNotSolvableError:
        velocity = self.relative_velocity_body
        return StepNotSolvableError(
            REFUSALS[status],
            residual=float(np.sqrt(residual_squared)),
            step_times_spin=self.step_size * float(length_of(velocity[3:])),
            step_times_speed=self.step_size * float(length_of(velocity[:3])),
            admissible_step=self._admissible_step(wrench, completed + 1),
        )

    def _admissible_step(self, wrench: NDArray[np.float64], steps: int) -> float | None:
        """Return the largest h/2^k that takes the body through the refused time, if any is found."""
        values, fraction = self._channels.values.copy(), 0.5
        while fraction >= SMALLEST_FRACTION:
            step = self.step_size * fraction
            numbers = pack(in_water(self._parameters_at(step), self.parameters.water))
            count = min(int(steps / fraction), MOST_STEPS_TRIED)
            status, *_ = self._advance(numbers, self._state.copy(), wrench, self.time, count)
            self._channels.values[:] = values
            if status == ACCEPTED:
                return step
            fraction *= 0.5
        return None

    @property
    def state(self) -> BodyState:
        """Pose, momentum and fluid memory as the step has them."""
        return unpack(self._composition.at_rest, self._state)

    @property
    def pose_body_to_ned(self) -> NDArray[np.float64]:
        """The pose as a unit dual quaternion q + eps (1/2) l q, real part first, shape (8,)."""
        return self._state[:8].copy()

    @property
    def quaternion_body_to_ned(self) -> NDArray[np.float64]:
        """The attitude, scalar first, shape (4,)."""
        return self._state[:4].copy()

    @property
    def position_ned(self) -> NDArray[np.float64]:
        """Position of the body origin [m], shape (3,)."""
        return np.array(pose_position(self.state.pose))

    @property
    def relative_velocity_body(self) -> NDArray[np.float64]:
        """Velocity through the water nu_r, Fossen's order [m/s, rad/s], shape (6,)."""
        return np.array(to_fossen(twist_from_momentum(self.parameters.inertia, self.state.momentum)))

    @property
    def velocity_body(self) -> NDArray[np.float64]:
        """Velocity over ground nu, Fossen's order [m/s, rad/s], shape (6,)."""
        return np.array(to_fossen(self._motion(self._parameters_now, self.state).velocity))

    @property
    def _parameters_now(self) -> StepParameters:
        """The scene's numbers, with the water as it is now."""
        water = self.parameters.water
        if not isinstance(water, UnsteadyCurrent):
            return self.parameters
        return in_water(self.parameters, settled(water, self.time))

    @property
    def kinetic_energy(self) -> float:
        """(1/2) nu_r . M nu_r [J], of body and water, relative to the undisturbed water."""
        return kinetic_energy(self.parameters.inertia, self.state.momentum)

    @property
    def spatial_momentum(self) -> NDArray[np.float64]:
        """Momentum [linear, angular] in NED about the world origin, relative to the water, shape (6,)."""
        return np.array(to_fossen(spatial_momentum(self.state)))

    @property
    def fluid_memory(self) -> NDArray[np.float64]:
        """State of the water's memory, shape (m,) [J^(1/2)]: half its square is the energy of the waves remembered.

        m = 0 in a scene without; see `dq_marine.integrator.fluid_memory`.
        """
        return self._state[BODY_NUMBERS - 1 :].copy()

    def get_state(self) -> NDArray[np.float64]:
        """Return time, pose, momentum, fluid memory, channel values and commands, shape (15 + m + 2 n,).

        `set_state` restores them bit for bit.
        """
        return np.concatenate([[self.time], self._state, self._channels.values, self._channels.commands])

    def set_state(self, state: ArrayLike) -> None:
        """Restore what `get_state` returned.

        Raises:
            InvalidInputError: shape or value is wrong; nothing is changed.
        """
        body_numbers = self._state.size + 1
        given = finite_array("state", state, body_numbers + 2 * self._channels.count)
        numbers, channels = given[:body_numbers], given[body_numbers:]
        check_size("state", given)
        check_states("state", numbers[1:])
        self.time = float(numbers[0])
        self._state = numbers[1:].copy()
        self._channels.restore(channels)


def check_momentum(states: NDArray[np.float64]) -> None:
    """Refuse packed states, one or one per row, that are not finite although position and velocity are.

    Raises:
        InvalidInputError: some number is infinite or NaN.
    """
    if not np.isfinite(states).all():
        raise InvalidInputError("velocity_body is so large that the momentum is infinite; give a smaller one")


def place_body(
    composition: Composition,
    parameters: StepParameters,
    position_ned: NDArray[np.float64],
    quaternion_body_to_ned: NDArray[np.float64],
    velocity_body: NDArray[np.float64],
) -> BodyState:
    """Return the state of a body with the given position, attitude and velocity over ground."""
    place = make_placement(composition)
    position, attitude, velocity = (
        tuple(array.tolist()) for array in (position_ned, quaternion_body_to_ned, velocity_body)
    )
    return place(parameters, position, attitude, from_fossen(velocity))
