"""Trajectory tracking: be where a point is that runs along a curve, heading the way it goes, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.envs.kit import (
    GOAL_MOTION,
    SHAPE_DRAWS,
    SHAPES,
    SLOW_START_DRAWS,
    SPEED_BOUND,
    STEEPEST,
    VELOCITY,
    Curve,
    CurvePoint,
    EpisodeContext,
    Goal,
    Motion,
    Observed,
    Situation,
    Start,
    Vector3,
    add_scaled,
    bounded_vector,
    curve_point,
    define_task,
    effort,
    finite_number,
    goal_along,
    harmonics_seen,
    level_course,
    moved_to,
    norm,
    observed_curve_motion,
    observed_velocity,
    one_of,
    rotate,
    rotate_inverse,
    seen_at,
    select,
    shaped_curve,
    slow_start,
    speed_ahead,
    subtract,
    unable_to_keep_up,
)

DRAWN = "drawn"  # for a shape: another one in each episode
SHORT_VEHICLE = 1.0  # [m]: tolerances and starts grow with the length of longer vehicles
POSITION, HEADING, HELD = 0.2, math.radians(10.0), 5.0  # success: within these for that long [m, rad, s]
START_RADIUS, LOST, DEPTH = 1.0, 5.0, 10.0  # starts: from the point, depth; episodes end beyond `LOST` [m]
AHEAD = (1.0, 2.0)  # how far ahead of the point its way is shown [s]
INTEGRAL_BOUND = 20.0  # of the position error along each NED axis [m s]


@dataclass(frozen=True)
class Settings:
    """Shape: circle, helix, lemniscate, wavy (a circle with waves) or drawn (any); speed over ground at most [m/s].

    None is two fifths of the speed that the vehicle reaches. Radius, and height of a turn [vehicle lengths].
    """

    shape: str = DRAWN
    speed: float | None = None
    radius: float = 8.0
    height: float = 3.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    one_of("shape", given.shape, (*SHAPES, DRAWN))
    speed = 0.4 * speed_ahead(vehicle) if given.speed is None else given.speed
    return replace(
        given,
        speed=finite_number("speed", speed, above=0.0, most=SPEED_BOUND),
        radius=finite_number("radius", given.radius, least=1.0, most=1e3),
        height=finite_number("height", given.height, least=0.0, most=given.radius),
    )


class Parameters(NamedTuple):
    """Shape (its index; -1 for any), speed [m/s], radius, height, depth, scale of lengths [m], control period [s]."""

    shape: float
    speed: float
    radius: float
    height: float
    depth: float
    size: float
    period: float


class Memory(NamedTuple):
    """Curve, phase [rad] and its rate [rad/s], the point, integral of the error in NED [m s], time on track [s]."""

    curve: Curve
    phase: float
    rate: float
    point: CurvePoint
    error_integral: Vector3
    on_track: float


class Metrics(NamedTuple):
    """Distance to the point [m], and angle between the bow and the way it goes, seen from above [rad]."""

    position_error: float
    heading_error: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: bells and a peak about the point, a bell about its course, effort."""

    position: float = 0.4
    precision: float = 0.4
    heading: float = 0.2
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    shape = -1.0 if settings.shape == DRAWN else float(SHAPES.index(settings.shape))
    floats = vehicle.hydrostatics is not None
    depth, height = (vehicle.equilibrium_depth, 0.0) if floats else (DEPTH, length * settings.height)
    size = max(1.0, length / SHORT_VEHICLE)
    return Parameters(
        shape, settings.speed, length * settings.radius, height, depth, size, context.control_period
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a slow start at any heading, near where the point begins."""
    return slow_start((0.0, 0.0, own.depth), START_RADIUS * own.size, 0.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a curve through the middle of the starts, and the point there."""
    shape = own.shape if own.shape >= 0.0 else math.floor(len(SHAPES) * uniforms[SLOW_START_DRAWS])
    drawn = shaped_curve(shape, own.radius, own.height, uniforms, SLOW_START_DRAWS + 1)
    curve = moved_to(drawn, 0.0, (0.0, 0.0, own.depth))
    rate = own.speed / (own.radius * STEEPEST[int(shape)])
    return Memory(curve, 0.0, rate, curve_point(curve, 0.0), (0.0, 0.0, 0.0), 0.0)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the point one control period on."""
    phase = memory.phase + memory.rate * own.period
    point = curve_point(memory.curve, phase)
    error = subtract(point.position_ned, measured.position_ned)
    total = bounded_vector(add_scaled(memory.error_integral, own.period, error), INTEGRAL_BOUND)
    off = errors(point, motion)
    on_track = (off.position_error < POSITION * own.size) & (off.heading_error < HEADING)
    held = select(on_track, memory.on_track + own.period, 0.0)
    return Memory(memory.curve, phase, memory.rate, point, total, held)


def errors(point: CurvePoint, motion: Motion) -> Metrics:
    """Return distance to the point and angle to its course."""
    ahead, _ = level_course(point.slope_ned)
    bow = rotate(motion.attitude, (1.0, 0.0, 0.0))
    distance = norm(subtract(point.position_ned, motion.position_ned))
    return Metrics(distance, abs(seen_at((ahead[0], ahead[1]), (bow[0], bow[1]))))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    point, rate, attitude = memory.point, memory.rate, measured.attitude
    ahead, starboard = level_course(point.slope_ned)
    reach = LOST * own.size + 2.0 * AHEAD[1] * own.speed
    soon = curve_point(memory.curve, memory.phase + rate * AHEAD[0]).position_ned
    later = curve_point(memory.curve, memory.phase + rate * AHEAD[1]).position_ned
    return (
        bounded_vector(rotate_inverse(attitude, subtract(point.position_ned, measured.position_ned)), reach),
        rotate_inverse(attitude, ahead),
        rotate_inverse(attitude, starboard),
        observed_velocity(measured),
        observed_curve_motion(point, rate, attitude),
        bounded_vector(rotate_inverse(attitude, subtract(soon, measured.position_ned)), reach),
        bounded_vector(rotate_inverse(attitude, subtract(later, measured.position_ned)), reach),
        rotate_inverse(attitude, memory.error_integral),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    reach = LOST * max(1.0, vehicle.dimensions.length / SHORT_VEHICLE) + 2.0 * AHEAD[1] * settings.speed
    rotated = math.sqrt(3.0) * INTEGRAL_BOUND * (1.0 + 1e-6)
    return (
        Observed("goal_position_body", "m", 3, reach, "the point, seen from the vehicle"),
        Observed("goal_x_axis_body", "", 3, 1.0, "where the point goes, seen from above"),
        Observed("goal_y_axis_body", "", 3, 1.0, "its starboard"),
        *VELOCITY,
        *GOAL_MOTION,
        Observed("goal_position_soon_body", "m", 3, reach, f"where the point is in {AHEAD[0]:g} s"),
        Observed("goal_position_later_body", "m", 3, reach, f"where it is in {AHEAD[1]:g} s"),
        Observed("position_error_integral_body", "m s", 3, rotated, "summed up since the start, bounded"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the vehicle is off."""
    return errors(memory.point, motion)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    nearness, turned = now.metrics.position_error / own.size, now.metrics.heading_error / 0.5
    return Rewards(
        position=weights.position * math.exp(-nearness * nearness),
        precision=weights.precision * math.exp(-nearness / POSITION),
        heading=weights.heading * math.exp(-turned * turned),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has lost the point."""
    return now.metrics.position_error > LOST * own.size


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has been on track for 5 s: within 0.2 m (a fifth of longer vehicles) and 10 degrees."""
    return now.memory.on_track > HELD


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the point and its course, for drawing."""
    return goal_along(memory.point.position_ned, memory.point.slope_ned)


define_task(
    globals(),
    id="dq_marine/TrajectoryTracking-v0",
    summary="Be where a point is that runs along a curve, heading the way it goes, in an unseen current.",
    draws=SLOW_START_DRAWS + 1 + SHAPE_DRAWS,
    scenery=lambda own, memory: harmonics_seen(memory.curve, 0.04 * own.size),
    units={"position_error": "m", "heading_error": "rad"},
    tolerances={"position_error": POSITION, "heading_error": HEADING},
    levels={
        "easy": {"shape": "circle", "current": 0.0},
        "medium": {"current": 0.3},
        "hard": {"current": 0.4, "randomise": "default", "sensors": "auv"},
    },
    unsuitable=unable_to_keep_up,
    max_episode_steps=600,
)
