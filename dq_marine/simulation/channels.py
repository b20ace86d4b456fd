"""The channels of a body's actuators: what they have reached, and the commands that are held until the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.backend.packing import unpack
from dq_marine.checks import finite_array
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.physics.actuators.formulas.stepping import (
    make_actuator_wrench,
)


def number_of_channels(composition: Composition) -> int:
    """Return how many channels there are to be commanded.

    Raises:
        InvalidInputError: none.
    """
    if not composition.actuation.channels:
        raise InvalidInputError(
            'this scene is driven by wrenches; make it with Scene(..., actuation="thrusters") to command actuators'
        )
    return composition.actuation.channels


class BodyChannels:
    """The channels of one body, n = 0 where it is driven by wrenches alone.

    Attributes:
        count: n.
        values: that the channels have reached, shape (n,); the compiled step changes them in place.
        commands: that are held, as given, shape (n,).
    """

    def __init__(self, composition: Composition) -> None:
        self._composition = composition
        self.count = composition.actuation.channels
        self.values, self.commands = np.zeros(self.count), np.zeros(self.count)

    def come_to_rest(self) -> None:
        """Stop all actuators, and command nothing."""
        self.values[:] = self.commands[:] = 0.0

    def hold(self, command: ArrayLike) -> NDArray[np.float64]:
        """Hold a command from now on; return the one before.

        Raises:
            InvalidInputError: a shape or value is wrong, or there are no actuators; nothing is changed.
        """
        given = finite_array("command", command, number_of_channels(self._composition))
        before = self.commands.copy()
        self.commands[:] = given
        return before

    def restore(self, numbers: NDArray[np.float64]) -> None:
        """Set values and commands, shape (2 n,)."""
        self.values[:], self.commands[:] = numbers[: self.count], numbers[self.count :]

    def wrench(self, parameters: StepParameters, twist: Spatial) -> Spatial:
        """Return what the actuators do to a body that moves through the water with a twist."""
        if not self.count:
            return ZERO
        values = unpack(self._composition.actuation.rest, self.values)
        return make_actuator_wrench(self._composition)(parameters, values, twist)
