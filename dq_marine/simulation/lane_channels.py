"""The channels of many bodies' actuators, in SIMD lanes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.simd.lanes import LaneLayout, compiled_lane_advance
from dq_marine.backend.simd.packing import empty_blocks, pack_blocks, packing_of, unpack_blocks
from dq_marine.checks import finite_rows
from dq_marine.integrator.step import Composition
from dq_marine.simulation.channels import number_of_channels
from dq_marine.simulation.lane_step import compiled_actuated_lanes


class LaneChannels:
    """The channels of many bodies in SIMD lanes, n of each, n = 0 where they are driven by wrenches alone.

    Attributes:
        count: n.
        commands: that are held, as given, shape (size, n).
    """

    def __init__(self, composition: Composition, size: int, lanes: Lanes) -> None:
        self._composition = composition
        self._size = size
        self.count = composition.actuation.channels
        self._packing = packing_of(composition.actuation.rest, lanes, lambda path: False)
        self._blocks = empty_blocks(self._packing, size, lanes)
        self.commands = np.zeros((size, self.count))

    def compiled_advance(self, layout: LaneLayout) -> Callable[..., Any]:
        """Return the compiled step of the bodies; `arrays` are among its arguments."""
        if not self.count:
            return compiled_lane_advance(self._composition, layout)
        return compiled_actuated_lanes(self._composition, layout, self._packing)

    @property
    def arrays(self) -> tuple[NDArray[Any], ...]:
        """What the compiled step reads and changes."""
        return (self._blocks, self.commands) if self.count else ()

    @property
    def values(self) -> NDArray[np.float64]:
        """What the channels have reached, shape (size, n)."""
        return unpack_blocks(self._packing, np.zeros(0), self._blocks, self._size)

    def come_to_rest(self) -> None:
        """Stop all actuators, and command nothing."""
        self._blocks[:] = self.commands[:] = 0.0

    def checked(self, command: ArrayLike) -> NDArray[np.float64]:
        """Return a command as a row for each body, shape (size, n).

        Raises:
            InvalidInputError: a shape or value is wrong, or there are no actuators.
        """
        return finite_rows("command", command, self._size, number_of_channels(self._composition))

    def restore(self, rows: NDArray[np.float64]) -> None:
        """Set values and commands, shape (size, 2 n)."""
        pack_blocks(self._packing, rows[:, : self.count], self._blocks)
        self.commands[:] = rows[:, self.count :]
