"""Path following: go along a smooth path at a commanded speed, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector, scale
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.proportion import sea_for
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_travel
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import curve_seen
from dq_marine.task.splines import beside, curvature, make_spline, make_winding, winding_draws
from dq_marine.task.starts import under_way

SPANS = 4  # of the path, about a leg each
(point_at, nearer), wind = make_spline(SPANS), make_winding(SPANS)
LEAST_DEPTH = 20.0  # of starts of vehicles that do not float; ten lengths of long ones [m]
START_OFFSET, START_TURN, START_DRAWS = 0.5, math.radians(20.0), 3  # from the path [lengths, rad]
LEG_TIME = 10.0  # legs take this long at least [s]
ACQUIRED = 1.0  # span from whose beginning on errors count
CORRIDOR, LEAST = 0.25, 0.5  # success: never farther than this from the path [lengths, but at least m]
SPEED_TOLERANCE = 0.1  # and the mean error of the speed below this [share of the speed]
LOST = 5.0  # episodes end beyond this distance from the path [lengths]
AHEAD = 0.25  # how far ahead the curvature is shown, too [spans]
FAR, STEEP = 10.0, 10.0  # bounds of what is shown: distances [lengths], curvatures [1/lengths]


@dataclass(frozen=True)
class Settings:
    """Speed over ground [m/s], legs of the path [vehicle lengths, 10 s at least], its turns and slopes [degrees].

    A speed of None is three fifths of what the vehicle reaches, or can steer at. Bends have radii of leg / turn.
    """

    speed: float | None = None
    leg: float = 8.0
    turn: float = 40.0
    climb: float = 8.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    speed = cruising_speed(vehicle) if given.speed is None else given.speed
    climb = finite_number("climb", given.climb, least=0.0, most=45.0)
    return replace(
        given,
        speed=finite_number("speed", speed, above=0.0, most=SPEED_BOUND),
        leg=finite_number("leg", given.leg, least=1.0, most=1e3),
        turn=finite_number("turn", given.turn, least=0.0, most=90.0),
        climb=0.0 if vehicle.hydrostatics is not None else climb,
    )


class Parameters(NamedTuple):
    """Speed [m/s], leg [m], turn, climb [rad], depth of the start, length of the vehicle, corridor [m], period [s]."""

    speed: float
    leg: float
    turn: float
    climb: float
    depth: float
    length: float
    corridor: float
    period: float


class Memory(NamedTuple):
    """Control points of the path in NED [m], parameter of the nearest point (0 to `SPANS`), distance to it [m].

    Also the speed along the path [m/s]; and since errors count: the largest distance [m], the integral of the magnitude
    of the speed's error [m], and the time [s].
    """

    controls: Any
    parameter: float
    distance: float
    speed: float
    worst: float
    slack: float
    counted: float


class Metrics(NamedTuple):
    """Distance from the path, its worst since errors count [m], mean speed error since then [m/s], share done."""

    cross_track_error: float
    worst_error: float
    mean_speed_error: float
    share_done: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: way made at the right speed near the path, nearness, success, effort."""

    progress: float = 0.6
    nearness: float = 0.4
    finish: float = 10.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    return Parameters(
        settings.speed,
        max(length * settings.leg, settings.speed * LEG_TIME),
        math.radians(settings.turn),
        math.radians(settings.climb),
        starting_depth(vehicle, LEAST_DEPTH),
        length,
        max(LEAST, CORRIDOR * length),
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start beside the path's beginning, under way about along it at half the speed or more."""
    course, speed = 2.0 * math.pi * uniforms[START_DRAWS], own.speed * (0.5 + 0.5 * uniforms[2])
    offset = START_OFFSET * own.length * (2.0 * uniforms[0] - 1.0)
    heading = course + START_TURN * (2.0 * uniforms[1] - 1.0)
    return under_way((-offset * math.sin(course), offset * math.cos(course), own.depth), heading, speed)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new path, and where the vehicle is beside it."""
    controls = wind((0.0, 0.0, own.depth), own.leg, own.turn, own.climb, uniforms, START_DRAWS)
    here = beside(point_at(controls, 0.0), Motion(*begun))
    return Memory(controls, 0.0, here.distance, here.speed, 0.0, 0.0, 0.0)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the nearest point one control period on, and the errors there."""
    place = motion.position_ned
    parameter = nearer(memory.controls, nearer(memory.controls, memory.parameter, place), place)
    here = beside(point_at(memory.controls, parameter), motion)
    counting = select(parameter < ACQUIRED, 0.0, 1.0)
    return Memory(
        memory.controls,
        parameter,
        here.distance,
        here.speed,
        max(memory.worst, counting * here.distance),
        memory.slack + counting * own.period * abs(here.speed - own.speed),
        memory.counted + counting * own.period,
    )


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    here = point_at(memory.controls, memory.parameter)
    soon = point_at(memory.controls, min(memory.parameter + AHEAD, float(SPANS)))
    seen, attitude, far = beside(here, measured), measured.attitude, FAR * own.length
    return (
        bounded(seen.starboard, far),
        bounded(seen.below, far),
        bounded_vector(rotate_inverse(attitude, seen.axes.ahead_ned), 1.0),
        bounded_vector(rotate_inverse(attitude, scale(own.length, curvature(here))), STEEP),
        bounded_vector(rotate_inverse(attitude, scale(own.length, curvature(soon))), STEEP),
        bounded_vector(rotate_inverse(attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        spread(own.speed, seen.speed),
        bounded(own.speed - seen.speed, 2.0 * SPEED_BOUND),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = FAR * vehicle.dimensions.length
    return (
        Observed("starboard_of_path", "m", 1, far, "how far the vehicle is to starboard of the path"),
        Observed("below_path", "m", 1, far, "how far below it, square to it"),
        Observed("path_ahead_body", "", 3, 1.0, "where the path goes"),
        Observed("path_bend_body", "", 3, STEEP, "its curvature times the vehicle's length, to the inside"),
        Observed("path_bend_soon_body", "", 3, STEEP, "the same, a quarter of a leg ahead"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("commanded_speed", "m/s", 1, SPEED_BOUND, "along the path, over ground"),
        Observed("speed_error", "m/s", 1, 2.0 * SPEED_BOUND, "commanded speed less that along the path"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the vehicle is off, and along."""
    slower = memory.slack / max(memory.counted, own.period)
    return Metrics(memory.distance, memory.worst, slower, memory.parameter / SPANS)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms: gym-auv's speed along the path times nearness (Meyer et al. 2020), with a peak beside it."""
    near, pace = now.metrics.cross_track_error / own.length, now.memory.speed / own.speed
    return Rewards(
        weights.progress * max(-1.0, min(pace, 2.0 - pace)) * exponential(-near),
        weights.nearness * exponential(-10.0 * near),
        weights.finish * select(succeeded(own, now), 1.0, 0.0),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached, from the second leg on within a quarter length (0.5 m or more) and 10 % of speed."""
    near, slower = now.metrics.worst_error < own.corridor, SPEED_TOLERANCE * own.speed
    return near & (now.metrics.mean_speed_error < slower) & (now.memory.parameter >= SPANS)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached, or the path is lost."""
    return (now.memory.parameter >= SPANS) | (now.metrics.cross_track_error > LOST * own.length)


def scenery(own: Parameters, memory: Memory) -> Any:
    """Return the path, for drawing."""
    return curve_seen(lambda s: point_at(memory.controls, s).position_ned, float(SPANS), 0.04 * own.length)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the nearest point of the path and its course, for drawing."""
    return goal_along(*point_at(memory.controls, memory.parameter)[:2])


define_task(
    globals(),
    id="dq_marine/PathFollowing-v0",
    summary="Follow a smooth path at a commanded speed, in an unseen current.",
    draws=START_DRAWS + winding_draws(SPANS),
    units={"cross_track_error": "m", "worst_error": "m", "mean_speed_error": "m/s"},
    tolerances={"cross_track_error": LEAST},
    levels={
        "easy": {"turn": 20.0, "climb": 4.0, "current": 0.0},
        "medium": {"current": 0.3},
        "hard": {"turn": 45.0, "climb": 12.0, "current": 0.4, "randomise": "default", "sensors": "auv"},
        "waves": {"current": 0.3, "weather": sea_for(0.0075)},
    },
    unsuitable=unable_to_travel,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=1500,
)
