"""Parts of observations that several tasks share."""

from __future__ import annotations

from dq_marine.envs.core.definition import Observed
from dq_marine.task.common import SPEED_BOUND

VELOCITY = (
    Observed("linear_velocity_body", "m/s", 3, SPEED_BOUND, "surge, sway and heave over ground"),
    Observed("angular_velocity_body", "rad/s", 3, SPEED_BOUND, "roll, pitch and yaw rate"),
)
"""What `dq_marine.task.common.observed_velocity` gives."""

GOAL_MOTION = (
    Observed("goal_velocity_body", "m/s", 3, SPEED_BOUND, "how fast the goal goes, over ground"),
    Observed("goal_turn_rate_body", "rad/s", 3, SPEED_BOUND, "how fast its course turns"),
    Observed("goal_acceleration_body", "m/s^2", 3, SPEED_BOUND, "its acceleration"),
)
"""What `dq_marine.task.common.observed_curve_motion` gives."""
