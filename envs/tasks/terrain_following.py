"""Terrain following: keep an altitude over an uneven seabed that beams tell of, along a track, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_cross, level_dot
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, norm
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import ground_seen
from dq_marine.task.starts import under_way
from dq_marine.task.tally import NOTHING_YET, Tally, counted, means
from dq_marine.task.world.beams import BOW, DOWN, ground_bearings, make_errors, make_fan, make_readings
from dq_marine.task.world.seabed import WAVE_DRAWS, Ground, make_seabed, make_under_keel

WAVES, BEAMS = 4, 6  # of the seabed; and beams, the last of which is the altimeter
AHEAD = BEAMS - 1
depth_at, cast, ground_drawn = make_seabed(WAVES)
under_keel, fan = make_under_keel(depth_at), make_fan(ground_bearings(BEAMS), cast, BOW, DOWN)
drawn_errors, readings = make_errors(BEAMS), make_readings(BEAMS)
EXACT = (0.0,) * BEAMS  # errors before there are readings
LEAST_DEPTH = 20.0  # of starts; ten lengths of long vehicles [m]
START_TURN, START_OFF, START_DRAWS = math.radians(20.0), 0.2, 4  # from the track [rad]; from the altitude [share]
ACQUIRED = 0.25  # share of the track from which on errors count
TOLERANCE, LEAST = 0.1, 0.15  # success: RMS error of the altitude below this share of it, or so many metres
SPEED_TOLERANCE = 0.1  # and the mean error of the speed below this [share of the speed]
LOST = 2.0  # episodes end farther than this beside the track or off the altitude [altitudes]
DISTURBED = {"randomise": "default", "sensors": "auv"}


@dataclass(frozen=True)
class Settings:
    """Speed along the track [m/s]; altitude, track, longest wave, reach of beams [vehicle lengths]; slope; errors.

    A speed of None is three fifths of what the vehicle reaches, or can steer at. `slope` bounds that of the seabed.
    `noise` is the standard deviation of readings [share of the reach], `dropout` the probability that one is lost, and
    reads as if nothing were there.
    """

    speed: float | None = None
    altitude: float = 4.0
    track: float = 50.0
    wave: float = 40.0
    slope: float = 0.4
    reach: float = 16.0
    noise: float = 0.005
    dropout: float = 0.02


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    speed = cruising_speed(vehicle) if given.speed is None else given.speed
    altitude = finite_number("altitude", given.altitude, least=1.0, most=1e2)
    return replace(
        given,
        speed=finite_number("speed", speed, above=0.0, most=SPEED_BOUND),
        altitude=altitude,
        track=finite_number("track", given.track, least=1.0, most=1e4),
        wave=finite_number("wave", given.wave, least=5.0, most=1e4),
        slope=finite_number("slope", given.slope, least=0.0, most=1.0),
        reach=finite_number("reach", given.reach, least=2.0 * altitude, most=1e3),
        noise=finite_number("noise", given.noise, least=0.0, most=1.0),
        dropout=finite_number("dropout", given.dropout, least=0.0, most=0.9),
    )


class Parameters(NamedTuple):
    """Speed [m/s]; altitude, track, longest wave [m]; slope; mean depth of the seabed, reach, noise [m]; dropout.

    Half the vehicle's length, and half its height [m]; tolerance of the altitude [m], control period [s].
    """

    speed: float
    altitude: float
    track: float
    wave: float
    slope: float
    depth: float
    reach: float
    noise: float
    dropout: float
    half_length: float
    half_height: float
    tolerance: float
    period: float


class Metrics(NamedTuple):
    """Altitude less that to keep, its RMS since errors count, clearance of the hull [m]; impact and speed error [m/s].

    The impact's is the speed over ground in contact, or 0; the speed's error is the mean since errors count.
    """

    altitude_error: float
    rms_error: float
    clearance: float
    impact_speed: float
    mean_speed_error: float
    share_done: float


class World(NamedTuple):
    """The seabed, and the course of the track, a unit vector."""

    ground: Ground
    course: Level


class Memory(NamedTuple):
    """World; ranges of the beams, errors of their readings [m]; what the last period gained along the track [m].

    Distance to starboard of the track [m]; squared altitude error and magnitude of the speed's, tallied; metrics.
    """

    world: World
    ranges: Any
    errors: Any
    gained: float
    starboard: float
    tally: Tally
    metrics: Metrics


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: way made at the right altitude, nearness to it, end, contact, effort."""

    progress: float = 0.4
    nearness: float = 0.6
    finish: float = 10.0
    contact: float = 20.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, size = context.vehicle, context.vehicle.dimensions
    altitude, wave = settings.altitude * size.length, settings.wave * size.length
    crest = settings.slope * wave / math.tau  # no wave is higher: a = s / k
    return Parameters(
        settings.speed,
        altitude,
        settings.track * size.length,
        wave,
        settings.slope,
        starting_depth(vehicle, LEAST_DEPTH) + altitude + crest,
        settings.reach * size.length,
        settings.noise * settings.reach * size.length,
        settings.dropout,
        0.5 * size.length,
        0.5 * size.height,
        max(LEAST, TOLERANCE * altitude),
        context.control_period,
    )


