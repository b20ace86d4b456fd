"""Obstacle avoidance: reach a goal beyond a field of pillars or net cages that only beams tell of, in a current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import bounded, bounded_vector, norm, scale, subtract
from dq_marine.checks import finite_number, one_of
from dq_marine.envs.core import range_settings
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.range_settings import RangeSettings
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_travel
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Motion, Observed, define_task
from dq_marine.task.common import effort, observed_velocity
from dq_marine.task.passage import Passage, make_passages
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import beams_seen, field_seen
from dq_marine.task.starts import under_way
from dq_marine.task.world.beams import make_errors, make_fan, make_readings
from dq_marine.task.world.pillars import LAYOUTS, FieldPlan, Hull, field_draws, pillars_cast
from dq_marine.task.world.rangefinders import RANGE_FINDERS, RangeFinder

ROWS, COLUMNS = 4, 3  # of the field
length, drawn_passage, onward = make_passages(ROWS, COLUMNS)
LEAST_DEPTH = 20.0  # of starts of vehicles that do not float; ten lengths of long ones [m]
START_TURN, START_DRAWS = math.radians(30.0), 3  # from the course to the goal [rad]
LOST = 1.5  # episodes end beyond this distance from the goal [of that at the start]
DISTURBED = {"randomise": "default", "sensors": "auv"}


@dataclass(frozen=True)
class Settings(RangeSettings):
    """Spacing of pillars, reach of beams, radius of arrival [vehicle lengths]; speed of pillars; range sensor.

    The `obstacles` are "pillars" or "cages", wider, with nets. Every other one of them goes at up to `pillar_speed`
    [share of the speed of journeys]. The `range_finder` is "multibeam", a sonar that sees what is ahead, "scanning",
    one whose head turns from beam to beam with each ping, or "lidar", of vessels that float, which sees all round. It
    has so many `beams`: None is 24, and 48 of a lidar. For `noise`, `dropout`, `rate` and `latency` see
    `RangeSettings`.
    """

    obstacles: str = "pillars"
    spacing: float = 6.0
    pillar_speed: float = 0.0
    reach: float = 8.0
    dropout: float = 0.02
    arrival_radius: float = 1.0
    range_finder: str = "multibeam"
    beams: int | None = None


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    return replace(
        given,
        obstacles=one_of("obstacles", given.obstacles, LAYOUTS),
        spacing=finite_number("spacing", given.spacing, least=2.0, most=1e2),
        pillar_speed=finite_number("pillar_speed", given.pillar_speed, least=0.0, most=2.0),
        reach=finite_number("reach", given.reach, least=1.0, most=1e2),
        arrival_radius=finite_number("arrival_radius", given.arrival_radius, above=0.0, most=1e2),
        **range_settings.checked_finder(given.range_finder, given.beams, vehicle),
        **range_settings.checked_ranging(given),
    )


class Parameters(NamedTuple):
    """Field; depth [m], speed [m/s]; reach, noise [m], dropout, arrival [m]; hull; period [s]; which range sensor."""

    field: FieldPlan
    depth: float
    speed: float
    reach: float
    noise: float
    dropout: float
    arrival_radius: float
    hull: Hull
    period: float
    finder: float


class Metrics(NamedTuple):
    """Distance to the goal, clearance from the nearest pillar [m], and the speed at which it was hit, or 0 [m/s]."""

    goal_distance: float
    clearance: float
    impact_speed: float


class Memory(NamedTuple):
    """Where goal, pillars and vehicle are; ranges of the beams, errors of their readings [m]."""

    passage: Passage
    ranges: Any
    errors: Any


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
        FieldPlan(settings.spacing * size.length, speed * settings.pillar_speed, LAYOUTS[settings.obstacles]),
        starting_depth(vehicle, LEAST_DEPTH),
        speed,
        settings.reach * size.length,
        settings.noise * settings.reach * size.length,
        settings.dropout,
        settings.arrival_radius * size.length,
        Hull(0.5 * size.length, 0.5 * size.width),
        context.control_period,
        float(list(RANGE_FINDERS).index(settings.range_finder)),
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start at the origin, under way about towards the goal at half the speed or more."""
    heading = 2.0 * math.pi * uniforms[0] + START_TURN * (2.0 * uniforms[1] - 1.0)
    return under_way((0.0, 0.0, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[2]))


