"""The hand with which a person pulls the vehicle by a point of its body."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.quaternion import rotation_matrix
from dq_marine.algebra.spatial import wrench_at
from dq_marine.backend.packing import unpack
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.push import push
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

Array = NDArray[np.float64]

STRONGEST = 2.0
"""Acceleration that the hand can give the point that it holds [m/s^2]: its force is this times the mass felt there."""

STIFFEST = 0.3
"""Of the spring: its frequency times the control period, over which its force is held; about 1 would be unstable."""


class Hold(NamedTuple):
    """What the hand holds, and where it is.

    Attributes:
        point_body: of the vehicle, in its axes [m].
        target_ned: of the hand [m].
    """

    point_body: tuple[float, float, float]
    target_ned: tuple[float, float, float]


class Hand:
    """A critically damped spring between a point of the vehicle and a place in the world.

    As in MuJoCo's `mjv_applyPerturbForce`, stiffness and damping are multiples of the mass that is felt at the point.
    The water that moves along counts, and the direction in which the point gives way most easily. The spring reaches
    its strongest force when it is as long as the vehicle, or stays softer, where control periods are long.

    Attributes:
        hold: None while nothing is held.
    """

    def __init__(self) -> None:
        self.hold: Hold | None = None

    def take(self, value: tuple[tuple[float, float, float], tuple[float, float, float]] | None) -> None:
        """Hold a point, hold it elsewhere, or let go: the value of a `Pull`'s event."""
        self.hold = None if value is None else Hold(*value)

    def pull(self, env: MarineEnv) -> bool:
        """Push the vehicle of an environment's episode for the next control period; return whether anything is held."""
        if self.hold is None:
            return False
        push(env, self.hold.point_body, spring_force(env, self.hold).tolist())
        return True


def spring_force(env: MarineEnv, hold: Hold) -> Array:
    """Return the force on the point that is held, in the world's axes [N], shape (3,)."""
    motion, point = env.motion, np.array(hold.point_body)
    rotation = np.reshape(rotation_matrix(motion.attitude), (3, 3))
    stretch = np.array(hold.target_ned) - np.array(motion.position_ned) - rotation @ point
    turning, moving = (np.array(part) for part in motion.velocity)
    velocity = rotation @ (moving + np.cross(turning, point))
    mass = mass_felt(unpack(env.base_parameters, env.episode.parameters).inertia, point)
    frequency = min(math.sqrt(STRONGEST / env.flown_vehicle.dimensions.length), STIFFEST / env.control_period)
    force: Array = mass * (frequency**2 * stretch - 2.0 * frequency * velocity)
    return force * min(1.0, mass * STRONGEST / max(float(np.linalg.norm(force)), math.ulp(0.0)))


def mass_felt(inertia: Inertia, point: Array) -> float:
    """Return the mass [kg] of a point of a body in the direction in which it gives way most easily."""
    gives_way = np.empty((3, 3))
    for axis, direction in enumerate(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
        turning, moving = twist_from_momentum(inertia, wrench_at(tuple(point.tolist()), direction))
        gives_way[:, axis] = np.array(moving) + np.cross(turning, point)
    return 1.0 / float(np.linalg.eigvalsh(gives_way)[-1])
