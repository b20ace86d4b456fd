"""Formation keeping: hold one's place behind a leader, among others that are known by an acoustic modem alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.level import level_bow, level_turned
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number, one_of
from dq_marine.envs.core.observed import packets_shown
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import (
    CONTENTS,
    DRIFT_DRAWS,
    PACKET_DRAWS,
    SENDERS,
    Link,
    Modem,
    erring,
    first_modem,
    link_of,
    listened,
    packets_told,
)
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.formation import (
    Formation,
    Places,
    drawn_places,
    formation,
    keeping,
    make_advance,
    places_from_own,
)
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import formation_seen
from dq_marine.task.splines import make_spline, make_winding, winding_draws
from dq_marine.task.starts import under_way

SPANS = 4  # of the leader's course, about a leg each
(point_at, _), wind = make_spline(SPANS), make_winding(SPANS)
advanced = make_advance(point_at)
SLOWER = 0.75  # speed of the leader, over that of journeys: others have to catch up
LEAST_DEPTH, LEAST_SPACING, LEAST_TOLERANCE = 20.0, 3.0, 1.0  # [m]
LEG, LEG_TIME = 3.0, 20.0  # of the leader's course: at least so long [spacings, s]
START_OFFSET, START_TURN, START_DRAWS = 0.3, math.radians(20.0), 5  # from one's place [spacings, rad]
COUNTED = 2.0  # span from whose beginning on errors count
TOLERANCE, LOST = 0.5, 5.0  # success: never farther from one's place [lengths]; the end [spacings]
FAR = 10.0  # bound of what is shown: distances [spacings]


@dataclass(frozen=True)
class Settings:
    """Spacing [vehicle lengths, 3 m at least]; turns and slopes of the leader's course [degrees]; packets; collisions.

    Ranges have `noise` [m], a packet is lost with the probability `dropout`, and each vehicle has its turn to send for
    `slot` [s]. What packets say is one of "none", "course" (with speed and depth) and "position", which is by the
    sender's navigation and drifts by `drift` [m]. Vehicles nearer than `safe_distance` [vehicle lengths] collide.
    """

    spacing: float = 4.0
    turn: float = 30.0
    climb: float = 4.0
    noise: float = 0.2
    dropout: float = 0.1
    contents: str = "position"
    drift: float = 2.0
    slot: float = 1.0
    safe_distance: float = 1.5


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    return replace(
        given,
        spacing=finite_number("spacing", given.spacing, least=3.0, most=1e2),
        turn=finite_number("turn", given.turn, least=0.0, most=45.0),
        climb=finite_number("climb", given.climb, least=0.0, most=20.0),
        noise=finite_number("noise", given.noise, least=0.0, most=1e2),
        dropout=finite_number("dropout", given.dropout, least=0.0, most=0.9),
        contents=one_of("contents", given.contents, CONTENTS),
        drift=finite_number("drift", given.drift, least=0.0, most=1e2),
        slot=finite_number("slot", given.slot, least=1.0, most=60.0),
        safe_distance=finite_number("safe_distance", given.safe_distance, above=0.0, most=2.0),
    )


class Parameters(NamedTuple):
    """Speed [m/s], length, spacing, depth, leg [m], turn, climb [rad]; packets; safe distance, tolerance [m]; period [s]."""

    speed: float
    length: float
    spacing: float
    depth: float
    leg: float
    turn: float
    climb: float
    link: Link
    safe: float
    tolerance: float
    period: float


class Metrics(NamedTuple):
    """Distance from one's place, its worst since errors count [m], bow off the course there [rad], nearest other [m].

    Also the share of the leader's course that is done.
    """

    slot_error: float
    worst_error: float
    heading_error: float
    nearest_distance: float
    share_done: float


class Memory(NamedTuple):
    """Control points of the leader's course [m], its parameter; places; modem; start's depth [m]; metrics."""

    controls: Any
    parameter: float
    places: Places
    modem: Modem
    metrics: Metrics


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: nearness to one's place, far and close; bow along it; ends; effort."""

    nearness: float = 0.5
    closeness: float = 0.4
    heading: float = 0.1
    finish: float = 20.0
    collision: float = 50.0
    effort: float = 0.02


