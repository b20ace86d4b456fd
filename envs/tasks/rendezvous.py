"""Rendezvous: meet a partner that an acoustic modem alone tells of, and stay beside it, at its speed and course."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.level import level_bow, level_turned
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number, one_of
from dq_marine.envs.core.observed import fixes_shown, packets_shown
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task import hearing
from dq_marine.task.acoustics import CONTENTS, Link
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.formation import Winding
from dq_marine.task.hearing import Hearing, disturbed, first_hearing, heard_from, partner_told
from dq_marine.task.meeting import Course, abreast, company, make_partners
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import formation_seen
from dq_marine.task.starts import under_way

SPANS, LEG = 3, 1.5  # of the partner's course, about a leg each: so long [starting distances]
course_draws, drawn, onward, partner = make_partners(SPANS)
SLOWER = 0.7  # speed of the partner, over that of journeys: others have to catch up
LEAST_DEPTH, LEAST_LENGTH = 20.0, 1.0  # [m]; shorter vehicles count as so long [m]
NEAREST, APART = 0.7, 0.1  # starts: least distance, largest difference in depth [starting distances]
START_TURN, START_DRAWS = math.radians(60.0), 5  # of the bow from the partner at most [rad]
SAFE, ROOM = 1.5, 1.5  # who is nearer has hit [lengths]; a partner is met within so many of these at least
SPEED_TOLERANCE, COURSE_TOLERANCE = 0.2, math.radians(15.0)  # success: of the partner's speed; [rad]
LOST, FAR, NEARER = 2.0, 4.0, 0.5  # ends beyond; bound of what is shown; nearness is 1/e [starting distances]


@dataclass(frozen=True)
class Settings:
    """Distance of starts, and within which one has met [vehicle lengths, of 1 m or more], and for how long [s].

    The partner's course has turns and slopes [degrees]. It sends a packet every `interval` [s], which is lost with the
    probability `dropout`. Ranges have `noise` [m], and packets tell by `contents`: "none", "course" (with speed and
    depth), or also "position", by the sender's navigation, which drifts by `drift` [m].
    """

    distance: float = 20.0
    meeting: float = 5.0
    hold: float = 20.0
    turn: float = 30.0
    climb: float = 4.0
    interval: float = 2.0
    noise: float = 0.2
    dropout: float = 0.1
    contents: str = "course"
    drift: float = 2.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    distance = finite_number("distance", given.distance, least=10.0, most=1e2)
    return replace(
        given,
        distance=distance,
        meeting=finite_number("meeting", given.meeting, least=ROOM * SAFE, most=0.5 * distance),
        hold=finite_number("hold", given.hold, above=0.0, most=1e3),
        turn=finite_number("turn", given.turn, least=0.0, most=45.0),
        climb=finite_number("climb", given.climb, least=0.0, most=20.0),
        interval=finite_number("interval", given.interval, least=1.0, most=60.0),
        noise=finite_number("noise", given.noise, least=0.0, most=1e2),
        dropout=finite_number("dropout", given.dropout, least=0.0, most=0.9),
        contents=one_of("contents", given.contents, CONTENTS),
        drift=finite_number("drift", given.drift, least=0.0, most=1e2),
    )


class Parameters(NamedTuple):
    """Distance of starts, depth [m]; partner's speed [m/s], course; packets; what is met, and safe [m]; times [s]."""

    distance: float
    depth: float
    speed: float
    winding: Winding
    link: Link
    meeting: float
    safe: float
    hold: float
    period: float


class Metrics(NamedTuple):
    """Distance to the partner [m], difference of speeds [m/s] and of courses [rad], time beside it [s]."""

    distance: float
    speed_error: float
    course_error: float
    held_time: float


