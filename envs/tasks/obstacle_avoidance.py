"""Obstacle avoidance: reach a goal beyond a field of pillars that only beams tell of, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, bounded, bounded_vector, norm, scale, subtract
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_travel
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Motion, Observed, define_task
from dq_marine.task.common import effort, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import beams_seen, pillars_seen
from dq_marine.task.starts import under_way
from dq_marine.task.world.beams import fan_forward, make_errors, make_fan, make_readings
from dq_marine.task.world.pillars import (
    Hull,
    field_draws,
    footprint,
    make_drifted,
    make_field,
    make_nearest,
    pillars_cast,
)

ROWS, COLUMNS, BEAMS = 4, 3, 24  # of the field; and how many beams see what is ahead
PILLARS = ROWS * COLUMNS
drawn_field, drifted, nearest = make_field(ROWS, COLUMNS), make_drifted(PILLARS), make_nearest(PILLARS)
fan = make_fan(fan_forward(BEAMS), pillars_cast)
drawn_errors, readings = make_errors(BEAMS), make_readings(BEAMS)
EXACT = (0.0,) * BEAMS  # errors before there are readings
LEAST_DEPTH = 20.0  # of starts of vehicles that do not float; ten lengths of long ones [m]
START_TURN, START_DRAWS = math.radians(30.0), 3  # from the course to the goal [rad]
LOST = 1.5  # episodes end beyond this distance from the goal [of that at the start]
DISTURBED = {"randomise": "default", "sensors": "auv"}


@dataclass(frozen=True)
class Settings:
    """Spacing of pillars, reach of beams, radius of arrival [vehicle lengths]; errors of beams; speed of pillars.

    Every other pillar goes at up to `pillar_speed` [share of the speed of journeys]. `noise` is the standard deviation
    of readings [share of the reach], `dropout` the probability that one is lost, and reads as if nothing were there.
    """

    spacing: float = 6.0
    pillar_speed: float = 0.0
    reach: float = 8.0
    noise: float = 0.01
    dropout: float = 0.02
    arrival_radius: float = 1.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    return replace(
        given,
        spacing=finite_number("spacing", given.spacing, least=2.0, most=1e2),
        pillar_speed=finite_number("pillar_speed", given.pillar_speed, least=0.0, most=2.0),
        reach=finite_number("reach", given.reach, least=1.0, most=1e2),
        noise=finite_number("noise", given.noise, least=0.0, most=1.0),
        dropout=finite_number("dropout", given.dropout, least=0.0, most=0.9),
        arrival_radius=finite_number("arrival_radius", given.arrival_radius, above=0.0, most=1e2),
    )


class Parameters(NamedTuple):
    """Spacing, depth [m]; speeds of vehicle and pillars [m/s]; reach, noise, dropout, arrival [m]; hull; period [s]."""

    spacing: float
    depth: float
    speed: float
    pillar_speed: float
    reach: float
    noise: float
    dropout: float
    arrival_radius: float
    hull: Hull
    period: float


class Metrics(NamedTuple):
    """Distance to the goal, clearance from the nearest pillar [m], and the speed at which it was hit, or 0 [m/s]."""

    goal_distance: float
    clearance: float
    impact_speed: float


class Memory(NamedTuple):
    """Goal in NED, pillars; ranges of the beams, errors of their readings, what the last period gained [m]; metrics."""

    goal_ned: Vector3
    pillars: Any
    ranges: Any
    errors: Any
    gained: float
    metrics: Metrics


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: way made good [1/length], room, arrival, collision, effort."""

    progress: float = 0.5
    room: float = 0.1
    arrival: float = 10.0
    collision: float = 10.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, size, speed = context.vehicle, context.vehicle.dimensions, cruising_speed(context.vehicle)
    return Parameters(
        settings.spacing * size.length,
        starting_depth(vehicle, LEAST_DEPTH),
        speed,
        speed * settings.pillar_speed,
        settings.reach * size.length,
        settings.noise * settings.reach * size.length,
        settings.dropout,
        settings.arrival_radius * size.length,
        Hull(0.5 * size.length, 0.5 * size.width),
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start at the origin, under way about towards the goal at half the speed or more."""
    heading = 2.0 * math.pi * uniforms[0] + START_TURN * (2.0 * uniforms[1] - 1.0)
    return under_way((0.0, 0.0, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[2]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new field, a goal as far beyond it as the start is before it, and what the beams meet."""
    course, distance = 2.0 * math.pi * uniforms[0], (ROWS + 1.0) * own.spacing
    place = (distance * math.cos(course), distance * math.sin(course), own.depth)
    pillars = drawn_field(course, own.spacing, own.pillar_speed, uniforms, START_DRAWS)
    closest = nearest(pillars, footprint(begun.position_ned, begun.attitude), own.hull)
    ranges = fan(pillars, begun.position_ned, begun.attitude, own.reach)
    return Memory(place, pillars, ranges, EXACT, 0.0, Metrics(distance, closest.clearance, 0.0))


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with new errors of the beams' readings."""
    errors = drawn_errors(own.noise, own.dropout, uniforms)
    return Memory(memory.goal_ned, memory.pillars, memory.ranges, errors, memory.gained, memory.metrics)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where pillars, vehicle and goal are one control period on, and what the beams meet."""
    pillars = drifted(memory.pillars, own.period)
    closest = nearest(pillars, footprint(motion.position_ned, motion.attitude), own.hull)
    over_ground = rotate(motion.attitude, motion.velocity.linear)
    relative = subtract(over_ground, (closest.north_velocity, closest.east_velocity, 0.0))
    distance = norm(subtract(memory.goal_ned, motion.position_ned))
    impact_speed = select(closest.clearance < 0.0, norm(relative), 0.0)
    ranges = fan(pillars, motion.position_ned, motion.attitude, own.reach)
    gained = memory.metrics.goal_distance - distance
    metrics = Metrics(distance, closest.clearance, impact_speed)
    return Memory(memory.goal_ned, pillars, ranges, memory.errors, gained, metrics)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    to_goal, far = subtract(memory.goal_ned, measured.position_ned), 2.0 * (ROWS + 1.0) * own.spacing
    direction = scale(1.0 / max(norm(to_goal), 1e-6), to_goal)
    return (
        readings(memory.ranges, memory.errors, own.reach),
        bounded_vector(rotate_inverse(measured.attitude, direction), 1.0),
        bounded(norm(to_goal), far),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = 2.0 * (ROWS + 1.0) * settings.spacing * vehicle.dimensions.length
    return (
        Observed(
            "beam_readings", "", BEAMS, 1.0, "free way over the reach, from port round the bow to starboard"
        ),
        Observed("goal_direction_body", "", 3, 1.0, "where the goal is, seen from the vehicle"),
        Observed("goal_distance", "m", 1, far, "how far it is"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the goal and the nearest pillar are, and how hard that was hit."""
    return memory.metrics


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    length, clearance = 2.0 * own.hull.half_length, now.metrics.clearance
    return Rewards(
        weights.progress * now.memory.gained / length,
        -(weights.room * exponential(-2.0 * max(clearance, 0.0) / length)),
        weights.arrival * select(succeeded(own, now), 1.0, 0.0),
        -(weights.collision * select(clearance < 0.0, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the goal is reached, without a collision."""
    return (now.metrics.goal_distance < own.arrival_radius) & (now.metrics.clearance >= 0.0)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the goal is reached, a pillar is hit, or the vehicle has gone astray."""
    far = now.metrics.goal_distance > LOST * (ROWS + 1.0) * own.spacing
    return succeeded(own, now) | (now.metrics.clearance < 0.0) | far


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the goal, for drawing."""
    return Goal(memory.goal_ned)


define_task(
    globals(),
    id="dq_marine/ObstacleAvoidance-v0",
    summary="Reach a goal beyond a field of pillars that beams tell of, in an unseen current.",
    draws=START_DRAWS + field_draws(ROWS, COLUMNS),
    sense_draws=BEAMS,
    scenery=lambda own, memory: pillars_seen(memory.pillars, own.depth, 2.0 * own.hull.half_length),
    beams=lambda own, memory: beams_seen(
        fan_forward(BEAMS), readings, memory.ranges, memory.errors, own.reach
    ),
    collided=lambda own, memory: memory.metrics.clearance < 0.0,
    units={"goal_distance": "m", "clearance": "m", "impact_speed": "m/s"},
    levels={
        "easy": {"spacing": 8.0, "noise": 0.0, "dropout": 0.0, "current": 0.0},
        "medium": {"current": 0.3},
        "hard": {"pillar_speed": 0.3, "noise": 0.02, "dropout": 0.1, "current": 0.4, **DISTURBED},
    },
    unsuitable=unable_to_travel,
    control_period=paced,
    max_episode_steps=2000,
)
