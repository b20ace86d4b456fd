"""Formation keeping: hold one's place behind a leader, among others that are known by an acoustic modem alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.level import level_bow
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number, one_of
from dq_marine.envs.core.observed import packets_shown
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import (
    CONTENTS,
    DRIFT_DRAWS,
    ERRING_DRAWS,
    Link,
    Modem,
    erring,
    first_modem,
    link_of,
    listened,
    packets_told,
)
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.formation import March, Winding, about_place, keeping, make_marches, places_from_own
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import formation_seen
from dq_marine.task.starts import under_way

SPANS, COUNTED = 4, 2.0  # of the leader's course, about a leg each; from when on errors count
march_draws, first, drawn, onward, formation = make_marches(SPANS)
SLOWER = 0.75  # speed of the leader, over that of journeys: others have to catch up
LEAST_DEPTH, LEAST_SPACING, LEAST_TOLERANCE = 20.0, 3.0, 1.0  # [m]
LEG, LEG_TIME = 3.0, 20.0  # of the leader's course: at least so long [spacings, s]
START_OFFSET, START_TURN, START_DRAWS = 0.3, math.radians(20.0), 4  # from one's place [spacings, rad]
TOLERANCE, SAFE = 0.5, 1.5  # success: never farther from one's place; nearer others are hit [lengths]
LOST, FAR = 5.0, 10.0  # episodes end beyond this distance from one's place; bound of what is shown [spacings]


@dataclass(frozen=True)
class Settings:
    """Spacing [vehicle lengths, 3 m at least]; turns and slopes of the leader's course [degrees]; and packets.

    Ranges have `noise` [m], packets are lost with the probability `dropout`, and tell by `contents`: "none", "course"
    (with speed and depth), or also "position", by the sender's navigation, which drifts by `drift` [m].
    """

    spacing: float = 4.0
    turn: float = 30.0
    climb: float = 4.0
    noise: float = 0.2
    dropout: float = 0.1
    contents: str = "position"
    drift: float = 2.0


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
    )


class Parameters(NamedTuple):
    """Speed [m/s]; spacing, depth [m]; leader's course; packets; safe distance, tolerance [m]; period [s]."""

    speed: float
    spacing: float
    depth: float
    winding: Winding
    link: Link
    safe: float
    tolerance: float
    period: float


class Metrics(NamedTuple):
    """Distance from one's place [m], bow off the course there [rad], nearest other, worst error [m]; share done."""

    slot_error: float
    heading_error: float
    nearest_distance: float
    worst_error: float
    share_done: float


class Memory(NamedTuple):
    """The leader's course and who is where, one's own modem, and the metrics."""

    march: March
    modem: Modem
    metrics: Metrics


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: nearness to one's place, far and close; ends; effort."""

    nearness: float = 0.6
    closeness: float = 0.4
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
    leg, turn, climb = max(LEG * spacing, LEG_TIME * speed), settings.turn, settings.climb
    return Parameters(
        speed,
        spacing,
        starting_depth(vehicle, LEAST_DEPTH),
        Winding(leg, math.radians(turn), math.radians(climb)),
        link_of(settings.noise, settings.dropout, settings.contents, settings.drift, period),
        SAFE * length,
        max(LEAST_TOLERANCE, TOLERANCE * length),
        period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start about one's place in the formation, under way about along its course."""
    course, place = first(own.spacing, uniforms, START_DRAWS)
    north, east = about_place(place, START_OFFSET * own.spacing, course, uniforms, 0)
    heading = course + START_TURN * (2.0 * uniforms[2] - 1.0)
    return under_way((north, east, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[3]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new course of the leader, with nothing heard yet."""
    march = drawn(own.spacing, (0.0, 0.0, own.depth), own.winding, uniforms, START_DRAWS)
    here = keeping(formation(march, own.speed), Motion(*begun))
    metrics = Metrics(here.off, here.turned, here.nearest, 0.0, 0.0)
    return Memory(march, first_modem(own.link, uniforms, START_DRAWS + march_draws), metrics)


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with the errors of a packet that is sent now, and of navigations."""
    return Memory(memory.march, erring(own.link, memory.modem, uniforms, own.period), memory.metrics)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where all are one control period on, and what has been heard."""
    march = onward(memory.march, own.speed * own.period)
    now = formation(march, own.speed)
    modem, here = listened(own.link, memory.modem, motion, now.others, own.period), keeping(now, motion)
    worst = select(march.parameter < COUNTED, 0.0, max(memory.metrics.worst_error, here.off))
    return Memory(march, modem, Metrics(here.off, here.turned, here.nearest, worst, march.parameter / SPANS))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    bow, far = level_bow(measured.attitude), FAR * own.spacing
    return (
        packets_told(own.link, memory.modem, measured, bow, far),
        places_from_own(memory.march.places),
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
        *packets_shown(far),
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
        weights.nearness * exponential(-off / own.spacing),
        weights.closeness * exponential(-near * near),
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


define_task(
    globals(),
    id="dq_marine/FormationKeeping-v0",
    summary="Keep one's place in a formation that an acoustic modem tells of, in an unseen current.",
    draws=START_DRAWS + march_draws + DRIFT_DRAWS,
    sense_draws=ERRING_DRAWS,
    goal=lambda own, memory: goal_along(*formation(memory.march, own.speed).own),
    scenery=lambda own, memory: formation_seen(formation(memory.march, own.speed).others, own.safe / SAFE),
    units={"slot_error": "m", "worst_error": "m", "heading_error": "rad", "nearest_distance": "m"},
    tolerances={"slot_error": LEAST_TOLERANCE},
    levels={
        "easy": {"turn": 15.0, "climb": 0.0, "noise": 0.05, "dropout": 0.0, "current": 0.0},
        "medium": {"current": 0.1},
        "hard": {"climb": 0.0, "dropout": 0.2, "contents": "none", "current": 0.2},
    },
    unsuitable=unable_to_dive_under_way,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=3500,
)