class Memory(NamedTuple):
    """The partner's course, one's own modem, and the metrics."""

    course: Course
    hearing: Hearing
    metrics: Metrics


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: nearness; speed and course as the partner's, near it; ends; effort."""

    nearness: float = 0.5
    company: float = 0.5
    finish: float = 300.0  # to stay near for ever pays 100 to who discounts by 0.99
    collision: float = 50.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, size = context.vehicle, max(LEAST_LENGTH, context.vehicle.dimensions.length)
    distance, slot = size * settings.distance, max(settings.interval, context.control_period)
    turn, climb = math.radians(settings.turn), math.radians(settings.climb)
    return Parameters(
        distance,
        starting_depth(vehicle, LEAST_DEPTH + distance * (APART + SPANS * LEG * math.sin(climb))),
        SLOWER * cruising_speed(vehicle),
        Winding(LEG * distance, turn, climb),
        hearing.partner_link(settings.noise, settings.dropout, settings.contents, settings.drift, slot),
        size * settings.meeting,
        size * SAFE,
        settings.hold,
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start about the partner, which is at the origin, with the bow about towards it, under way."""
    distance, bearing = own.distance * (NEAREST + (1.0 - NEAREST) * uniforms[0]), math.tau * uniforms[1]
    north, east = level_turned((-distance, 0.0), bearing)
    depth = own.depth + APART * own.distance * (2.0 * uniforms[2] - 1.0)
    heading = bearing + START_TURN * (2.0 * uniforms[3] - 1.0)
    return under_way((north, east, depth), heading, own.speed * (0.5 + 0.5 * uniforms[4]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new course of the partner, with nothing heard yet."""
    course = drawn((0.0, 0.0, own.depth), own.winding, uniforms, START_DRAWS)
    off, faster, turned = company(partner(course, own.speed), Motion(*begun))
    unheard = first_hearing(own.link, uniforms, START_DRAWS + course_draws)
    return Memory(course, unheard, Metrics(off, faster, turned, 0.0))


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with the errors of a packet, where one is sent next."""
    return Memory(memory.course, disturbed(own.link, memory.hearing, uniforms, own.period), memory.metrics)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where the partner is one control period on, what has been heard of it, and for how long it is met."""
    course = onward(memory.course, own.speed * own.period)
    other = partner(course, own.speed)
    heard = heard_from(own.link, memory.hearing, motion, measured, other, own.period)
    off, faster, turned = company(other, motion)
    met = (off < own.meeting) & (off >= own.safe) & (turned < COURSE_TOLERANCE)
    held = select(met & (faster < SPEED_TOLERANCE * own.speed), memory.metrics.held_time + own.period, 0.0)
    return Memory(course, heard, Metrics(off, faster, turned, held))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    bow, far = level_bow(measured.attitude), FAR * own.distance
    return (
        partner_told(own.link, memory.hearing, measured, bow, far),
        bow,
        bounded(measured.position_ned[2] - own.depth, far),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        spread((own.speed, own.meeting, own.safe), bow[0]),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = FAR * max(LEAST_LENGTH, vehicle.dimensions.length) * settings.distance
    return (
        *packets_shown(far, 1),
        *fixes_shown(far),
        Observed("bow_north_east", "", 2, 1.0, "where the bow points, by compass"),
        Observed("deeper_than_plan", "m", 1, far, "one's own depth less that of the partner's start"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("partner_speed", "m/s", 1, SPEED_BOUND, "at which the partner goes, as planned"),
        Observed("meeting_distance", "m", 1, far, "within which one has met the partner"),
        Observed("safe_distance", "m", 1, far, "nearer, one has hit it"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far the vehicle is from the partner, and how it goes beside it."""
    return memory.metrics


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    off, faster, turned, _ = now.metrics
    near = exponential(-max(0.0, off - own.meeting) / (NEARER * own.distance))
    faster, turned = faster / (SPEED_TOLERANCE * own.speed), turned / COURSE_TOLERANCE
    return Rewards(
        weights.nearness * near,
        weights.company * near * near * exponential(-0.5 * (faster * faster + turned * turned)),
        weights.finish * select(succeeded(own, now), 1.0, 0.0),
        -(weights.collision * select(off < own.safe, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the partner is met for long enough: near, unhurt, within a fifth of its speed and 15 degrees."""
    return now.metrics.held_time >= own.hold - 0.5 * own.period


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the partner is met or hit, is farther than two starting distances, or at the end of its course."""
    over = succeeded(own, now) | (now.metrics.distance < own.safe) | (now.memory.course.parameter >= SPANS)
    return over | (now.metrics.distance > LOST * own.distance)


define_task(
    globals(),
    id="dq_marine/Rendezvous-v0",
    summary="Meet a partner that an acoustic modem tells of and stay beside it, in an unseen current.",
    draws=START_DRAWS + course_draws + hearing.FIRST_DRAWS,
    sense_draws=hearing.HEARING_DRAWS,
    goal=lambda own, memory: goal_along(*abreast(partner(memory.course, own.speed), own.safe, own.meeting)),
    scenery=lambda own, memory: formation_seen((partner(memory.course, own.speed),), own.safe / SAFE),
    collided=lambda own, memory: memory.metrics.distance < own.safe,
    units={"distance": "m", "speed_error": "m/s", "course_error": "rad", "held_time": "s"},
    levels={
        "easy": {"turn": 0.0, "climb": 0.0, "dropout": 0.0, "contents": "position", "current": 0.0},
        "medium": {"current": 0.1},
        "hard": {"climb": 0.0, "dropout": 0.2, "contents": "none", "current": 0.2},
    },
    unsuitable=unable_to_dive_under_way,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=3500,
)
