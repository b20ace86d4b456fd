"""Bodies in lanes beside the same bodies alone: the bits of both are equal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.simulation.scene import Scene

Array = NDArray[np.float64]


def assert_actuated_lanes_equal_singles(scene: Scene, velocities: Array, commands: Array, steps: int) -> None:
    """Fly bodies with velocities of their own, shape (n, 6), under commands of their own, shape (n, actuators)."""
    batch = scene.batch(len(velocities))
    batch.reset(velocity_body=velocities)
    batch.actuate(commands, steps)
    for lane, (velocity, command) in enumerate(zip(velocities, commands, strict=True)):
        body = scene.stepper()
        body.reset(velocity_body=velocity)
        body.actuate(command, steps)
        assert np.array_equal(batch.velocity_body[lane], body.velocity_body)
        assert np.array_equal(batch.position_ned[lane], body.position_ned)
