"""Station keeping: reach a goal pose and hold it in a current that the agent does not see."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from dq_marine.algebra.elementary import arctangent, exponential
from dq_marine.envs.kit import (
    SLOW_START_DRAWS,
    VELOCITY,
    ZERO,
    EpisodeContext,
    Goal,
    Motion,
    Observed,
    Quaternion,
    Situation,
    Start,
    Vector3,
    add_scaled,
    bounded_vector,
    define_task,
    effort,
    finite_number,
    goal_place,
    norm,
    observed_velocity,
    quaternion_conjugate,
    quaternion_multiply,
    rotate,
    rotate_inverse,
    slow_start,
    subtract,
    unable_to_keep_up,
)
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

INTEGRAL_BOUND = 20.0  # of the position error along each NED axis [m s]
AT_GOAL = 0.1  # share of episodes that start at the goal, at rest
SUCCESS_POSITION, SUCCESS_ATTITUDE = 0.1, math.radians(5.0)  # on station within these [m, rad]
LARGEST_WORKSPACE = 1e4  # radius [m] within which float32 observations resolve the goal
LONG_VEHICLE = 1.5  # [m]: radii that are not given grow with the length of longer vehicles
START_RADIUS, WORKSPACE_RADIUS, GOAL_DEPTH = 2.0, 6.0, 5.0  # where nothing is given, of short vehicles [m]


@dataclass(frozen=True)
class Settings:
    """Keywords of station keeping.

    Attributes:
        goal_position: in NED [m]; None for (0, 0, 5), or where a vessel that floats is at rest.
        start_radius: episodes start within this distance of the goal [m], one in ten at the goal itself; a vessel that
            floats starts level with it. None for 2 m, growing with the length of vehicles above 1.5 m.
        workspace_radius: episodes end beyond this distance from the goal [m]; None for 6 m, growing likewise.
    """

    goal_position: Sequence[float] | None = None
    start_radius: float | None = None
    workspace_radius: float | None = None


def fitted(given: Settings, vehicle: Vehicle) -> Settings:
    """Return the settings for a vehicle, checked."""
    lengths = max(1.0, vehicle.dimensions.length / LONG_VEHICLE)
    depth = GOAL_DEPTH if vehicle.hydrostatics is None else vehicle.equilibrium_depth
    default = min(LARGEST_WORKSPACE, WORKSPACE_RADIUS * lengths)
    radius = default if given.workspace_radius is None else given.workspace_radius
    workspace = finite_number("workspace_radius", radius, above=0.0)
    reach = min(START_RADIUS * lengths, max(START_RADIUS, workspace / 3.0))
    start = finite_number("start_radius", reach if given.start_radius is None else given.start_radius)
    goal = (0.0, 0.0, depth) if given.goal_position is None else given.goal_position
    if workspace > LARGEST_WORKSPACE:
        raise InvalidInputError(
            f"workspace_radius = {workspace:g} m; give at most {LARGEST_WORKSPACE:g} m, within which float32 "
            "observations resolve the goal"
        )
    if not 0.0 <= start < workspace:
        raise InvalidInputError(
            f"start_radius = {start:g} m; give 0 or more and less than the workspace_radius, {workspace:g} m"
        )
    goal_position = tuple(goal_place("goal_position", goal, vehicle).tolist())
    return replace(given, goal_position=goal_position, start_radius=start, workspace_radius=workspace)


class Parameters(NamedTuple):
    """Goal (position [m] and attitude in NED), radius and relative height of starts, workspace [m], period [s]."""

    position_ned: Vector3
    attitude: Quaternion
    start_radius: float
    start_height: float
    workspace_radius: float
    period: float


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode: an upright goal, heading north, unless the options say otherwise."""
    x, y, z = map(float, context.options.get("goal_position", settings.goal_position))
    q0, q1, q2, q3 = map(float, context.options.get("goal_quaternion", (1.0, 0.0, 0.0, 0.0)))
    height = 1.0 if context.vehicle.hydrostatics is None else 0.0
    return Parameters(
        (x, y, z),
        (q0, q1, q2, q3),
        settings.start_radius,
        height,
        settings.workspace_radius,
        context.control_period,
    )


class Memory(NamedTuple):
    """Integral of the position error in NED [m s]: what lets a policy without memory oppose a current."""

    error_integral: Vector3


class Metrics(NamedTuple):
    """Distance to the goal [m] and angle to its attitude [rad]."""

    position_error: float
    attitude_error: float


