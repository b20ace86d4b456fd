"""A term of the reward that asks for calm: it punishes turning."""

from __future__ import annotations

from dq_marine.algebra.vector3 import dot
from dq_marine.task.protocol import RewardTerm, Situation


def turning(now: Situation) -> float:
    """Return minus the square of the angular velocity [rad^2/s^2]."""
    rate = now.motion.velocity.angular
    return -dot(rate, rate)


CALM = RewardTerm("calm", turning, weight=0.1)
