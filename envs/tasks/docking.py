"""Docking: bring the bow through a funnel into a dock that heaves, slowly enough, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.vector3 import Vector3, bounded_vector, norm, subtract
from dq_marine.checks import finite_number
from dq_marine.envs.core import suitability
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, steers_only_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along, spread
from dq_marine.integrator.body import Motion
from dq_marine.task import docks
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.docks import Contact, Dock, across, approach, contact, heave_of, later, merits
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import dock_seen
from dq_marine.task.starts import under_way

THROAT, LEAST_THROAT = 0.1, 0.1  # radius of the throat [lengths, but at least m]
CONE, FLARE = 1.0, math.radians(20.0)  # length of the funnel [lengths], angle of its wall (1)
ALIGNED = math.radians(15.0)  # of the bow with the dock
# Contact speed of vehicles that can stop, and that cannot [share of the cruising speed].
SLOW, UNDER_WAY = 0.5, 1.2
SIDEWAYS = 0.5  # speed across in contact, as a share of that limit
FARTHER = 3.0  # start vehicles that steer only under way, and from a narrower angle
LEAST_DEPTH = 20.0  # of docks; ten lengths of long vehicles [m]
LOST, FAR = 2.0, 0.5  # episodes end beyond this distance; nearness is 1/e at this one [starting distances]
START_TURN, START_DRAWS = math.radians(25.0), 5  # largest turn of a start away from the dock


@dataclass(frozen=True)
class Settings:
    """Distance of starts [vehicle lengths], half the angle they come from [degrees], heave of the dock, contact speed.

    Vehicles that only steer under way start at three times the distance, within a third of the angle. The dock heaves
    by an amplitude [throat radii] with a period [s]. A contact speed of None [m/s] is half the cruising speed, and six
    fifths of it for vehicles that only steer under way.
    """

    distance: float = 8.0
    angle: float = 45.0
    heave: float = 0.5
    heave_period: float = 8.0
    contact_speed: float | None = None


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    share = UNDER_WAY if steers_only_under_way(vehicle) else SLOW
    contact = share * cruising_speed(vehicle) if given.contact_speed is None else given.contact_speed
    return replace(
        given,
        distance=finite_number("distance", given.distance, least=3.0, most=1e3),
        angle=finite_number("angle", given.angle, least=0.0, most=80.0),
        heave=finite_number("heave", given.heave, least=0.0, most=1e2),
        heave_period=finite_number("heave_period", given.heave_period, least=1.0, most=1e3),
        contact_speed=finite_number("contact_speed", contact, above=0.0, most=10.0),
    )


class Parameters(NamedTuple):
    """Distance [m], half the angle [rad] and speed [m/s] of starts; from the vehicle's origin to its bow [m].

    The funnel; the dock, but for its course and phase; limits of contact; control period [s].
    """

    distance: float
    angle: float
    speed: float
    to_bow: float
    funnel: docks.Funnel
    dock: Dock
    limits: docks.Limits
    period: float


class Memory(NamedTuple):
    """The dock, what came of the bow's approach, and its merits, with what they gained in the control period."""

    dock: Dock
    contact: Contact
    merits: Vector3
    gained: Vector3