def make_formulas(finder: RangeFinder, count: int) -> dict[str, Any]:
    """Return the formulas that are about a range sensor of so many beams, by their names."""
    fan = make_fan(finder.fan(count), pillars_cast)
    drawn_errors, readings, exact = make_errors(count), make_readings(count), (0.0,) * count

    def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
        """Return a new passage, and what the beams meet."""
        passage = drawn_passage(own.field, own.depth, own.hull, begun, uniforms, START_DRAWS)
        return Memory(passage, fan(passage.pillars, begun.position_ned, begun.attitude, own.reach), exact)

    def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
        """Return the memory with new errors of the beams' readings."""
        return Memory(memory.passage, memory.ranges, drawn_errors(own.noise, own.dropout, uniforms))

    def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
        """Return where pillars, vehicle and goal are one control period on, and what the beams meet."""
        passage = onward(memory.passage, own.hull, motion, own.period)
        ranges = fan(passage.pillars, motion.position_ned, motion.attitude, own.reach)
        return Memory(passage, ranges, memory.errors)

    def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
        """Return what `observations` lists."""
        to_goal, far = (
            subtract(memory.passage.goal_ned, measured.position_ned),
            2.0 * length(own.field.spacing),
        )
        direction = scale(1.0 / max(norm(to_goal), 1e-6), to_goal)
        return (
            readings(memory.ranges, memory.errors, own.reach),
            bounded_vector(rotate_inverse(measured.attitude, direction), 1.0),
            bounded(norm(to_goal), far),
            bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
            observed_velocity(measured),
        )

    made = {"initial_memory": initial_memory, "sense": sense, "sense_draws": count}
    return made | {"update_memory": update_memory, "observe": observe}


formulas = range_settings.formulas_by_finder(make_formulas)
initial_memory, sense, sense_draws, update_memory, observe = formulas(Settings()).values()


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = 2.0 * length(settings.spacing * vehicle.dimensions.length)
    return (
        Observed("beam_readings", "", settings.beams, 1.0, "free way over the reach, from port to starboard"),
        Observed("goal_direction_body", "", 3, 1.0, "where the goal is, seen from the vehicle"),
        Observed("goal_distance", "m", 1, far, "how far it is"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the goal and the nearest pillar are, and how hard that was hit."""
    return Metrics(memory.passage.distance, memory.passage.clearance, memory.passage.impact_speed)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    size, clearance = 2.0 * own.hull.half_length, now.metrics.clearance
    return Rewards(
        weights.progress * now.memory.passage.gained / size,
        -(weights.room * exponential(-2.0 * max(clearance, 0.0) / size)),
        weights.arrival * select(succeeded(own, now), 1.0, 0.0),
        -(weights.collision * select(clearance < 0.0, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the goal is reached, without a collision."""
    return (now.metrics.goal_distance < own.arrival_radius) & (now.metrics.clearance >= 0.0)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the goal is reached, a pillar is hit, or the vehicle has gone astray."""
    far = now.metrics.goal_distance > LOST * length(own.field.spacing)
    return succeeded(own, now) | (now.metrics.clearance < 0.0) | far


def beams(own: Parameters, memory: Memory) -> Any:
    """Return what the beams tell, for drawing."""
    count, finder = len(memory.ranges), list(RANGE_FINDERS.values())[int(own.finder)]
    return beams_seen(finder.fan(count), make_readings(count), memory.ranges, memory.errors, own.reach)


define_task(
    globals(),
    id="dq_marine/ObstacleAvoidance-v0",
    summary="Reach a goal beyond a field of pillars that beams tell of, in an unseen current.",
    draws=START_DRAWS + field_draws(ROWS, COLUMNS),
    sense_draws=sense_draws,
    schedule=range_settings.finder_schedule,
    lasting=("range_finder", "beams", *range_settings.PING_KEYWORDS),
    goal=lambda own, memory: Goal(memory.passage.goal_ned),
    scenery=lambda own, memory: field_seen(memory.passage.pillars, own.field.layout, own.depth, own.hull),
    collided=lambda own, memory: memory.passage.clearance < 0.0,
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
