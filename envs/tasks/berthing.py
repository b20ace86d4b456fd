"""Berthing: come alongside a quay without tugs, slowly enough for its fenders, in an unseen current and wind."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3, bounded, bounded_vector, scale, subtract
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.proportion import disturbed
from dq_marine.envs.core.suitability import cruising_speed, paced, steers_only_under_way, unable_to_berth
from dq_marine.envs.kit import VELOCITY, EpisodeContext, ForVehicle, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task import berths
from dq_marine.task.berths import (
    Berth,
    Berthing,
    berthing_kept,
    drawn_berth,
    first_berthing,
    from_berth,
    merits,
    room_left,
)
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import harbour_seen
from dq_marine.task.starts import under_way
from dq_marine.task.world.pillars import Hull

# The box of vessels that can be moved sideways, and of those that cannot: along, across the quay [lengths], speed.
BOX, WIDE_BOX = (0.1, 0.03), (0.25, 0.25)
PARALLEL, HELD = math.radians(5.0), 10.0  # the box's angle [rad]; for how long in it [control periods]
DRIFTING = 0.05  # speed of those that cannot be moved sideways, if more than that of contact [cruising speed]
GIVE, THICKNESS = 0.02, 0.25  # how far fenders can be pressed in; thickness of piers [lengths]
NEAREST = (0.58, 0.4)  # starts: from these shares of distance and offing on
START_TURN, START_DRAWS = math.radians(15.0), 6  # heading of starts, off the quay's [rad]
PIERS = ForVehicle(lambda one: 0.0 if steers_only_under_way(one) else 1.0, "1, but 0 if nothing drives sway")
LOST, FAR = 2.0, 0.5  # episodes end beyond this distance; nearness is 1/e at this one [farthest starts']


@dataclass(frozen=True)
class Settings:
    """Starts up to this far along the quay and off it, length of piers, half the room between [vessel lengths].

    A pier of 0 is none. A contact speed of None [m/s] is the vessel's by `dq_marine.task.berths`.
    """

    distance: float = 12.0
    offing: float = 5.0
    pier: float = 0.0
    basin: float = 1.5
    contact_speed: float | None = None


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings for a vehicle, checked."""
    usual = berths.contact_speed_of(vehicle.dimensions.length, cruising_speed(vehicle))
    contact = usual if given.contact_speed is None else given.contact_speed
    return replace(
        given,
        distance=finite_number("distance", given.distance, least=5.0, most=1e3),
        offing=finite_number("offing", given.offing, least=3.0, most=1e2),
        pier=finite_number("pier", given.pier, least=0.0, most=1.0),
        basin=finite_number("basin", given.basin, least=1.0, most=1e2),
        contact_speed=finite_number("contact_speed", contact, above=0.0, most=SPEED_BOUND),
    )


class Parameters(NamedTuple):
    """Farthest starts along and off [m], their speed [m/s], depth [m]; walls, box, limits; time in it, period [s]."""

    distance: float
    offing: float
    speed: float
    depth: float
    harbour: berths.Harbour
    box: berths.Box
    limits: berths.Limits
    held: float
    period: float


class Memory(NamedTuple):
    """The berth, what came of coming alongside, and its merits, with what they gained in the control period."""

    berth: Berth
    berthing: Berthing
    merits: Vector3
    gained: Vector3


