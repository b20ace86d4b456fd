"""Waypoint tracking: visit a random sequence of waypoints, one after the other, in an unseen current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, bounded_vector, norm, subtract
from dq_marine.checks import finite_number
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, paced, unable_to_travel
from dq_marine.integrator.body import Motion
from dq_marine.task.common import effort, make_pick, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import line_seen
from dq_marine.task.starts import SLOW_START_DRAWS, make_walk, slow_start

WAYPOINTS, FIRST_DEPTH = 4, 20.0  # number, and depth of starts of vehicles that do not float [m]
pick, walk = make_pick(WAYPOINTS), make_walk(WAYPOINTS)


@dataclass(frozen=True)
class Settings:
    """Largest step between waypoints along each axis (a third of it down), radius of capture [vehicle lengths]."""

    spacing: float = 8.0
    capture_radius: float = 1.0


class Parameters(NamedTuple):
    """Depth of starts, largest step between waypoints along each axis, and radius of capture [m]."""

    depth: float
    step: Vector3
    capture_radius: float


class Memory(NamedTuple):
    """Waypoints in NED [m], number reached, distance to the next [m]; what the last period gained [m], and captured."""

    waypoints: Any
    reached: float
    distance: float
    gained: float
    captured: float


class Metrics(NamedTuple):
    """Distance to the next waypoint [m], and how many are reached."""

    waypoint_distance: float
    waypoints_reached: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: way made good [1/m], a waypoint reached, mean square of the action."""

    progress: float = 1.0
    waypoint: float = 5.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    spacing = length * finite_number("spacing", settings.spacing, above=0.0, most=1e3)
    radius = length * finite_number("capture_radius", settings.capture_radius, above=0.0, most=1e3)
    depth, climb = (vehicle.equilibrium_depth, 0.0) if vehicle.hydrostatics else (FIRST_DEPTH, spacing / 3.0)
    return Parameters(depth, (spacing, spacing, climb), radius)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a slow start near the origin, at any heading."""
    return slow_start((0.0, 0.0, own.depth), 0.25 * own.step[0], 0.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return new waypoints, none of them reached."""
    waypoints = walk(begun.position_ned, own.step, uniforms, SLOW_START_DRAWS)
    return Memory(waypoints, 0.0, norm(subtract(waypoints[0], begun.position_ned)), 0.0, 0.0)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the waypoints, with one more reached where the vehicle is near enough."""
    distance = norm(subtract(pick(memory.reached, memory.waypoints), motion.position_ned))
    captured = select((distance < own.capture_radius) & (memory.reached < WAYPOINTS), 1.0, 0.0)
    reached = memory.reached + captured
    left = norm(subtract(pick(reached, memory.waypoints), motion.position_ned))
    return Memory(memory.waypoints, reached, left, memory.distance - distance, captured)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    first = subtract(pick(memory.reached, memory.waypoints), measured.position_ned)
    second = subtract(pick(memory.reached + 1.0, memory.waypoints), measured.position_ned)
    return (
        bounded_vector(rotate_inverse(measured.attitude, first), 1e4),
        bounded_vector(rotate_inverse(measured.attitude, second), 1e4),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
        memory.reached / WAYPOINTS,
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    return (
        Observed("waypoint_body", "m", 3, 1e4, "the next waypoint, seen from the vehicle"),
        Observed("second_waypoint_body", "m", 3, 1e4, "the one after it"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
        Observed("share_reached", "", 1, 1.0, "share of the waypoints that are reached"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far on the way the vehicle is."""
    return Metrics(memory.distance, memory.reached)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    gained, captured = weights.progress * now.memory.gained, weights.waypoint * now.memory.captured
    return Rewards(gained, captured, effort(weights.effort, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether all waypoints are reached."""
    return now.memory.reached > WAYPOINTS - 0.5


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether all waypoints are reached, or the next one is out of reach."""
    return succeeded(own, now) | (now.memory.distance > 3.0 * own.step[0])


def scenery(own: Parameters, memory: Memory) -> Any:
    """Return straight lines from waypoint to waypoint, for drawing."""
    return line_seen(memory.waypoints, 0.1 * own.capture_radius)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the next waypoint, for drawing."""
    return Goal(pick(memory.reached, memory.waypoints))


define_task(
    globals(),
    id="dq_marine/WaypointTracking-v0",
    summary="Visit a random sequence of waypoints, one after the other, in an unseen current.",
    draws=SLOW_START_DRAWS + 3 * WAYPOINTS,
    units={"waypoint_distance": "m"},
    levels={
        "easy": {"spacing": 6.0, "current": 0.0},
        "medium": {"current": 0.3},
        "hard": {"spacing": 10.0, "current": 0.4, "randomise": "default", "sensors": "auv"},
    },
    unsuitable=unable_to_travel,
    control_period=paced,
    max_episode_steps=2500,
)
