"""Berthing: come alongside a quay without tugs, slowly enough for its fenders, in an unseen current and wind."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.level import level_length
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector, scale
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.proportion import current_for, wind_for
from dq_marine.envs.core.suitability import cruising_speed, paced, steers_only_under_way, unable_to_sail
from dq_marine.envs.kit import VELOCITY, EpisodeContext, ForVehicle, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.berths import (
    Berth,
    Berthing,
    Box,
    Harbour,
    before_berth,
    berthing_kept,
    clearance,
    contact_speed_of,
    from_berth,
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
PIERS = ForVehicle(
    lambda vehicle: 0.0 if steers_only_under_way(vehicle) else 1.0,
    "1 for vessels that can be moved sideways, else 0",
)
LOST = 2.0  # episodes end beyond this distance from the berth [of the farthest start's]


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
    usual = contact_speed_of(vehicle.dimensions.length, cruising_speed(vehicle))
    contact = usual if given.contact_speed is None else given.contact_speed
    offing = finite_number("offing", given.offing, least=2.0, most=1e2)
    return replace(
        given,
        distance=finite_number("distance", given.distance, least=5.0, most=1e3),
        offing=offing,
        pier=finite_number("pier", given.pier, least=0.0, most=0.4 * offing),
        basin=finite_number("basin", given.basin, least=1.0, most=1e2),
        contact_speed=finite_number("contact_speed", contact, above=0.0, most=SPEED_BOUND),
    )


class Parameters(NamedTuple):
    """Farthest starts along and off [m], speed of starts [m/s], depth [m]; walls, box, contact speed [m/s].

    Also how far fenders give [m], for how long to be alongside, and the control period [s].
    """

    distance: float
    offing: float
    speed: float
    depth: float
    harbour: Harbour
    box: Box
    contact_speed: float
    give: float
    held: float
    period: float


class Memory(NamedTuple):
    """The berth, and what came of coming alongside."""

    berth: Berth
    berthing: Berthing


class Metrics(NamedTuple):
    """Distance from the berth along the quay, clearance from walls [m], angle to it [rad], speed of impact [m/s]."""

    along_error: float
    clearance: float
    heading_error: float
    impact_speed: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: nearness along and across, angle, berthed, struck, effort."""

    nearness: float = 0.4
    precision: float = 0.3
    heading: float = 0.2
    berthed: float = 50.0
    struck: float = 20.0
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    vehicle, length = context.vehicle, context.vehicle.dimensions.length
    adrift, cruising, contact = steers_only_under_way(vehicle), cruising_speed(vehicle), settings.contact_speed
    along, across = WIDE_BOX if adrift else BOX
    hull = Hull(0.5 * length, 0.5 * vehicle.dimensions.width)
    return Parameters(
        length * settings.distance,
        length * settings.offing,
        cruising,
        starting_depth(vehicle, 0.0),
        Harbour(
            hull, 0.5 * across * length, length * settings.pier, length * settings.basin, length * THICKNESS
        ),
        Box(
            along * length,
            across * length,
            PARALLEL,
            max(contact, DRIFTING * cruising) if adrift else contact,
        ),
        contact,
        GIVE * length,
        HELD * context.control_period,
        context.control_period,
    )


def berth_drawn(uniforms: tuple[float, ...]) -> Berth:
    """Return a berth at any heading, with the quay on either side."""
    course = math.tau * uniforms[0]
    return Berth(math.cos(course), math.sin(course), 1.0 if uniforms[1] < 0.5 else -1.0)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start astern of the berth and off the quay, under way about along it at half the speed or more."""
    berth, (first, least) = berth_drawn(uniforms), NEAREST
    along = -own.distance * (first + (1.0 - first) * uniforms[2])
    off = own.offing * (least + (1.0 - least) * uniforms[3])
    north, east = from_berth(own.harbour, berth, along, off)
    heading = math.tau * uniforms[0] + START_TURN * (2.0 * uniforms[4] - 1.0)
    return under_way((north, east, own.depth), heading, own.speed * (0.5 + 0.5 * uniforms[5]))


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return the berth, and that nothing has come of it yet."""
    berth = berth_drawn(uniforms)
    room = clearance(own.harbour, before_berth(own.harbour, berth, Motion(*begun)))
    return Memory(berth, Berthing(room, 0.0, 0.0, 0.0))


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return what came of a control period."""
    here = before_berth(own.harbour, memory.berth, motion)
    kept = berthing_kept(
        own.harbour, own.box, own.contact_speed, own.give, memory.berthing, here, own.period
    )
    return Memory(memory.berth, kept)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    attitude, (north, east, side) = measured.attitude, memory.berth
    here = before_berth(own.harbour, memory.berth, measured)
    far, ahead = 2.0 * LOST * own.distance, (north, east, 0.0)
    place = measured.position_ned
    return (
        bounded_vector(
            rotate_inverse(attitude, (-place[0], -place[1], own.depth - place[2])), far
        ),
        rotate_inverse(attitude, ahead),
        rotate_inverse(attitude, (-east, north, 0.0)),
        observed_velocity(measured),
        rotate_inverse(attitude, (0.0, 0.0, 1.0)),
        rotate_inverse(attitude, scale(side, (-east, north, 0.0))),
        bounded(clearance(own.harbour, here), far),
        spread(own.harbour.pier, north),
        spread(own.harbour.basin, north),
        spread(own.contact_speed, north),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of: all in the body frame."""
    length = vehicle.dimensions.length
    far = 2.0 * LOST * length * settings.distance
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
        Observed("contact_speed_limit", "m/s", 1, SPEED_BOUND, "how fast the hull may touch the fenders"),
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return how far and how well the vessel is before its berth."""
    here = before_berth(own.harbour, memory.berth, motion)
    berthing = memory.berthing
    return Metrics(
        abs(here.place[0]), berthing.clearance, abs(here.off_parallel), berthing.impact_speed
    )


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    off = before_berth(own.harbour, now.memory.berth, now.motion).place
    along, aside = off[0], off[1] - own.harbour.hull.half_beam - own.harbour.clearance
    distance, turned = level_length((along, aside)), now.metrics.heading_error / PARALLEL
    return Rewards(
        nearness=weights.nearness * math.exp(-distance / (0.5 * own.distance)),
        precision=weights.precision * math.exp(-distance / own.harbour.hull.half_length),
        heading=weights.heading * math.exp(-turned * turned),
        berthed=weights.berthed * select(succeeded(own, now), 1.0, 0.0),
        struck=-(weights.struck * now.memory.berthing.struck),
        effort=effort(weights.effort, now),
    )


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vessel is berthed, has struck a wall, or is lost."""
    place = now.motion.position_ned
    lost = level_length((place[0], place[1])) > LOST * own.distance
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
    units={"along_error": "m", "clearance": "m", "heading_error": "rad", "impact_speed": "m/s"},
    levels={
        "easy": {"current": 0.0, "weather": []},
        "medium": {"current": current_for(0.03), "weather": wind_for(1.0)},
        "hard": {"current": current_for(0.05), "weather": wind_for(1.5), "pier": PIERS, "randomise": "default"},
    },
    unsuitable=unable_to_sail,
    vehicle="osv83",
    control_period=paced,
    max_episode_steps=2500,
)