class Metrics(NamedTuple):
    """Distance from the berth, that along the quay, clearance from walls [m], angle [rad], speed of impact [m/s]."""

    distance: float
    along_error: float
    clearance: float
    heading_error: float
    impact_speed: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: gains of nearness, far off and close by, of heading; ends; effort."""

    nearness: float = 30.0
    precision: float = 10.0
    heading: float = 5.0
    berthed: float = 50.0
    struck: float = 20.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length, contact = context.vehicle, context.vehicle.dimensions.length, settings.contact_speed
    cruising, steers = cruising_speed(vehicle), steers_only_under_way(vehicle)
    along, across = WIDE_BOX if steers else BOX
    slow = max(contact, DRIFTING * cruising) if steers else contact
    hull, clear = Hull(0.5 * length, 0.5 * vehicle.dimensions.width), 0.5 * across * length
    return Parameters(
        length * settings.distance,
        length * settings.offing,
        cruising,
        starting_depth(vehicle, 0.0),
        berths.Harbour(hull, clear, length * settings.pier, length * settings.basin, length * THICKNESS),
        berths.Box(along * length, across * length, PARALLEL, slow),
        berths.Limits(contact, GIVE * length),
        HELD * context.control_period,
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start astern of the berth and off the quay, under way about along it at half the speed or more."""
    along = -own.distance * (NEAREST[0] + (1.0 - NEAREST[0]) * uniforms[2])
    off = own.offing * (NEAREST[1] + (1.0 - NEAREST[1]) * uniforms[3])
    north, east = from_berth(own.harbour, drawn_berth(uniforms, 0), along, off)
    heading = math.tau * uniforms[0] + START_TURN * (2.0 * uniforms[4] - 1.0)
    return under_way((north, east, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[5]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return the berth, and that nothing has come of it yet."""
    berth = drawn_berth(uniforms, 0)
    begins = first_berthing(own.harbour, berth, Motion(*begun))
    return Memory(berth, begins, merits(own.harbour, own.box, FAR * own.distance, begins), (0.0, 0.0, 0.0))


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return what came of a control period."""
    berth, before = memory.berth, memory.berthing
    came = berthing_kept(own.harbour, own.box, own.limits, berth, before, motion, own.period)
    merit = merits(own.harbour, own.box, FAR * own.distance, came)
    return Memory(berth, came, merit, subtract(merit, memory.merits))


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    attitude, (north, east, side) = measured.attitude, memory.berth
    far, starboard = 2.0 * LOST * own.distance, (-east, north, 0.0)
    to_berth = subtract((0.0, 0.0, own.depth), measured.position_ned)
    return (
        bounded_vector(rotate_inverse(attitude, to_berth), far),
        rotate_inverse(attitude, (north, east, 0.0)),
        rotate_inverse(attitude, starboard),
        observed_velocity(measured),
        rotate_inverse(attitude, (0.0, 0.0, 1.0)),
        rotate_inverse(attitude, scale(side, starboard)),
        bounded(room_left(own.harbour, memory.berth, measured), far),
        spread(own.harbour.pier, north),
        spread(own.harbour.basin, north),
        spread(own.limits.speed, north),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    length, far = vehicle.dimensions.length, 2.0 * LOST * vehicle.dimensions.length * settings.distance
    return (
        Observed("goal_position_body", "m", 3, far, "where the vessel's origin is when moored"),
        Observed("goal_x_axis_body", "", 3, 1.0, "where its bow points then"),
        Observed("goal_y_axis_body", "", 3, 1.0, "its starboard"),
        *VELOCITY,
        Observed("down_body", "", 3, 1.0, "where down is"),
        Observed("to_quay_body", "", 3, 1.0, "square to the quay, towards it"),
        Observed("wall_clearance", "m", 1, far, "how far the hull is from the nearest wall"),
        Observed("pier_length", "m", 1, 1e2 * length, "how far piers stand out from the quay; 0 for none"),
        Observed("half_basin", "m", 1, 1e2 * length, "from the middle of the berth to either pier"),
        Observed("contact_speed_limit", "m/s", 1, SPEED_BOUND, "how fast it may touch the fenders"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far and how well the vessel is before its berth."""
    came = memory.berthing
    return Metrics(came.distance, came.along, came.clearance, came.angle, came.impact_speed)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    nearer, closer, parallel = now.memory.gained
    return Rewards(
        nearness=weights.nearness * nearer,
        precision=weights.precision * closer,
        heading=weights.heading * parallel,
        berthed=weights.berthed * select(succeeded(own, now), 1.0, 0.0),
        struck=-(weights.struck * now.memory.berthing.struck),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vessel is berthed, has struck a wall, or is lost."""
    lost = now.metrics.distance > LOST * own.distance
    return succeeded(own, now) | (now.memory.berthing.struck > 0.5) | lost


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vessel has lain ten control periods beside the quay: parallel within 5 degrees, slow, unharmed."""
    berthing = now.memory.berthing
    return (berthing.alongside > own.held) & (berthing.struck < 0.5)


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the pose of the moored vessel, for drawing."""
    return goal_along((0.0, 0.0, own.depth), (memory.berth.north, memory.berth.east, 0.0))


define_task(
    globals(),
    id="dq_marine/Berthing-v0",
    summary="Come alongside a quay without tugs, slowly enough for its fenders, in an unseen current and wind.",
    draws=START_DRAWS,
    scenery=lambda own, memory: harbour_seen(own.harbour, memory.berth),
    units=dict.fromkeys(Metrics._fields, "m") | {"heading_error": "rad", "impact_speed": "m/s"},
    levels={
        "easy": {"current": 0.0, "weather": []},
        "medium": disturbed(0.03, 1.0),
        "hard": {**disturbed(0.05, 1.5), "pier": PIERS, "randomise": "default"},
    },
    unsuitable=unable_to_berth,
    vehicle="osv83",
    control_period=paced,
    max_episode_steps=2500,
)
