"""The formulas of station keeping, as kernel functions: start, action, memory, observation, reward, end.

`station_keeping` makes an environment of them, for one vehicle; the vector environment runs the same in lanes.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.kernel.body import Motion
from dq_marine.kernel.euler import quaternion_from_euler
from dq_marine.kernel.quaternion import (
    Quaternion,
    quaternion_conjugate,
    quaternion_multiply,
    rotate,
    rotate_inverse,
)
from dq_marine.kernel.selection import select
from dq_marine.kernel.spatial import Spatial, from_fossen
from dq_marine.kernel.task import Start, Task, Verdict
from dq_marine.kernel.vector3 import Vector3, add_scaled, dot, scale, subtract

SPEED_BOUND = 10.0
"""Velocities are observed up to this [m/s, rad/s]."""

INTEGRAL_BOUND = 20.0
"""The integral of the position error is held within this along each NED axis [m s]."""

AT_GOAL = 0.1
"""Share of episodes that start at the goal, at rest."""

LARGEST_TILT = 0.3
"""Of starts: roll and pitch [rad]."""

START_SPEED = 0.2
"""Largest component of a start's velocity [m/s, rad/s]."""


class Weights(NamedTuple):
    """`StationKeepingReward`, as the kernel takes it."""

    position: float
    position_width: float
    precision: float
    precision_width: float
    attitude: float
    attitude_width: float
    effort: float


class Aim(NamedTuple):
    """Parameters of the task in one episode.

    Attributes:
        position_ned: of the goal [m].
        attitude: of the goal, body to NED.
        start_radius: of the ball about the goal in which episodes start [m].
        start_height: of that ball along the vertical, over its radius: 1, or 0 where starts are level with the goal.
        workspace_radius: distance from the goal [m] beyond which the episode ends.
        period: control period [s].
        wrench_limits: wrench at full action.
        axes: how many numbers the agent's action has.
        weights: of the reward.
        sensors: their numbers, nested in pairs; see `kernel.sensing`.
    """

    position_ned: Vector3
    attitude: Quaternion
    start_radius: float
    start_height: float
    workspace_radius: float
    period: float
    wrench_limits: tuple[float, float, float, float, float, float]
    axes: float
    weights: Weights
    sensors: Any


class Memory(NamedTuple):
    """Integral of the position error in NED [m s]: what lets a policy without memory oppose a current."""

    error_integral: Vector3


def start(aim: Aim, uniforms: tuple[float, ...]) -> Start:
    """Return a start within the start radius: any heading, moderate tilt, slow; one in ten at the goal, at rest."""
    if uniforms[0] < AT_GOAL:
        rest = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        return Start(aim.position_ned, aim.attitude, rest)
    # Uniform in the ball: the height of a direction and the cube of a distance are.
    height = 2.0 * uniforms[1] - 1.0
    azimuth = math.pi * (2.0 * uniforms[2] - 1.0)
    across = math.sqrt(1.0 - height * height)
    direction = (across * math.cos(azimuth), across * math.sin(azimuth), aim.start_height * height)
    distance = aim.start_radius * uniforms[3] ** (1.0 / 3.0)
    attitude = quaternion_from_euler(
        LARGEST_TILT * (2.0 * uniforms[4] - 1.0),
        LARGEST_TILT * (2.0 * uniforms[5] - 1.0),
        math.pi * (2.0 * uniforms[6] - 1.0),
    )
    slow = scale(START_SPEED, (2.0 * uniforms[7] - 1.0, 2.0 * uniforms[8] - 1.0, 2.0 * uniforms[9] - 1.0))
    turning = scale(
        START_SPEED, (2.0 * uniforms[10] - 1.0, 2.0 * uniforms[11] - 1.0, 2.0 * uniforms[12] - 1.0)
    )
    return Start(add_scaled(aim.position_ned, distance, direction), attitude, Spatial(turning, slow))


def forget(aim: Aim) -> Memory:
    """Return an empty memory."""
    return Memory((0.0, 0.0, 0.0))


def act(aim: Aim, action: tuple[float, ...]) -> Spatial:
    """Return the body wrench of a normalised action."""
    limits = aim.wrench_limits
    return from_fossen(
        (
            limits[0] * action[0],
            limits[1] * action[1],
            limits[2] * action[2],
            limits[3] * action[3],
            limits[4] * action[4],
            limits[5] * action[5],
        )
    )


def clamp(value: float, bound: float) -> float:
    """Return value, held within -bound and bound."""
    return max(-bound, min(bound, value))


def clamp_vector(a: Vector3, bound: float) -> Vector3:
    """Return a with each component held within -bound and bound."""
    return (clamp(a[0], bound), clamp(a[1], bound), clamp(a[2], bound))


def remember(aim: Aim, memory: Memory, motion: Motion) -> Memory:
    """Return the integral of the position error, one control period on."""
    error = subtract(aim.position_ned, motion.position_ned)
    return Memory(clamp_vector(add_scaled(memory.error_integral, aim.period, error), INTEGRAL_BOUND))


def observe(aim: Aim, memory: Memory, motion: Motion) -> Any:
    """Return what the agent sees, all in the body frame.

    Goal position [m] (3); the goal's x and y axes (6), which fix the attitude continuously and alike for q and
    -q; velocity over ground [m/s, rad/s] (6, Fossen's order); integral of the position error [m s] (3).
    """
    error = rotate_inverse(motion.attitude, subtract(aim.position_ned, motion.position_ned))
    to_goal = quaternion_multiply(quaternion_conjugate(motion.attitude), aim.attitude)
    return (
        clamp_vector(error, aim.workspace_radius),
        clamp_vector(rotate(to_goal, (1.0, 0.0, 0.0)), 1.0),
        clamp_vector(rotate(to_goal, (0.0, 1.0, 0.0)), 1.0),
        clamp_vector(motion.velocity.linear, SPEED_BOUND),
        clamp_vector(motion.velocity.angular, SPEED_BOUND),
        rotate_inverse(motion.attitude, memory.error_integral),
    )


def judge(aim: Aim, motion: Motion, squares: float) -> Verdict:
    """Return the reward of `StationKeepingReward`, the end beyond the workspace, distance and attitude error."""
    error = subtract(aim.position_ned, motion.position_ned)
    distance = math.sqrt(dot(error, error))
    to_goal = quaternion_multiply(quaternion_conjugate(motion.attitude), aim.attitude)
    axis = (to_goal[1], to_goal[2], to_goal[3])
    angle = 2.0 * math.atan2(math.sqrt(dot(axis, axis)), abs(to_goal[0]))
    weights = aim.weights
    nearness = distance / weights.position_width
    reward = (
        weights.position * math.exp(-nearness * nearness)
        + weights.precision * math.exp(-distance / weights.precision_width)
        + weights.attitude * math.exp(-angle / weights.attitude_width)
        - weights.effort * squares / aim.axes
    )
    terminated = select(distance > aim.workspace_radius, 1.0, 0.0)
    return Verdict(reward, terminated, (distance, angle))


TASK = Task(
    draws=13,
    start=start,
    forget=forget,
    act=act,
    remember=remember,
    observe=observe,
    judge=judge,
    measure_names=("position_error", "attitude_error"),
    episode_fields=("position_ned", "attitude"),
)