class Weights(NamedTuple):
    """Weights and widths of r = position exp(-(d/w)^2) + precision exp(-d/w) + attitude exp(-e/w) - effort mean(a^2).

    d is the distance to the goal [m], e the attitude error [rad], a the action. The first and third terms are
    MarineGym's pose-hold reward; the second keeps a gradient where the first is flat; the small effort weight
    follows the finding that a large one stops learning.
    """

    position: float = 0.5
    position_width: float = 1.0
    precision: float = 0.3
    precision_width: float = 0.1
    attitude: float = 0.2
    attitude_width: float = 0.5
    effort: float = 0.02


class Rewards(NamedTuple):
    """The terms of the reward, each with its weight."""

    position: float
    precision: float
    attitude: float
    effort: float


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start within the start radius: any heading, moderate tilt, slow; one in ten at the goal, at rest."""
    if uniforms[0] < AT_GOAL:
        return Start(own.position_ned, own.attitude, ZERO)
    return slow_start(own.position_ned, own.start_radius, own.start_height, uniforms, 1)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return an empty memory."""
    return Memory((0.0, 0.0, 0.0))


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the integral of the measured position error, one control period on."""
    error = subtract(own.position_ned, measured.position_ned)
    return Memory(bounded_vector(add_scaled(memory.error_integral, own.period, error), INTEGRAL_BOUND))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    error = rotate_inverse(measured.attitude, subtract(own.position_ned, measured.position_ned))
    to_goal = quaternion_multiply(quaternion_conjugate(measured.attitude), own.attitude)
    return (
        bounded_vector(error, own.workspace_radius),
        bounded_vector(rotate(to_goal, (1.0, 0.0, 0.0)), 1.0),
        bounded_vector(rotate(to_goal, (0.0, 1.0, 0.0)), 1.0),
        observed_velocity(measured),
        rotate_inverse(measured.attitude, memory.error_integral),
    )


def observations(settings: Any, vehicle: Vehicle) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame, the goal's axes alike for q and -q."""
    rotated = math.sqrt(3.0) * INTEGRAL_BOUND * (1.0 + 1e-6)
    return (
        Observed("goal_position_body", "m", 3, settings.workspace_radius, "the goal, seen from the vehicle"),
        Observed("goal_x_axis_body", "", 3, 1.0, "where the goal points"),
        Observed("goal_y_axis_body", "", 3, 1.0, "where the goal's starboard is"),
        *VELOCITY,
        Observed("position_error_integral_body", "m s", 3, rotated, "summed up since the start, bounded"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return distance and angle to the goal."""
    error = subtract(own.position_ned, motion.position_ned)
    to_goal = quaternion_multiply(quaternion_conjugate(motion.attitude), own.attitude)
    axis = (to_goal[1], to_goal[2], to_goal[3])
    return Metrics(norm(error), 2.0 * arctangent(norm(axis), abs(to_goal[0])))


def reward(own: Parameters, weights: Weights, now: Situation) -> Rewards:
    """Return the terms of the reward; see `Weights`."""
    distance, angle = now.metrics.position_error, now.metrics.attitude_error
    nearness = distance / weights.position_width
    return Rewards(
        position=weights.position * exponential(-nearness * nearness),
        precision=weights.precision * exponential(-distance / weights.precision_width),
        attitude=weights.attitude * exponential(-angle / weights.attitude_width),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has left the workspace."""
    return now.metrics.position_error > own.workspace_radius


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle is on station: within 0.1 m and 5 degrees."""
    near = now.metrics.position_error < SUCCESS_POSITION
    return near & (now.metrics.attitude_error < SUCCESS_ATTITUDE)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the goal, for drawing."""
    return Goal(own.position_ned, own.attitude)


define_task(
    globals(),
    id="dq_marine/StationKeeping-v0",
    summary="Reach a goal pose and hold it in an unseen current.",
    draws=1 + SLOW_START_DRAWS,
    options={"goal_position": 3, "goal_quaternion": 4},
    episode_fields=("position_ned", "attitude"),
    units={"position_error": "m", "attitude_error": "rad"},
    levels={
        "easy": {"current": 0.0, "start_radius": 1.0},
        "medium": {"current": 0.3},
        "hard": {"current": 0.5, "randomise": "default", "sensors": "auv"},
    },
    unsuitable=unable_to_keep_up,
    tolerances={"position_error": 0.05, "attitude_error": math.radians(2.0)},
)
