"""Dynamic positioning: keep place and heading by the thrusters, in waves, wind and a current that is not seen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from dq_marine.envs.kit import (
    VELOCITY,
    EpisodeContext,
    Goal,
    Motion,
    Observed,
    Situation,
    Spatial,
    Start,
    Vector3,
    add_scaled,
    bounded_vector,
    define_task,
    effort,
    exponential,
    finite_number,
    norm,
    observed_velocity,
    quaternion_from_euler,
    rotate,
    rotate_inverse,
    seen_at,
    select,
    sine_and_cosine,
    subtract,
    unable_to_position,
)

POSITION, HEADING, HELD = 5.0, math.radians(5.0), 60.0  # on station within these, for that long [m, rad, s]
INTEGRAL_BOUND = 2000.0  # of the position error along each NED axis [m s]
DRIFT = 0.3  # largest component of a start's velocity over ground [m/s]
BELL = (2.0, 0.1)  # widths of the reward's bells [m, rad]


@dataclass(frozen=True)
class Settings:
    """Keywords of dynamic positioning.

    Attributes:
        start_radius: episodes start within this distance of the place to keep [m].
        watch_radius: of the circle beyond which an episode ends [m].
        heading: that is to be kept, in the middle of those drawn [rad]; the levels' weather comes from the north.
        heading_spread: headings are drawn within this on both sides [rad].
    """

    start_radius: float = 15.0
    watch_radius: float = 50.0
    heading: float = 0.0
    heading_spread: float = math.radians(20.0)


class Parameters(NamedTuple):
    """Depth of the place, radii of starts and of the watch circle [m], headings and their spread [rad], period [s]."""

    depth: float
    start_radius: float
    watch_radius: float
    heading: float
    heading_spread: float
    period: float


class Memory(NamedTuple):
    """Heading to keep [rad], integral of the position error in NED [m s], time on station [s]."""

    heading: float
    error_integral: Vector3
    on_station: float


class Metrics(NamedTuple):
    """Level distance to the place [m], and angle between the bow and the heading to keep, seen from above [rad]."""

    position_error: float
    heading_error: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: bells about place and heading, a slope from far away, effort."""

    position: float = 0.5
    heading: float = 0.3
    nearness: float = 0.2
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    watch = finite_number("watch_radius", settings.watch_radius, above=2.0 * POSITION, most=1e4)
    return Parameters(
        context.vehicle.equilibrium_depth,
        finite_number("start_radius", settings.start_radius, least=0.0, most=0.9 * watch),
        watch,
        finite_number("heading", settings.heading, least=-math.tau, most=math.tau),
        finite_number("heading_spread", settings.heading_spread, least=0.0, most=math.pi),
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start near the place, level, within 30 degrees of the headings, adrift."""
    bearing, distance = math.tau * uniforms[0], own.start_radius * math.sqrt(uniforms[1])
    place = (distance * math.cos(bearing), distance * math.sin(bearing), own.depth)
    turned = math.radians(30.0) * (2.0 * uniforms[2] - 1.0)
    velocity = (DRIFT * (2.0 * uniforms[3] - 1.0), DRIFT * (2.0 * uniforms[4] - 1.0), 0.0)
    return Start(
        place, quaternion_from_euler(0.0, 0.0, own.heading + turned), Spatial((0.0, 0.0, 0.0), velocity)
    )


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a heading to keep, and nothing else."""
    return Memory(own.heading + own.heading_spread * (2.0 * uniforms[5] - 1.0), (0.0, 0.0, 0.0), 0.0)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the integral of the error and the time on station, one control period on."""
    error = to_place(own, measured)
    total = bounded_vector(add_scaled(memory.error_integral, own.period, error), INTEGRAL_BOUND)
    off = measure(own, memory, motion)
    there = (off.position_error < POSITION) & (off.heading_error < HEADING)
    return Memory(memory.heading, total, select(there, memory.on_station + own.period, 0.0))


def to_place(own: Parameters, motion: Motion) -> Vector3:
    """Return the way to the place that is to be kept, on the level, in NED [m]."""
    north, east, _ = subtract((0.0, 0.0, own.depth), motion.position_ned)
    return (north, east, 0.0)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    attitude, (s, c) = measured.attitude, sine_and_cosine(memory.heading)
    return (
        bounded_vector(rotate_inverse(attitude, to_place(own, measured)), own.watch_radius),
        rotate_inverse(attitude, (c, s, 0.0)),
        rotate_inverse(attitude, (-s, c, 0.0)),
        observed_velocity(measured),
        rotate_inverse(attitude, memory.error_integral),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    rotated = math.sqrt(3.0) * INTEGRAL_BOUND * (1.0 + 1e-6)
    return (
        Observed(
            "goal_position_body", "m", 3, settings.watch_radius, "the place to keep, seen from the vessel"
        ),
        Observed("goal_x_axis_body", "", 3, 1.0, "the heading to keep"),
        Observed("goal_y_axis_body", "", 3, 1.0, "its starboard"),
        *VELOCITY,
        Observed("position_error_integral_body", "m s", 3, rotated, "summed up since the start, bounded"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far off place and heading are."""
    bow = rotate(motion.attitude, (1.0, 0.0, 0.0))
    s, c = sine_and_cosine(memory.heading)
    off = seen_at((c, s), (bow[0], bow[1]))
    return Metrics(norm(to_place(own, motion)), abs(off))


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    away, off = now.metrics.position_error / BELL[0], now.metrics.heading_error / BELL[1]
    return Rewards(
        position=weights.position * exponential(-away * away),
        heading=weights.heading * exponential(-off * off),
        nearness=weights.nearness * (1.0 - now.metrics.position_error / own.watch_radius),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vessel has left the watch circle."""
    return now.metrics.position_error > own.watch_radius


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vessel has been within 5 m of the place and 5 degrees of the heading for a minute."""
    return now.memory.on_station > HELD


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the pose to keep, for drawing."""
    return Goal((0.0, 0.0, own.depth), quaternion_from_euler(0.0, 0.0, memory.heading))


def weather(height: float, period: float, wind: float) -> list[dict[str, Any]]:
    """Return a sea and a gusty wind from the north: height [m], period [s], mean speed [m/s]."""
    return [
        {"kind": "sea", "height": height, "period": period, "direction": math.pi, "slow_drift": True},
        {"kind": "wind", "speed": wind, "direction_from": 0.0, "gusts": True},
    ]


define_task(
    globals(),
    id="dq_marine/DynamicPositioning-v0",
    summary="Keep place and heading by the thrusters, in waves, wind and an unseen current.",
    draws=6,
    units={"position_error": "m", "heading_error": "rad"},
    tolerances={"position_error": POSITION, "heading_error": HEADING},
    levels={
        "easy": {"current": 0.25, "weather": []},
        "medium": {"current": 0.5, "weather": weather(1.5, 7.0, 8.0)},
        "hard": {"current": 0.75, "weather": weather(2.5, 8.5, 12.0), "heading_spread": math.radians(40.0)},
    },
    unsuitable=unable_to_position,
    vehicle="osv83",
    surroundings={"actuation": "thrusters"},
    control_period=0.5,
    substeps=2,
    max_episode_steps=1200,
)
