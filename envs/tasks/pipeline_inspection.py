"""Pipeline inspection: follow a pipe on an uneven seabed by sonar and a detector, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.level import from_above
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded_vector, norm
from dq_marine.checks import finite_number
from dq_marine.envs.core import ground_settings
from dq_marine.envs.core.ground_settings import DISTURBED, OVER_GROUND, QUIET, GroundSettings, ground_flight
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Observed, define_task
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, observed_velocity
from dq_marine.task.ground_flight import FlightRewards as Rewards
from dq_marine.task.ground_flight import GroundFlight, flight_rewards
from dq_marine.task.grounds import Grounds, ground_draws, ground_of
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import along_curve, beams_seen, pipe_seen
from dq_marine.task.splines import make_spline, make_winding, winding_draws
from dq_marine.task.starts import under_way
from dq_marine.task.tally import NOTHING_YET, Tally, counted, means
from dq_marine.task.world import pipes
from dq_marine.task.world.beams import NO_ECHO, fan_across, make_fan, make_readings
from dq_marine.task.world.keel import make_keel_over
from dq_marine.task.world.pipes import LaidPipe, Sight, View, beside_pipe, detected, sight

WAVES, SPANS, BEAMS = 4, 4, 9  # of the seabed; of the pipe, about a leg each; the middle one is an altimeter
(point_at, nearer), wind = make_spline(SPANS), make_winding(SPANS)
(drawn_errors, exact), readings = pipes.make_view_errors(BEAMS), make_readings(BEAMS)
AHEAD, ASIDE, ANGLE = 1.0, 1.5, math.radians(60.0)  # of the bow, what the detector sees [altitudes, rad]
START_OFF, START_TURN, START_DRAWS = 0.2, math.radians(15.0), 4  # from place [altitudes] and course [rad]
ACQUIRED, LOST = 1.0, 2.0  # span from which on errors count; episodes end farther off than this [altitudes]
TOLERANCE, LEAST, ASKEW = 0.07, 0.1, math.radians(5.0)  # success: mean errors below [altitudes or m; rad]


@dataclass(frozen=True)
class Settings(GroundSettings):
    """Of flight over ground (`GroundSettings`); legs and radius of the pipe [vehicle lengths], its turns [degrees]."""

    altitude: float = 3.0
    slope: float = 0.3
    reach: float = 9.0
    leg: float = 12.0
    turn: float = 30.0
    pipe_radius: float = 0.15


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    leg = finite_number("leg", given.leg, least=1.0, most=1e3)
    flown = ground_settings.over_ground(given, vehicle)
    ground_settings.check_way(flown, "leg", SPANS * leg * vehicle.dimensions.length)
    return replace(
        flown,
        leg=leg,
        turn=finite_number("turn", given.turn, least=0.0, most=60.0),
        pipe_radius=finite_number("pipe_radius", given.pipe_radius, above=0.0, most=0.25),
    )


class Parameters(NamedTuple):
    """Flight over ground; legs [m], turns [rad] and radius [m] of the pipe; tolerance [m], bounds of the detector."""

    flight: GroundFlight
    leg: float
    turn: float
    radius: float
    tolerance: float
    ahead: float
    widest: Sight


class Metrics(NamedTuple):
    """To starboard of the pipe, height over its axis less the altitude [m], course over ground off the pipe's [rad].

    Means of their magnitudes since errors count; clearance of the hull [m], speed in contact, or 0 [m/s].
    """

    cross_track_error: float
    altitude_error: float
    course_error: float
    mean_cross_track_error: float
    mean_altitude_error: float
    mean_course_error: float
    clearance: float
    impact_speed: float
    share_done: float


class Memory(NamedTuple):
    """Seabed; control points of the pipe, seen from above [m]; what is seen of them, its errors; speed along [m/s]."""

    ground: Any
    controls: Any
    shown: View
    errors: View
    speed: float
    tally: Tally
    metrics: Metrics


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    flight, length = ground_flight(settings, context), context.vehicle.dimensions.length
    high, tolerance = flight.altitude, max(LEAST, TOLERANCE * flight.altitude)
    pipe = (settings.leg * length, math.radians(settings.turn), settings.pipe_radius * length)
    return Parameters(flight, *pipe, tolerance, AHEAD * high, Sight(ASIDE * high, ANGLE))


def make_formulas(grounds: Grounds) -> dict[str, Any]:
    """Return the formulas that are about a kind of ground, by their names."""
    depth_at, whole, drawn = grounds.depth, grounds.whole, grounds.drawn
    keel_over, (laid, cast_below) = make_keel_over(depth_at), pipes.make_pipe(grounds.along, grounds.cast)
    fan = make_fan(fan_across(BEAMS), cast_below)

    def drawn_ground(own: Parameters, uniforms: tuple[float, ...]) -> Any:
        course, index = math.tau * uniforms[START_DRAWS], START_DRAWS + winding_draws(SPANS)
        return drawn(own.flight, course, SPANS * own.leg, uniforms, index)

    def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
        """Return a start about over the pipe's beginning, under way about along it at half the speed or more."""
        course, off = math.tau * uniforms[START_DRAWS], START_OFF * own.flight.altitude
        aside, lower = off * (2.0 * uniforms[0] - 1.0), off * (2.0 * uniforms[1] - 1.0)
        north, east = -aside * math.sin(course), aside * math.cos(course)
        ground = whole(own.flight, drawn_ground(own, uniforms))
        depth = depth_at(ground, north, east) - own.radius - own.flight.altitude + lower
        heading = course + START_TURN * (2.0 * uniforms[2] - 1.0)
        return under_way((north, east, depth), heading, own.flight.speed * (0.5 + 0.5 * uniforms[3]))

    def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
        """Return where the vehicle is over the seabed and along the pipe, and what is seen of them."""
        controls, flight, place = memory.controls, own.flight, motion.position_ned
        ground = whole(flight, memory.ground)
        along = nearer(controls, nearer(controls, memory.metrics.share_done * SPANS, place), place)
        ahead = min(along + own.ahead / own.leg, float(SPANS))
        here, soon = point_at(controls, along), point_at(controls, ahead)
        pipe = laid(ground, from_above(here.position_ned), from_above(here.slope_ned), own.radius)
        by, over = beside_pipe(pipe, motion, flight.keel), keel_over(ground, motion, flight.keel)
        off, clearance = by.height - flight.altitude, min(over.clearance, by.clearance)
        errors = (abs(by.starboard), abs(off), abs(by.askew))
        tally = counted(memory.tally, along > ACQUIRED, errors, flight.period)
        cross, high, askew = means(tally, flight.period)
        impact = select(clearance < 0.0, norm(motion.velocity.linear), 0.0)
        seen = sight(motion, from_above(soon.position_ned), from_above(soon.slope_ned), own.ahead)
        metrics = Metrics(by.starboard, off, by.askew, cross, high, askew, clearance, impact, along / SPANS)
        view = View(fan(LaidPipe(ground, pipe), place, motion.attitude, flight.reach), seen)
        return Memory(memory.ground, controls, view, memory.errors, by.speed, tally, metrics)

    def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
        """Return a new seabed with a pipe, and what is seen of them."""
        controls = wind((0.0, 0.0, 0.0), own.leg, own.turn, 0.0, uniforms, START_DRAWS)
        zeros = Metrics(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        blank = Memory(drawn_ground(own, uniforms), controls, exact, exact, 0.0, NOTHING_YET, zeros)
        return update_memory(own, blank, Motion(*begun), Motion(*begun))

    return {"start": start, "initial_memory": initial_memory, "update_memory": update_memory}


formulas = ground_settings.formulas_by_ground(make_formulas, WAVES)
start, initial_memory, update_memory = formulas(Settings()).values()


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    """Return the memory with new errors of the beams' readings and of the detector."""
    errors = drawn_errors(own.flight.noise, own.flight.dropout, own.flight.altitude, uniforms)
    return Memory(memory.ground, memory.controls, memory.shown, errors, *memory[4:])


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    (ranges, seen), errors, flight = memory.shown, memory.errors, own.flight
    return (
        readings(ranges, errors.ranges, flight.reach),
        detected(seen, errors.sight, own.widest, errors.ranges[BEAMS] >= NO_ECHO),
        spread((own.ahead, flight.altitude, own.radius), memory.speed),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        spread(flight.speed, memory.speed),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    length, high = vehicle.dimensions.length, settings.altitude * vehicle.dimensions.length
    return (
        Observed("sonar_readings", "", BEAMS, 1.0, "free way over the reach, port to starboard, middle down"),
        Observed("pipe_seen", "", 1, 1.0, "1 where the detector sees the pipe; else 0, as what it tells"),
        Observed("pipe_starboard", "m", 1, ASIDE * high, "how far to starboard of the bow the pipe is ahead"),
        Observed("pipe_bearing", "rad", 1, ANGLE, "where it leads to there, from the bow to starboard"),
        Observed("pipe_ahead", "m", 1, AHEAD * high, "how far ahead that is"),
        Observed("ordered_altitude", "m", 1, high, "the height to keep over the pipe's axis"),
        Observed("pipe_radius", "m", 1, settings.pipe_radius * length, "of the pipe"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("ordered_speed", "m/s", 1, SPEED_BOUND, "along the pipe, over ground"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far off the vehicle is, and has been, and how hard it hit what is below."""
    return memory.metrics


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    metrics, pace = now.metrics, now.memory.speed / own.flight.speed
    off = (abs(metrics.cross_track_error) + abs(metrics.altitude_error)) / own.flight.altitude
    return flight_rewards(weights, now, pace, off, succeeded(own, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the end of the pipe is reached, near enough to it from the second leg on, without contact."""
    last, most = now.metrics, own.tolerance
    near = (last.mean_cross_track_error < most) & (last.mean_altitude_error < most)
    return near & (last.mean_course_error < ASKEW) & (last.clearance >= 0.0) & (last.share_done >= 1.0)


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the end of the pipe is reached, it or the seabed is hit, or the pipe is lost."""
    metrics, far = now.metrics, LOST * own.flight.altitude
    lost = (abs(metrics.cross_track_error) > far) | (metrics.altitude_error > far)
    return (metrics.share_done >= 1.0) | (metrics.clearance < 0.0) | lost


def scenery(own: Parameters, memory: Memory) -> Any:
    """Return the pipe and the seabed about it, for drawing."""
    way = along_curve(lambda s: point_at(memory.controls, s).position_ned, float(SPANS))
    return pipe_seen(*ground_of(own.flight, memory.ground, WAVES), way, own.radius, 2.0 * own.flight.altitude)


define_task(
    globals(),
    id="dq_marine/PipelineInspection-v0",
    summary="Follow a pipe on an uneven seabed by sonar and a detector, in an unseen current.",
    draws=START_DRAWS + winding_draws(SPANS) + ground_draws(WAVES),
    schedule=ground_settings.make_schedule(BEAMS),
    sense_draws=BEAMS + 3,
    units={n: "rad" if "course" in n else "m/s" if "speed" in n else "m" for n in Metrics._fields[:-1]},
    beams=lambda own, memory: beams_seen(
        fan_across(BEAMS), readings, memory.shown.ranges, memory.errors.ranges, own.flight.reach
    ),
    tolerances={"cross_track_error": LEAST, "altitude_error": LEAST},
    levels={"easy": {"slope": 0.15, "turn": 15.0, **QUIET}, "medium": {"current": 0.2}, "hard": DISTURBED},
    **OVER_GROUND,
)