def drawn_ground(own: Parameters, uniforms: tuple[float, ...]) -> Ground:
    """Return the seabed of an episode."""
    return ground_drawn(own.depth, own.slope, own.wave, uniforms, START_DRAWS)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start about at the altitude, under way about along the track at half the speed or more."""
    heading = math.tau * uniforms[0] + START_TURN * (2.0 * uniforms[1] - 1.0)
    altitude = own.altitude * (1.0 + START_OFF * (2.0 * uniforms[2] - 1.0))
    depth = depth_at(drawn_ground(own, uniforms), 0.0, 0.0) - altitude
    return under_way((0.0, 0.0, depth), heading, own.speed * (0.5 + 0.5 * uniforms[3]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a new seabed, and what the beams meet of it."""
    ground, motion = drawn_ground(own, uniforms), Motion(*begun)
    course = (math.cos(math.tau * uniforms[0]), math.sin(math.tau * uniforms[0]))
    place, ranges = begun.position_ned, fan(ground, begun.position_ned, begun.attitude, own.reach)
    off = depth_at(ground, place[0], place[1]) - place[2] - own.altitude
    clearance = under_keel(ground, motion, own.half_length, own.half_height)
    metrics = Metrics(off, 0.0, clearance, 0.0, 0.0, 0.0)
    return Memory(World(ground, course), ranges, EXACT, 0.0, 0.0, NOTHING_YET, metrics)


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with new errors of the beams' readings."""
    errors = drawn_errors(own.noise, own.dropout, uniforms)
    return Memory(
        memory.world, memory.ranges, errors, memory.gained, memory.starboard, memory.tally, memory.metrics
    )


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return where the vehicle is over the seabed and along the track, and what the beams meet."""
    ground, course, place = memory.world.ground, memory.world.course, motion.position_ned
    over_ground = rotate(motion.attitude, motion.velocity.linear)
    speed = level_dot(course, (over_ground[0], over_ground[1]))
    along = level_dot(course, (place[0], place[1]))
    off = depth_at(ground, place[0], place[1]) - place[2] - own.altitude
    clearance = under_keel(ground, motion, own.half_length, own.half_height)
    errors = (off * off, abs(speed - own.speed), 0.0)
    tally = counted(memory.tally, along > ACQUIRED * own.track, errors, own.period)
    squared, slower, _ = means(tally, own.period)
    return Memory(
        memory.world,
        fan(ground, place, motion.attitude, own.reach),
        memory.errors,
        along - memory.metrics.share_done * own.track,
        level_cross(course, (place[0], place[1])),
        tally,
        Metrics(
            off,
            math.sqrt(squared),
            clearance,
            select(clearance < 0.0, norm(over_ground), 0.0),
            slower,
            along / own.track,
        ),
    )


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    course, attitude = memory.world.course, measured.attitude
    over_ground = rotate(attitude, measured.velocity.linear)
    told = readings(memory.ranges, memory.errors, own.reach)
    return (
        told[:AHEAD],
        told[AHEAD],
        spread(own.altitude / own.reach, memory.gained),
        bounded(level_cross(course, (measured.position_ned[0], measured.position_ned[1])), 2.0 * LOST * own.altitude),
        rotate_inverse(attitude, (course[0], course[1], 0.0)),
        rotate_inverse(attitude, (0.0, 0.0, 1.0)),
        observed_velocity(measured),
        spread(own.speed, memory.gained),
        bounded(own.speed - level_dot(course, (over_ground[0], over_ground[1])), 2.0 * SPEED_BOUND),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = 2.0 * LOST * settings.altitude * vehicle.dimensions.length
    return (
        Observed("ground_ahead_readings", "", AHEAD, 1.0, "free way of beams over the reach, the lowest last"),
        Observed("altimeter_reading", "", 1, 1.0, "the same of the beam straight down"),
        Observed("ordered_altitude", "", 1, 1.0, "the altitude to keep, over the reach"),
        Observed("starboard_of_track", "m", 1, far, "how far the vehicle is to starboard of the track"),
        Observed("track_ahead_body", "", 3, 1.0, "where the track goes, level"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("ordered_speed", "m/s", 1, SPEED_BOUND, "along the track, over ground"),
        Observed("speed_error", "m/s", 1, 2.0 * SPEED_BOUND, "ordered speed less that along the track"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far off the altitude is, and has been, and how hard the seabed was hit."""
    return memory.metrics


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    off = abs(now.metrics.altitude_error) / own.altitude
    pace = now.memory.gained / (own.speed * own.period)
    return Rewards(
        weights.progress * max(-1.0, min(pace, 2.0 - pace)) * math.exp(-2.0 * off),
        weights.nearness * math.exp(-10.0 * off),
        weights.finish * select(succeeded(own, now), 1.0, 0.0),
        -(weights.contact * select(now.metrics.clearance < 0.0, 1.0, 0.0)),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached at the pace and the altitude, without contact."""
    metrics = now.metrics
    kept = (metrics.rms_error < own.tolerance) & (metrics.mean_speed_error < SPEED_TOLERANCE * own.speed)
    return kept & (metrics.clearance >= 0.0) & (metrics.share_done >= 1.0)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached, the seabed is hit, or the vehicle has gone astray."""
    metrics, far = now.metrics, LOST * own.altitude
    lost = (abs(now.memory.starboard) > far) | (metrics.altitude_error > far)
    return (metrics.share_done >= 1.0) | (metrics.clearance < 0.0) | lost


def scenery(own: Parameters, memory: Memory) -> Any:
    """Return the seabed along the track, for drawing."""
    north, east = memory.world.course
    end = (own.track * north, own.track * east)
    return ground_seen(depth_at, memory.world.ground, ((0.0, 0.0), end), 3.0 * own.altitude)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the end of the track at its altitude, for drawing."""
    north, east = (own.track * part for part in memory.world.course)
    depth = depth_at(memory.world.ground, north, east) - own.altitude
    return goal_along((north, east, depth), (north, east, 0.0))


define_task(
    globals(),
    id="dq_marine/TerrainFollowing-v0",
    summary="Keep an altitude over an uneven seabed that beams tell of, along a track, in an unseen current.",
    draws=START_DRAWS + WAVES * WAVE_DRAWS,
    sense_draws=BEAMS,
    units={
        "altitude_error": "m",
        "rms_error": "m",
        "clearance": "m",
        "impact_speed": "m/s",
        "mean_speed_error": "m/s",
    },
    tolerances={"altitude_error": LEAST},
    levels={
        "easy": {"slope": 0.2, "noise": 0.0, "dropout": 0.0, "current": 0.0},
        "medium": {"current": 0.2},
        "hard": {"slope": 0.6, "noise": 0.01, "dropout": 0.1, "current": 0.3, **DISTURBED},
    },
    unsuitable=unable_to_dive_under_way,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=2000,
)
