"""Terrain following: keep an altitude over an uneven seabed that beams tell of, along a track, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import spread
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number
from dq_marine.envs.core import ground_settings
from dq_marine.envs.core.ground_settings import DISTURBED, OVER_GROUND, QUIET, GroundSettings, ground_flight
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, observed_velocity
from dq_marine.task.ground_flight import FlightRewards as Rewards
from dq_marine.task.ground_flight import GroundFlight, flight_rewards
from dq_marine.task.grounds import Grounds, ground_draws, ground_of
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import beams_seen, ground_seen
from dq_marine.task.starts import under_way
from dq_marine.task.tally import NOTHING_YET, Tally, counted, means
from dq_marine.task.tracks import on_track
from dq_marine.task.world.beams import fan_ahead, make_errors, make_fan, make_readings
from dq_marine.task.world.keel import make_keel_over

WAVES, BEAMS = 4, 6  # of the seabed; and beams, the last of which is the altimeter
drawn_errors, readings = make_errors(BEAMS), make_readings(BEAMS)
EXACT = (0.0,) * BEAMS  # errors before there are readings
START_TURN, START_OFF, START_DRAWS = math.radians(20.0), 0.2, 4  # from the track [rad], the altitude [share]
ACQUIRED = 0.25  # share of the track from which on errors count
TOLERANCE, LEAST = 0.04, 0.1  # success: RMS error of the altitude below this share of it, or so many metres
SPEED_TOLERANCE = 0.1  # and the mean error of the speed below this [share of the speed]
LOST = 2.0  # episodes end farther than this beside the track or off the altitude [altitudes]


@dataclass(frozen=True)
class Settings(GroundSettings):
    """Of flight over ground (`GroundSettings`), and the length of the track [vehicle lengths]."""

    track: float = 50.0


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    track = finite_number("track", given.track, least=1.0, most=1e4)
    flown = ground_settings.over_ground(given, vehicle)
    ground_settings.check_way(flown, "track", track * vehicle.dimensions.length)
    return replace(flown, track=track)


class Parameters(NamedTuple):
    """Flight over ground; length of the track, tolerance of the altitude [m]."""

    flight: GroundFlight
    track: float
    tolerance: float


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


class Memory(NamedTuple):
    """Seabed; course of the track, a unit vector; ranges of the beams, errors of their readings [m].

    What the last period gained along the track, distance to starboard of it [m]; squared altitude error and magnitude
    of the speed's, tallied; metrics.
    """

    ground: Any
    course: Level
    ranges: Any
    errors: Any
    gained: float
    starboard: float
    tally: Tally
    metrics: Metrics


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    flight, length = ground_flight(settings, context), context.vehicle.dimensions.length
    return Parameters(flight, settings.track * length, max(LEAST, TOLERANCE * flight.altitude))


def course_of(uniforms: tuple[float, ...]) -> Level:
    """Return the course of the track of an episode, a unit vector."""
    return math.cos(math.tau * uniforms[0]), math.sin(math.tau * uniforms[0])


def make_formulas(grounds: Grounds) -> dict[str, Any]:
    """Return the formulas that are about a kind of ground, by their names."""
    depth_at, whole, drawn = grounds.depth, grounds.whole, grounds.drawn
    keel_over, fan = make_keel_over(depth_at), make_fan(fan_ahead(BEAMS), grounds.cast)

    def drawn_ground(own: Parameters, uniforms: tuple[float, ...]) -> Any:
        return drawn(own.flight, math.tau * uniforms[0], own.track, uniforms, START_DRAWS)

    def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
        """Return a start about at the altitude, under way about along the track at half the speed or more."""
        heading = math.tau * uniforms[0] + START_TURN * (2.0 * uniforms[1] - 1.0)
        altitude = own.flight.altitude * (1.0 + START_OFF * (2.0 * uniforms[2] - 1.0))
        depth = depth_at(whole(own.flight, drawn_ground(own, uniforms)), 0.0, 0.0) - altitude
        return under_way((0.0, 0.0, depth), heading, own.flight.speed * (0.5 + 0.5 * uniforms[3]))

    def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
        """Return where the vehicle is over the seabed and along the track, and what the beams meet."""
        flight, here = own.flight, on_track(memory.course, motion)
        ground = whole(flight, memory.ground)
        over = keel_over(ground, motion, flight.keel)
        off, share = over.altitude - flight.altitude, here.along / own.track
        errors = (off * off, abs(here.speed - flight.speed), 0.0)
        tally = counted(memory.tally, share > ACQUIRED, errors, flight.period)
        squared, slower, _ = means(tally, flight.period)
        return Memory(
            memory.ground,
            memory.course,
            fan(ground, motion.position_ned, motion.attitude, flight.reach),
            memory.errors,
            here.along - memory.metrics.share_done * own.track,
            here.starboard,
            tally,
            Metrics(off, math.sqrt(squared), over.clearance, over.impact_speed, slower, share),
        )

    def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
        """Return a new seabed, and what the beams meet of it."""
        ground, nothing = drawn_ground(own, uniforms), Metrics(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        blank = Memory(ground, course_of(uniforms), EXACT, EXACT, 0.0, 0.0, NOTHING_YET, nothing)
        return update_memory(own, blank, Motion(*begun), Motion(*begun))

    return {"start": start, "initial_memory": initial_memory, "update_memory": update_memory}


formulas = ground_settings.formulas_by_ground(make_formulas, WAVES)
start, initial_memory, update_memory = formulas(Settings()).values()


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with new errors of the beams' readings."""
    errors = drawn_errors(own.flight.noise, own.flight.dropout, uniforms)
    return Memory(memory.ground, memory.course, memory.ranges, errors, *memory[4:])


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    flight, course, attitude = own.flight, memory.course, measured.attitude
    here = on_track(course, measured)
    return (
        readings(memory.ranges, memory.errors, flight.reach),
        spread(flight.altitude, here.along),
        bounded(here.starboard, 2.0 * LOST * flight.altitude),
        bounded_vector(rotate_inverse(attitude, (course[0], course[1], 0.0)), 1.0),
        bounded_vector(rotate_inverse(attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        spread(flight.speed, here.along),
        bounded(flight.speed - here.speed, 2.0 * SPEED_BOUND),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = 2.0 * LOST * settings.altitude * vehicle.dimensions.length
    return (
        Observed("ground_ahead_readings", "", BEAMS - 1, 1.0, "free way over the reach, the lowest last"),
        Observed("altimeter_reading", "", 1, 1.0, "the same of the beam straight down"),
        Observed("ordered_altitude", "m", 1, 0.5 * far / LOST, "the altitude to keep"),
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
    off = 2.0 * abs(now.metrics.altitude_error) / own.flight.altitude
    pace = now.memory.gained / (own.flight.speed * own.flight.period)
    return flight_rewards(weights, now, pace, off, succeeded(own, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached at the pace and the altitude, without contact."""
    metrics, slack = now.metrics, SPEED_TOLERANCE * own.flight.speed
    kept = (metrics.rms_error < own.tolerance) & (metrics.mean_speed_error < slack)
    return kept & (metrics.clearance >= 0.0) & (metrics.share_done >= 1.0)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the end is reached, the seabed is hit, or the vehicle has gone astray."""
    metrics, far = now.metrics, LOST * own.flight.altitude
    lost = (abs(now.memory.starboard) > far) | (metrics.altitude_error > far)
    return (metrics.share_done >= 1.0) | (metrics.clearance < 0.0) | lost


def scenery(own: Parameters, memory: Memory) -> Any:
    """Return the seabed along the track, for drawing."""
    north, east = memory.course
    track = ((0.0, 0.0), (own.track * north, own.track * east))
    return ground_seen(*ground_of(own.flight, memory.ground, WAVES), track, 3.0 * own.flight.altitude)


def beams(own: Parameters, memory: Memory) -> Any:
    """Return what the beams tell, for drawing."""
    return beams_seen(fan_ahead(BEAMS), readings, memory.ranges, memory.errors, own.flight.reach)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the end of the track at its altitude, for drawing."""
    north, east = (own.track * part for part in memory.course)
    depth_at, ground = ground_of(own.flight, memory.ground, WAVES)
    depth = depth_at(ground, north, east) - own.flight.altitude
    return goal_along((north, east, depth), (north, east, 0.0))


define_task(
    globals(),
    id="dq_marine/TerrainFollowing-v0",
    summary="Keep an altitude over an uneven seabed that beams tell of, along a track, in an unseen current.",
    draws=START_DRAWS + ground_draws(WAVES),
    schedule=ground_settings.make_schedule(BEAMS),
    sense_draws=BEAMS,
    units={name: "m/s" if "speed" in name else "m" for name in Metrics._fields[:-1]},
    tolerances={"altitude_error": LEAST},
    levels={"easy": {"slope": 0.3, **QUIET}, "medium": {"current": 0.2}, "hard": {"slope": 0.8, **DISTURBED}},
    **OVER_GROUND,
)
