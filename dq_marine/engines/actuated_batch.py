"""Many bodies that are driven by their actuators, in SIMD lanes and threads."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import finite_rows, positive_integer
from dq_marine.engines.batch import Batch
from dq_marine.engines.compilation import compile_function
from dq_marine.engines.lane_packing import (
    Packing,
    empty_blocks,
    make_load_block,
    make_store_block,
    pack_blocks,
    packing_of,
    unpack_blocks,
)
from dq_marine.engines.lane_rows import make_load_rows
from dq_marine.engines.lanes import LaneLayout, lanes_of
from dq_marine.kernel.actuated import make_actuated_advance
from dq_marine.kernel.spatial import from_fossen
from dq_marine.kernel.step import Composition, StepParameters

BODY_NUMBERS = 15
"""Of a body's state without actuators: time, pose, momentum."""


class ActuatedBatch(Batch):
    """Bodies with thrusters, azimuths and fins; commands as for `ActuatedBody`, a row for each body."""

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
        """Lay out the bodies; see `Batch`."""
        self._channels = composition.actuation.channels
        lanes = lanes_of(precision, arithmetic)
        self._value_packing = packing_of(composition.actuation.rest, lanes, lambda path: False)
        self._values = empty_blocks(
            self._value_packing, positive_integer("the number of bodies", size), lanes
        )
        self._commands = np.zeros((size, self._channels))
        super().__init__(
            composition,
            parameters,
            step_size,
            size,
            threads=threads,
            precision=precision,
            arithmetic=arithmetic,
        )

    def reset(
        self,
        position_ned: ArrayLike = (0.0, 0.0, 0.0),
        quaternion_body_to_ned: ArrayLike = (1.0, 0.0, 0.0, 0.0),
        velocity_body: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Place all bodies with their actuators at rest and set the time to 0; see `Batch.reset`."""
        super().reset(position_ned, quaternion_body_to_ned, velocity_body)
        self._values[:] = self._commands[:] = 0.0

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
            InvalidInputError: a shape or value is wrong; nothing is changed.
        """
        given = finite_rows("command", command, self.size, self._channels)
        finite_rows("wrench_body", wrench_body, self.size, 6)
        positive_integer("steps", steps)
        self._commands[:] = given
        self.step(wrench_body, steps)

    @property
    def command(self) -> NDArray[np.float64]:
        """The commands that are held, as given, shape (size, n)."""
        return self._commands.copy()

    @property
    def actuator_values(self) -> NDArray[np.float64]:
        """What the channels have reached, shape (size, n)."""
        return unpack_blocks(self._value_packing, np.zeros(0), self._values, self.size)

    def get_state(self) -> NDArray[np.float64]:
        """Return time, pose, momentum, channel values and commands of every body, shape (size, 15 + 2 n)."""
        return np.column_stack([super().get_state(), self.actuator_values, self._commands])

    def set_state(self, state: ArrayLike) -> None:
        """Restore what `get_state` returned, bit for bit.

        Raises:
            InvalidInputError: shape or value is wrong; nothing is changed.
        """
        numbers = finite_rows("state", state, self.size, BODY_NUMBERS + 2 * self._channels)
        super().set_state(numbers[:, :BODY_NUMBERS])
        split = BODY_NUMBERS + self._channels
        pack_blocks(self._value_packing, numbers[:, BODY_NUMBERS:split], self._values)
        self._commands[:] = numbers[:, split:]

    def _compiled_advance(self, composition: Composition, layout: LaneLayout) -> Callable[..., Any]:
        return compiled_actuated_lanes(composition, layout, self._value_packing)

    def _arrays(self) -> tuple[NDArray[Any], ...]:
        return (*super()._arrays(), self._values, self._commands)


def batch_type(composition: Composition) -> type[Batch]:
    """Return the class of batches of a composition: with actuators if it has them."""
    return ActuatedBatch if composition.actuation.channels else Batch


@functools.cache
def compiled_actuated_lanes(
    composition: Composition, layout: LaneLayout, value_packing: Packing
) -> Callable[..., Any]:
    """Compile (first, last, shared, own, states, outcomes, values, commands, wrenches, time, steps).

    `values` of the channels are blocks, changed in place as `states` are; `commands` has a row for every body. All else
    is as in `compiled_lane_advance`.
    """
    advance, nest = make_actuated_advance(composition), composition.actuation.nest
    load_parameters, load_state = make_load_block(layout.parameters), make_load_block(layout.state)
    store_state, store_outcome = make_store_block(layout.state), make_store_block(layout.outcome)
    load_values, store_values = make_load_block(value_packing), make_store_block(value_packing)
    load_wrench = make_load_rows(layout.lanes, 6)
    load_commands = make_load_rows(layout.lanes, composition.actuation.channels)

    def actuated_blocks(
        first: int,
        last: int,
        shared: Any,
        own: Any,
        states: Any,
        outcomes: Any,
        values: Any,
        commands: Any,
        wrenches: Any,
        time: float,
        steps: int,
    ) -> None:
        for block in range(first, last):
            outcome = advance(
                load_parameters(shared, own, block),
                load_state(shared, states, block),
                load_values(shared, values, block),
                nest(load_commands(commands, block)),
                from_fossen(load_wrench(wrenches, block)),
                time,
                steps,
            )
            step = outcome.step
            store_state(states, block, step.state)
            store_values(values, block, outcome.values)
            store_outcome(outcomes, block, (step.status, step.rescued, step.residual_squared))

    key = "|".join(map(str, (layout.lanes, layout.parameters.key, value_packing.key)))
    return compile_function(actuated_blocks, key, apart=(composition.rescue,))