class Metrics(NamedTuple):
    """Distance of the bow from the throat, and from the dock's axis [m]; angle to it [rad]; impact's speed [m/s]."""

    distance: float
    cross_error: float
    angle_error: float
    impact_speed: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: gains of nearness, of place in the cone, of angle; ends; effort."""

    nearness: float = 30.0
    cone: float = 10.0
    angle: float = 5.0
    docked: float = 50.0
    struck: float = 20.0
    effort: float = 0.02


def starting_distance(settings: Any, vehicle: Any) -> float:
    """Return how far from the dock a vehicle starts [m]."""
    farther = FARTHER if steers_only_under_way(vehicle) else 1.0
    return float(farther * vehicle.dimensions.length * settings.distance)


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    narrower = 1.0 / FARTHER if steers_only_under_way(vehicle) else 1.0
    throat, depth = max(LEAST_THROAT, THROAT * length), starting_depth(vehicle, LEAST_DEPTH)
    return Parameters(
        starting_distance(settings, vehicle),
        narrower * math.radians(settings.angle),
        cruising_speed(vehicle) if steers_only_under_way(vehicle) else 0.0,
        0.5 * length,
        docks.Funnel(throat, CONE * length, math.tan(FLARE)),
        Dock(1.0, 0.0, depth, throat * settings.heave, 0.0, math.tau / settings.heave_period),
        docks.Limits(settings.contact_speed, SIDEWAYS * settings.contact_speed, ALIGNED),
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start before the mouth of the dock, with the bow about towards it."""
    course = 2.0 * math.pi * uniforms[0]
    bearing = course + own.angle * (2.0 * uniforms[1] - 1.0)
    slope = 0.5 * own.angle * (2.0 * uniforms[2] - 1.0)
    level, below = own.distance * math.cos(slope), own.distance * math.sin(slope)
    heading = bearing + START_TURN * (2.0 * uniforms[3] - 1.0)
    place = (-level * math.cos(bearing), -level * math.sin(bearing), own.dock.depth + below)
    return under_way(place, heading, own.speed)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return a dock."""
    course, phase = math.tau * uniforms[0], math.tau * uniforms[4]
    dock = Dock(math.cos(course), math.sin(course), own.dock.depth, own.dock.heave, phase, own.dock.rate)
    merit = merits(own.funnel, own.limits, FAR * own.distance, approach(dock, Motion(*begun), own.to_bow))
    return Memory(dock, Contact(-own.distance, 0.0, 0.0, 0.0), merit, (0.0, 0.0, 0.0))


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return the dock one control period on, and whether the bow is in it or has struck it."""
    dock = later(memory.dock, own.period)
    bow = approach(dock, motion, own.to_bow)
    met = contact(own.funnel, own.limits, memory.contact.ahead, bow)
    merit = merits(own.funnel, own.limits, FAR * own.distance, bow)
    return Memory(dock, met, merit, subtract(merit, memory.merits))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    depth, sinking, acceleration = heave_of(memory.dock)
    north, east, attitude = memory.dock.north, memory.dock.east, measured.attitude
    to_dock = subtract((-own.to_bow * north, -own.to_bow * east, depth), measured.position_ned)
    return (
        bounded_vector(rotate_inverse(attitude, to_dock), 2.0 * LOST * own.distance),
        rotate_inverse(attitude, (north, east, 0.0)),
        rotate_inverse(attitude, (-east, north, 0.0)),
        observed_velocity(measured),
        bounded_vector(rotate_inverse(attitude, (0.0, 0.0, sinking)), SPEED_BOUND),
        bounded_vector(rotate_inverse(attitude, (0.0, 0.0, acceleration)), SPEED_BOUND),
        rotate_inverse(attitude, (0.0, 0.0, 1.0)),
        spread(own.funnel.throat, sinking),
        spread(own.limits.ahead, sinking),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    far = 2.0 * LOST * starting_distance(settings, vehicle)
    return (
        Observed("goal_position_body", "m", 3, far, "where the vehicle's origin is when docked"),
        Observed("goal_x_axis_body", "", 3, 1.0, "where the bow points then"),
        Observed("goal_y_axis_body", "", 3, 1.0, "its starboard"),
        *VELOCITY,
        Observed("dock_velocity_body", "m/s", 3, SPEED_BOUND, "how fast the dock goes"),
        Observed("dock_acceleration_body", "m/s^2", 3, SPEED_BOUND, "its acceleration"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        Observed("throat_radius", "m", 1, 1e3, "by how much the bow may be beside the dock's axis at last"),
        Observed("contact_speed_limit", "m/s", 1, SPEED_BOUND, "how fast the bow may come to the dock"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far and how well the bow is before the dock."""
    bow = approach(memory.dock, motion, own.to_bow)
    return Metrics(norm(bow.place), across(bow.place), bow.angle, memory.contact.speed)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    nearer, inward, aligned = now.memory.gained
    return Rewards(
        nearness=weights.nearness * nearer,
        cone=weights.cone * inward,
        angle=weights.angle * aligned,
        docked=weights.docked * now.memory.contact.docked,
        struck=-(weights.struck * now.memory.contact.struck),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle is docked, has struck the dock, or is lost."""
    met = now.memory.contact.docked + now.memory.contact.struck
    return (met > 0.5) | (now.metrics.distance > LOST * own.distance)


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the bow is in the throat: slow enough, within 15 degrees, and has struck nothing."""
    return now.memory.contact.docked > 0.5


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the pose of the docked vehicle, for drawing."""
    north, east, depth = memory.dock.north, memory.dock.east, heave_of(memory.dock)[0]
    return goal_along((-own.to_bow * north, -own.to_bow * east, depth), (north, east, 0.0))


define_task(
    globals(),
    id="dq_marine/Docking-v0",
    summary="Bring the bow through a funnel into a dock that heaves, slowly enough, in an unseen current.",
    draws=START_DRAWS,
    scenery=lambda own, memory: dock_seen(memory.dock, own.funnel),
    collided=lambda own, memory: memory.contact.struck > 0.5,
    units={"distance": "m", "cross_error": "m", "angle_error": "rad", "impact_speed": "m/s"},
    levels={
        "easy": {"heave": 0.0, "angle": 20.0, "current": 0.0},
        "medium": {"current": 0.2},
        "hard": {"heave": 2.0, "angle": 60.0, "current": 0.3, "randomise": "default", "sensors": "auv"},
    },
    unsuitable=suitability.unable_to_dive_under_way,
    control_period=suitability.paced,
    max_episode_steps=900,
)
