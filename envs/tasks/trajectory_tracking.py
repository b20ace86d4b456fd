"""Trajectory tracking: be where a point is that runs along a curve, heading the way it goes, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import ZERO
from dq_marine.algebra.vector3 import Vector3, add_scaled, bounded_vector, scale, subtract
from dq_marine.checks import finite_number, one_of
from dq_marine.envs.core.proportion import current_or
from dq_marine.envs.core.suitability import (
    paced,
    speed_ahead,
    tracks_by_steering,
    turning_radius,
    unable_to_track,
)
from dq_marine.envs.kit import GOAL_MOTION, VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, effort, observed_curve_motion, observed_velocity
from dq_marine.task.harmonics import Curve, CurvePoint, curve_point, level_course, moved_to
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import harmonics_seen
from dq_marine.task.shapes import SHAPE_DRAWS, SHAPES, STEEPEST, shaped_curve
from dq_marine.task.starts import SLOW_START_DRAWS, beside_start, slow_start
from dq_marine.task.tracking import Exactness, place_seen, point_errors, time_on_track

DRAWN = "drawn"  # for a shape: another one in each episode
SHORT_VEHICLE = 1.0  # [m]: tolerances and starts grow with the length of longer vehicles
POSITION, HEADING, HELD = 0.2, math.radians(10.0), 5.0  # success: within these for that long [m, rad, s]
# Of vehicles that only steer: the same; radii of curves over that of their turns; heading of starts, off the course.
STEERED, ROOM, START_TURN = (0.25, math.radians(20.0)), 6.0, math.radians(15.0)
START_RADIUS, LOST, DEPTH = 1.0, 5.0, 10.0  # starts: from the point, depth; episodes end beyond `LOST` [m]
AHEAD, INTEGRAL_BOUND = (1.0, 2.0), 20.0  # how far ahead the way is shown [s]; of errors along NED axes [m s]
USUAL, SHORTEST_PERIOD = 8.0, 0.1  # radius [lengths]; times grow with control periods from this on [s]


@dataclass(frozen=True)
class Settings:
    """Shape: circle, helix, lemniscate, wavy (a circle with waves) or drawn (any); speed over ground at most [m/s].

    None is two fifths of the speed that the vehicle reaches. Radius, and height of a turn [vehicle lengths]; a radius
    of None is 8, or what a vehicle that only steers needs.
    """

    shape: str = DRAWN
    speed: float | None = None
    radius: float | None = None
    height: float = 3.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    one_of("shape", given.shape, (*SHAPES, DRAWN))
    speed = 0.4 * speed_ahead(vehicle) if given.speed is None else given.speed
    speed = finite_number("speed", speed, above=0.0, most=SPEED_BOUND)
    needed = ROOM * turning_radius(vehicle, speed) if tracks_by_steering(vehicle) else 0.0
    usual = max(USUAL, needed / vehicle.dimensions.length)
    radius = finite_number("radius", usual if given.radius is None else given.radius, least=1.0, most=1e3)
    height = finite_number("height", given.height, least=0.0, most=radius)
    return replace(given, speed=speed, radius=radius, height=height)


class Parameters(NamedTuple):
    """Shape (its index; -1: any), speed [m/s], radius, height, depth, scale of lengths [m], how exact, period [s]."""

    shape: float
    speed: float
    radius: float
    height: float
    depth: float
    size: float
    exact: Exactness
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
    size, radius = max(1.0, length / SHORT_VEHICLE), length * settings.radius
    exact = exactness(vehicle, size)
    return Parameters(shape, settings.speed, radius, height, depth, size, exact, context.control_period)


def exactness(vehicle: Any, size: float) -> Exactness:
    """Return how exact a vehicle has to be, whose lengths are scaled by a size [m]."""
    if not tracks_by_steering(vehicle):
        return Exactness(POSITION * size, HEADING, HELD, INTEGRAL_BOUND, 1.0, 0.0)
    stretch, (position, heading) = paced(vehicle) / SHORTEST_PERIOD, STEERED
    return Exactness(position * size, heading, HELD * stretch, INTEGRAL_BOUND * size * stretch, stretch, 1.0)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a slow start at any heading, near where the point begins; or one that goes about as the point does."""
    place, reach = (0.0, 0.0, own.depth), START_RADIUS * own.size
    if own.exact.under_way == 0.0:
        return slow_start(place, reach, 0.0, uniforms, 0)
    begun = initial_memory(own, Start(place, (1.0, 0.0, 0.0, 0.0), ZERO), uniforms)
    north, east, _ = scale(begun.rate, begun.point.slope_ned)
    return beside_start(place, reach, (north, east), START_TURN, uniforms, 0)


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
    total = bounded_vector(add_scaled(memory.error_integral, own.period, error), own.exact.integral)
    held = time_on_track(own.exact, memory.on_track, point_errors(point, motion), own.period)
    return Memory(memory.curve, phase, memory.rate, point, total, held)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    point, rate, attitude = memory.point, memory.rate, measured.attitude
    ahead, starboard = level_course(point.slope_ned)
    first, second = own.exact.stretch * AHEAD[0], own.exact.stretch * AHEAD[1]
    reach = LOST * own.size + 2.0 * second * own.speed
    soon = curve_point(memory.curve, memory.phase + rate * first)
    later = curve_point(memory.curve, memory.phase + rate * second)
    return (
        place_seen(point.position_ned, measured, reach),
        rotate_inverse(attitude, ahead),
        rotate_inverse(attitude, starboard),
        observed_velocity(measured),
        observed_curve_motion(point, rate, attitude),
        place_seen(soon.position_ned, measured, reach),
        place_seen(later.position_ned, measured, reach),
        rotate_inverse(attitude, memory.error_integral),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    size = max(1.0, vehicle.dimensions.length / SHORT_VEHICLE)
    exact = exactness(vehicle, size)
    first, second = exact.stretch * AHEAD[0], exact.stretch * AHEAD[1]
    reach = LOST * size + 2.0 * second * settings.speed
    rotated = math.sqrt(3.0) * exact.integral * (1.0 + 1e-6)
    return (
        Observed("goal_position_body", "m", 3, reach, "the point, seen from the vehicle"),
        Observed("goal_x_axis_body", "", 3, 1.0, "where the point goes, seen from above"),
        Observed("goal_y_axis_body", "", 3, 1.0, "its starboard"),
        *VELOCITY,
        *GOAL_MOTION,
        Observed("goal_position_soon_body", "m", 3, reach, f"where the point is in {first:g} s"),
        Observed("goal_position_later_body", "m", 3, reach, f"where it is in {second:g} s"),
        Observed("position_error_integral_body", "m s", 3, rotated, "summed up since the start, bounded"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the vehicle is off."""
    return Metrics(*point_errors(memory.point, motion))


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    nearness, turned = now.metrics.position_error / own.size, now.metrics.heading_error / 0.5
    return Rewards(
        position=weights.position * exponential(-nearness * nearness),
        precision=weights.precision * exponential(-nearness / POSITION),
        heading=weights.heading * exponential(-turned * turned),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has lost the point."""
    return now.metrics.position_error > LOST * own.size


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has been on track for 5 s: within 0.2 m (a fifth of longer vehicles) and 10 degrees.

    Vehicles that only steer: within a quarter of their length (of a metre) and 20 degrees, which has room for the drift
    angle of a turn and of a current, for as long in proportion.
    """
    return now.memory.on_track > own.exact.held


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
        "medium": {"current": current_or(0.3, tracks_by_steering, 0.05)},
        "hard": {
            "current": current_or(0.4, tracks_by_steering, 0.08),
            "randomise": "default",
            "sensors": "auv",
        },
    },
    unsuitable=unable_to_track,
    control_period=paced,
    max_episode_steps=600,
)
