"""What a motion without damping keeps: energy, momentum."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.report.physics import Physics
from dq_marine.simulation.one_body import OneBody

Array = NDArray[np.float64]


def energy(physics: Physics, body: OneBody) -> float:
    """Return kinetic and potential energy [J]: T - (W - B) z - arm . (down in the body frame)."""
    w, x, y, z = body.quaternion_body_to_ned.tolist()
    down = np.array(world_down_in_body((w, x, y, z)))
    potential = -physics.excess_weight * float(body.position_ned[2]) - float(physics.arm @ down)
    return body.kinetic_energy + potential


def momentum_errors(physics: Physics, start: Array, now: Array) -> tuple[float, float]:
    """Return how far the linear and the angular momentum have come from the start's, over their sizes there.

    Only the components that are constant count. A righting moment is horizontal and leaves the angular momentum about
    the vertical; a net weight leaves that, too, and the horizontal linear ones.

    Args:
        physics: of the body.
        start: spatial momentum at the start, [linear, angular] about the world's origin, in NED.
        now: the same, later.
    """
    change = now - start
    linear = change[:2] if physics.excess_weight else change[:3]
    tilting = bool(physics.excess_weight or physics.arm.any())
    angular = change[5:] if tilting else change[3:]
    return (
        float(np.linalg.norm(linear) / np.linalg.norm(start[:3])),
        float(np.linalg.norm(angular) / np.linalg.norm(start[3:])),
    )
