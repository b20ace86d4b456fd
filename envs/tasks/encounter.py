"""Encounter: meet vessels that keep course and speed, by the rules of the road, and go on along the route."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.level import Level, level_bow, level_cross, level_dot, level_length
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number, whole_number
from dq_marine.envs.core.observed import vessels_shown
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_sail
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Motion, Observed, define_task
from dq_marine.task.common import effort, observed_velocity
from dq_marine.task.imazu import IMAZU_CASES
from dq_marine.task.lookout import (
    CLEAR,
    Lookout,
    along_route,
    crowding,
    first_lookout,
    least_distance,
    lookout_kept,
    next_approach,
    shown,
    wrong_sides,
)
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import vessels_seen
from dq_marine.task.starts import under_way
from dq_marine.task.traffic import DEGREE, SLOTS, TRAFFIC_DRAWS, Own, traffic

GATE, FAR = 3.0, 4.0  # success: so near the route's end [lengths]; bound of distances [ways to the meeting]


@dataclass(frozen=True)
class Settings:
    """Keywords of an encounter.

    Attributes:
        case: 0 draws the vessels to be met; 1 to 22 are the cases of Imazu's problem.
        vessels: the most that are drawn, from 1 on.
        approach: way to where the first tracks meet, half of the route [vehicle lengths].
        safe_distance: between the middles of two vessels; nearer counts as a collision [vehicle lengths].
    """

    case: int = 0
    vessels: int = SLOTS
    approach: float = 30.0
    safe_distance: float = 1.5


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    approach = finite_number("approach", given.approach, least=10.0, most=1e3)
    return replace(
        given,
        case=whole_number("case", given.case, least=0, most=len(IMAZU_CASES)),
        vessels=whole_number("vessels", given.vessels, least=1, most=SLOTS),
        approach=approach,
        safe_distance=finite_number("safe_distance", given.safe_distance, above=0.0, most=0.1 * approach),
    )


class Parameters(NamedTuple):
    """Speed [m/s], length, way to the meeting, depth, safe distance [m], control period [s], and whom to meet.

    Those are `vessels`, the most that are drawn, or where `from_case` is 1, `case`; see `dq_marine.task.traffic`.
    """

    speed: float
    length: float
    way: float
    depth: float
    safe: float
    period: float
    vessels: float
    from_case: float
    case: Any


class Memory(NamedTuple):
    """Other vessels; the route's course; where one's own is along and to starboard of it, gained in the period [m]."""

    lookout: Lookout
    course: Level
    along: float
    starboard: float
    gained: float


class Metrics(NamedTuple):
    """Least distance so far [m], distance [m] and time [s] of the nearest approach to come, as vessels go now.

    Also the distance to the goal [m]; and 1 unless a vessel has been passed on the side that the rules forbid, then 0.
    """

    least_distance: float
    cpa_distance: float
    cpa_time: float
    goal_distance: float
    sides_kept: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: way made good, nearness to the route, clearance, side, ends, effort."""

    progress: float = 0.5
    route: float = 0.2
    clearance: float = 1.0
    side: float = 0.5
    finish: float = 20.0
    collision: float = 50.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    case = IMAZU_CASES[settings.case - 1] if settings.case else ()
    slots = [(DEGREE * heading, ratio, 1.0) for heading, ratio in case]
    return Parameters(
        cruising_speed(vehicle),
        length,
        length * settings.approach,
        starting_depth(vehicle, 0.0),
        length * settings.safe_distance,
        context.control_period,
        float(settings.vessels),
        1.0 if settings.case else 0.0,
        (*slots, *((0.0, 1.0, 0.0),) * (SLOTS - len(slots))),
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start at the beginning of the route, under way along it."""
    return under_way((0.0, 0.0, own.depth), math.tau * uniforms[0], own.speed)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return the vessels to be met, and that nothing has happened yet."""
    course = (math.cos(math.tau * uniforms[0]), math.sin(math.tau * uniforms[0]))
    here = Own(course, own.speed, own.length, own.way)
    vessels = traffic(here, own.case, own.from_case, own.vessels, uniforms, 1)
    return Memory(first_lookout(vessels), course, 0.0, 0.0, 0.0)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where all vessels are one control period on."""
    along, starboard = along_route(memory.course, motion)
    lookout = lookout_kept(memory.lookout, motion, own.period)
    return Memory(lookout, memory.course, along, starboard, along - memory.along)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    along, starboard = along_route(memory.course, measured)
    bow, far = level_bow(measured.attitude), FAR * own.way
    return (
        bounded(starboard, far),
        bounded(2.0 * own.way - along, far),
        (level_dot(bow, memory.course), level_cross(bow, memory.course)),
        shown(memory.lookout, measured, bow, far, far / own.speed),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = FAR * settings.approach * vehicle.dimensions.length
    return (
        Observed("starboard_of_route", "m", 1, far, "how far the vehicle is to starboard of the route"),
        Observed("distance_to_go", "m", 1, far, "along the route, to its end"),
        Observed("route_level", "", 2, 1.0, "where the route goes, ahead and to starboard"),
        *vessels_shown(SLOTS, far, far / cruising_speed(vehicle)),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how near others come, and on which side."""
    nearest = next_approach(memory.lookout, motion, FAR * own.way)
    return Metrics(
        least_distance(memory.lookout),
        nearest.distance,
        nearest.time,
        level_length((2.0 * own.way - memory.along, memory.starboard)),
        select(wrong_sides(memory.lookout, motion) > 0.5, 0.0, 1.0),
    )


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms."""
    near, wrong = crowding(now.memory.lookout, now.motion, own.length, own.speed)
    pace = now.memory.gained / (own.speed * own.period)
    return Rewards(
        weights.progress * max(-1.0, min(1.0, pace)),
        weights.route * exponential(-(abs(now.memory.starboard) / (CLEAR * own.length))),
        -(weights.clearance * near),
        -(weights.side * wrong),
        weights.finish * select(succeeded(own, now), 1.0, 0.0),
        -(weights.collision * select(now.metrics.least_distance < own.safe, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the end of the route is reached, within three lengths of it, with no collision and on the right sides."""
    there = (now.memory.along >= 2.0 * own.way) & (abs(now.memory.starboard) < GATE * own.length)
    return there & (now.metrics.least_distance >= own.safe) & (now.metrics.sides_kept > 0.5)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether vessels collide, the end of the route is abeam, or the route is lost."""
    over = (now.metrics.least_distance < own.safe) | (now.memory.along >= 2.0 * own.way)
    return over | (abs(now.memory.starboard) > own.way) | (now.memory.along < -own.way)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the end of the route, for drawing."""
    return Goal((2.0 * own.way * memory.course[0], 2.0 * own.way * memory.course[1], own.depth))


define_task(
    globals(),
    id="dq_marine/Encounter-v0",
    summary="Meet up to three vessels by the rules of the road, and go on along the route.",
    draws=1 + TRAFFIC_DRAWS,
    meets=lambda own, memory: Own(memory.course, own.speed, own.length, own.way),
    scenery=lambda own, memory: vessels_seen(memory.lookout.vessels, own.length),
    collided=lambda own, memory: least_distance(memory.lookout) < own.safe,
    units={"least_distance": "m", "cpa_distance": "m", "cpa_time": "s", "goal_distance": "m"},
    levels={
        "easy": {"vessels": 1, "current": 0.0},
        "medium": {"current": 0.0},
        "hard": {"current": 0.3, "sensors": "auv", "randomise": "default"},
    },
    unsuitable=unable_to_sail,
    surroundings={"current": 0.0},
    vehicle="otter",
    control_period=paced,
    max_episode_steps=3000,
)