def spacing_of(settings: Any, vehicle: Any) -> float:
    """Return the spacing of the formation [m]."""
    return float(max(LEAST_SPACING, settings.spacing * vehicle.dimensions.length))


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length, period = context.vehicle, context.vehicle.dimensions.length, context.control_period
    speed, spacing = SLOWER * cruising_speed(vehicle), spacing_of(settings, vehicle)
    return Parameters(
        speed,
        length,
        spacing,
        starting_depth(vehicle, LEAST_DEPTH),
        max(LEG * spacing, LEG_TIME * speed),
        math.radians(settings.turn),
        math.radians(settings.climb),
        link_of(settings.noise, settings.dropout, settings.contents, settings.drift, settings.slot, period),
        settings.safe_distance * length,
        max(LEAST_TOLERANCE, TOLERANCE * length),
        period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start about one's place in the formation, under way about along its course."""
    course, place = math.tau * uniforms[START_DRAWS], drawn_places(own.spacing, uniforms[0]).own
    ahead = place[0] + START_OFFSET * own.spacing * (2.0 * uniforms[1] - 1.0)
    starboard = place[1] + START_OFFSET * own.spacing * (2.0 * uniforms[2] - 1.0)
    north, east = level_turned((ahead, starboard), course)
    heading = course + START_TURN * (2.0 * uniforms[3] - 1.0)
    return under_way((north, east, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[4]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new course of the leader, with nothing heard yet."""
    controls = wind((0.0, 0.0, own.depth), own.leg, own.turn, own.climb, uniforms, START_DRAWS)
    places = drawn_places(own.spacing, uniforms[0])
    modem = first_modem(own.link, uniforms, START_DRAWS + winding_draws(SPANS))
    here = keeping(formation(point_at(controls, 0.0), own.speed, places), Motion(*begun))
    return Memory(controls, 0.0, places, modem, Metrics(here.off, 0.0, here.turned, here.nearest, 0.0))


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with the errors of a packet that is sent now, and of navigations."""
    modem = erring(own.link, memory.modem, uniforms)
    return Memory(memory.controls, memory.parameter, memory.places, modem, memory.metrics)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where all are one control period on, and what has been heard."""
    parameter = advanced(memory.controls, memory.parameter, own.speed * own.period)
    now = formation(point_at(memory.controls, parameter), own.speed, memory.places)
    modem = listened(own.link, memory.modem, motion, now.others, own.period)
    here = keeping(now, motion)
    worst = select(parameter < COUNTED, 0.0, max(memory.metrics.worst_error, here.off))
    metrics = Metrics(here.off, worst, here.turned, here.nearest, parameter / SPANS)
    return Memory(memory.controls, parameter, memory.places, modem, metrics)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    bow, far = level_bow(measured.attitude), FAR * own.spacing
    return (
        packets_told(own.link, memory.modem, measured, bow, far),
        places_from_own(memory.places),
        bow,
        bounded(measured.position_ned[2] - own.depth, far),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        spread(own.speed, bow[0]),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = FAR * spacing_of(settings, vehicle)
    return (
        *packets_shown(SENDERS, far),
        Observed("places_from_own", "m", 6, far, "of the three, from one's own, along the leader's course"),
        Observed("bow_north_east", "", 2, 1.0, "where the bow points, by compass"),
        Observed("deeper_than_start", "m", 1, far, "one's own depth less that at which the formation starts"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("formation_speed", "m/s", 1, SPEED_BOUND, "at which the leader goes, as planned"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the vehicle is from its place and from others."""
    return memory.metrics


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    off, near = now.metrics.slot_error, 2.0 * now.metrics.slot_error / own.tolerance
    return Rewards(
        weights.nearness * math.exp(-off / own.spacing),
        weights.closeness * math.exp(-near * near),
        weights.heading * math.cos(now.metrics.heading_error),
        weights.finish * select(succeeded(own, now), 1.0, 0.0),
        -(weights.collision * select(now.metrics.nearest_distance < own.safe, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the leader's course is done, in the last half of it half a length (1 m or more) off at most, unhurt."""
    kept = (now.metrics.share_done >= 1.0) & (now.metrics.worst_error < own.tolerance)
    return kept & (now.metrics.nearest_distance >= own.safe)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the leader's course is done, vehicles collide, or the formation is lost."""
    over = (now.metrics.share_done >= 1.0) | (now.metrics.nearest_distance < own.safe)
    return over | (now.metrics.slot_error > LOST * own.spacing)


def now_at(own: Parameters, memory: Memory) -> Formation:
    """Return where all are, for drawing."""
    return formation(point_at(memory.controls, memory.parameter), own.speed, memory.places)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return one's own place, for drawing."""
    return goal_along(*now_at(own, memory).own)


define_task(
    globals(),
    id="dq_marine/FormationKeeping-v0",
    summary="Keep one's place in a formation that is known by an acoustic modem, in an unseen current.",
    draws=START_DRAWS + winding_draws(SPANS) + DRIFT_DRAWS,
    sense_draws=PACKET_DRAWS + DRIFT_DRAWS,
    scenery=lambda own, memory: formation_seen(now_at(own, memory).others, own.length),
    units={"slot_error": "m", "worst_error": "m", "heading_error": "rad", "nearest_distance": "m"},
    tolerances={"slot_error": LEAST_TOLERANCE},
    levels={
        "easy": {"turn": 15.0, "climb": 0.0, "noise": 0.05, "dropout": 0.0, "drift": 0.5, "current": 0.0},
        "medium": {"current": 0.1},
        "hard": {
            "turn": 40.0,
            "climb": 0.0,
            "noise": 0.5,
            "dropout": 0.3,
            "contents": "none",
            "current": 0.2,
        },
    },
    unsuitable=unable_to_dive_under_way,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=3500,
)
