"""Many bodies at once, in SIMD lanes and threads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.spatial import from_fossen, to_fossen
from dq_marine.backend.packing import pack, unpack_columns
from dq_marine.backend.simd.lanes import (
    differing_fields,
    lane_layout,
    lanes_of,
)
from dq_marine.backend.simd.packing import empty_blocks, pack_blocks, pack_shared, unpack_blocks
from dq_marine.backend.workers import Workers
from dq_marine.checks import finite_rows, positive_integer, unit_quaternion_rows
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import BODY_NUMBERS, BodyState, kinetic_energy, spatial_momentum
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import (
    ACCEPTED,
    REFUSALS,
    Composition,
    StepParameters,
    make_motion,
    make_placement,
)
from dq_marine.simulation.lane_channels import LaneChannels
from dq_marine.simulation.one_body import check_momentum
from dq_marine.simulation.states import check_size, check_states

STATUS, FALLBACKS, RESIDUAL_SQUARED = range(3)
"""Fields of an outcome."""


class Batch:
    """Bodies in scenes made of the same terms, advanced together.

    Made by `Scene.batch` (bodies that differ in nothing) or `dq_marine.simulation.scene.batch_of` (a scene for each:
    vehicles and currents may differ in every number). Time starts at 0 and is one for all. Positions are in NED,
    velocities over ground in the body frame and in Fossen's order [u, v, w, p, q, r].

    Bodies with thrusters, azimuths and fins take commands as `OneBody` does, a row for each body.

    With strict arithmetic in double precision every body has the bits that `OneBody` has.

    Attributes:
        size: number of bodies.
        step_size: h [s].
        time: since the last reset [s].
        fallback_steps: of all bodies' steps, those that plain Newton did not solve (see `integrator.drift`).
        steps_refused: calls that a body did not take part in, because a step in it was refused.
    """

    def __init__(
        self,
        composition: Composition,
        parameters: Sequence[StepParameters],
        step_size: float,
        size: int,
        *,
        threads: int | None = None,
        precision: str = "float64",
        arithmetic: str = "strict",
    ) -> None:
        """Lay out the bodies; see `Scene.batch` for the options.

        Args:
            composition: the functions of the step.
            parameters: the numbers of the step, one for all bodies, or one for each.
            step_size: the h that the parameters are for [s].
            size: number of bodies.
            threads: None for as many as pay.
            precision: of the numbers in lanes.
            arithmetic: "strict" or "fast".
        """
        self.size = positive_integer("the number of bodies", size)
        lanes = lanes_of(precision, arithmetic)
        self.step_size = step_size
        distinct = {id(row): row for row in parameters}  # many bodies may share the numbers of few
        numbers = {key: pack(row) for key, row in distinct.items()}
        packed = [numbers[id(row)] for row in parameters]
        self._like = parameters[0]
        self._at_rest = composition.at_rest
        differing = differing_fields(list(distinct.values()))
        self._layout = layout = lane_layout(parameters[0], self._at_rest, differing, lanes)
        self._shared = pack_shared(layout.parameters, packed[0])
        self._own = empty_blocks(layout.parameters, self.size, lanes)
        pack_blocks(layout.parameters, packed, self._own)
        self._states = empty_blocks(layout.state, self.size, lanes)
        self._outcomes = empty_blocks(layout.outcome, self.size, lanes)
        self._channels = LaneChannels(composition, self.size, lanes)
        self._advance = self._channels.compiled_advance(layout)
        self._motion, self._place = make_motion(composition), make_placement(composition)
        self._workers = Workers(threads, len(self._states))
        self.fallback_steps = self.steps_refused = 0
        self.time = 0.0
        self.reset()

    @property
    def threads(self) -> int:
        """Number of threads in use."""
        return self._workers.threads

    @property
    def bytes_per_body(self) -> float:
        """Memory held for each body."""
        arrays = (self._own, self._states, self._outcomes)
        return float(sum(array.nbytes for array in arrays) / self.size)

    def reset(
        self,
        position_ned: ArrayLike = (0.0, 0.0, 0.0),
        quaternion_body_to_ned: ArrayLike = (1.0, 0.0, 0.0, 0.0),
        velocity_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Place all bodies, actuators at rest, and set the time to 0. Arguments have one row for all, or one for each.

        Args:
            position_ned: shape (3,) or (size, 3) [m].
            quaternion_body_to_ned: shape (4,) or (size, 4), scalar first, of unit length to 1e-6; it is normalised.
            velocity_body: over ground, shape (6,) or (size, 6) [m/s, rad/s].

        Raises:
            InvalidInputError: a shape or value is wrong; nothing is changed.
        """
        position = finite_rows("position_ned", position_ned, self.size, 3)
        attitude = unit_quaternion_rows("quaternion_body_to_ned", quaternion_body_to_ned, self.size)
        velocity = finite_rows("velocity_body", velocity_body, self.size, 6)
        with np.errstate(over="ignore", invalid="ignore"):
            state = self._place(
                self._parameters, tuple(position.T), tuple(attitude.T), from_fossen(tuple(velocity.T))
            )
        rows = np.stack([np.broadcast_to(c, self.size) for c in _components(state)], axis=1)
        check_momentum(rows)
        self._set_rows(rows)
        self._channels.come_to_rest()
        self.time = 0.0

    def step(self, wrench_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), steps: int = 1) -> None:
        """Advance all bodies by `steps` steps, each under a constant wrench.

        A body whose step is refused stays where it was before the call, and shows in `refusals`; the others go on.

        Args:
            wrench_body: [X, Y, Z, K, M, N] in the body frame about its origin, shape (6,) or (size, 6) [N, N m].
            steps: how many, at least 1.

        Raises:
            InvalidInputError: a shape or value is wrong; nothing is changed.
        """
        wrenches = finite_rows("wrench_body", wrench_body, self.size, 6)
        count = positive_integer("steps", steps)
        self._workers.run(
            self._advance,
            self._shared,
            self._own,
            self._states,
            self._outcomes,
            *self._channels.arrays,
            wrenches,
            self.time,
            count,
        )
        accepted = self._outcome(STATUS) == ACCEPTED
        self.fallback_steps += int(self._outcome(FALLBACKS).sum(where=accepted))
        self.steps_refused += self.size - int(np.count_nonzero(accepted))
        self.time += count * self.step_size

    def actuate(
        self,
        command: ArrayLike,
        steps: int = 1,
        wrench_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Advance all bodies by `steps` steps, each under a command, which is held until the next.

        Args:
            command: of every channel, shape (n,) or (size, n); beyond a channel's limits it counts as the limit.
            steps: how many, at least 1.
            wrench_body: what else acts on the bodies, as in `step`.

        Raises:
            InvalidInputError: a shape or value is wrong, or the scene has no actuators; nothing is changed.
        """
        given = self._channels.checked(command)
        wrenches = finite_rows("wrench_body", wrench_body, self.size, 6)
        count = positive_integer("steps", steps)
        self._channels.commands[:] = given
        self.step(wrenches, count)

    @property
    def command(self) -> NDArray[np.float64]:
        """The commands that are held, as given, shape (size, n)."""
        return self._channels.commands.copy()

    @property
    def actuator_values(self) -> NDArray[np.float64]:
        """What the channels have reached, shape (size, n)."""
        return self._channels.values

    @property
    def refusals(self) -> dict[int, str]:
        """Bodies that did not take part in the last call, by index, and why."""
        status = self._outcome(STATUS)
        return {int(body): REFUSALS[int(status[body])] for body in np.flatnonzero(status != ACCEPTED)}

    @property
    def position_ned(self) -> NDArray[np.float64]:
        """Positions of the body origins [m], shape (size, 3)."""
        return np.stack(pose_position(self._bodies.pose), axis=1)

    @property
    def quaternion_body_to_ned(self) -> NDArray[np.float64]:
        """Attitudes, scalar first, shape (size, 4)."""
        return np.stack(self._bodies.pose.real, axis=1)

    @property
    def relative_velocity_body(self) -> NDArray[np.float64]:
        """Velocities through the water nu_r, shape (size, 6) [m/s, rad/s]."""
        twist = twist_from_momentum(self._parameters.inertia, self._bodies.momentum)
        return np.stack(to_fossen(twist), axis=1)

    @property
    def velocity_body(self) -> NDArray[np.float64]:
        """Velocities over ground nu, shape (size, 6) [m/s, rad/s]."""
        return np.stack(to_fossen(self._motion(self._parameters, self._bodies).velocity), axis=1)

    @property
    def fluid_memory(self) -> NDArray[np.float64]:
        """State of the water's memory, see `OneBody.fluid_memory`, shape (size, m) [J^(1/2)]."""
        rows = unpack_blocks(self._layout.state, self._shared, self._states, self.size)
        return rows[:, BODY_NUMBERS - 1 :]

    @property
    def kinetic_energy(self) -> NDArray[np.float64]:
        """(1/2) nu_r . M nu_r [J], of body and water, relative to the undisturbed water, shape (size,)."""
        return np.asarray(kinetic_energy(self._parameters.inertia, self._bodies.momentum))

    @property
    def spatial_momentum(self) -> NDArray[np.float64]:
        """Momentum [linear, angular] in NED about the world origin, relative to the water, shape (size, 6)."""
        return np.stack(to_fossen(spatial_momentum(self._bodies)), axis=1)

    def get_state(self) -> NDArray[np.float64]:
        """Return time, pose, momentum, fluid memory, channel values and commands, shape (size, 15 + m + 2 n).

        `set_state` restores them bit for bit.
        """
        rows = unpack_blocks(self._layout.state, self._shared, self._states, self.size)
        return np.column_stack(
            [np.full(self.size, self.time), rows, self._channels.values, self._channels.commands]
        )

    def set_state(self, state: ArrayLike) -> None:
        """Restore what `get_state` returned.

        Raises:
            InvalidInputError: shape or value is wrong; nothing is changed.
        """
        body_numbers = BODY_NUMBERS + self._remembered
        given = finite_rows("state", state, self.size, body_numbers + 2 * self._channels.count)
        numbers, channels = given[:, :body_numbers], given[:, body_numbers:]
        check_size("state", given)
        check_states("state", numbers[:, 1:])
        if (numbers[:, 0] != numbers[0, 0]).any():
            raise InvalidInputError("state[:, 0], the time, differs between bodies; a batch has one time")
        self._set_rows(numbers[:, 1:])
        self._channels.restore(channels)
        self.time = float(numbers[0, 0])

    def close(self) -> None:
        """End the threads; they start again when there is work."""
        self._workers.close()

    @property
    def _parameters(self) -> StepParameters:
        """The numbers of the scenes: those that are one for all, else arrays of shape (size,)."""
        rows = unpack_blocks(self._layout.parameters, self._shared, self._own, self.size)
        return unpack_columns(self._like, rows)

    @property
    def _bodies(self) -> BodyState:
        """Pose, momentum and fluid memory as the step has them, of arrays of shape (size,)."""
        rows = unpack_blocks(self._layout.state, self._shared, self._states, self.size)
        return unpack_columns(self._at_rest, rows)

    def _set_rows(self, rows: NDArray[np.float64]) -> None:
        pack_blocks(self._layout.state, rows, self._states)

    @property
    def _remembered(self) -> int:
        """Numbers of a body's fluid memory."""
        return pack(self._at_rest.fluid_memory).size

    def _outcome(self, field: int) -> NDArray[Any]:
        return self._outcomes[:, field, :].reshape(-1)[: self.size]


def _components(state: Any) -> list[Any]:
    if not isinstance(state, tuple):
        return [state]
    return [component for part in state for component in _components(part)]
