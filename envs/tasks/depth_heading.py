"""Depth and heading: the textbook autopilot, steps of depth, heading and speed under water, in an unseen current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.level import seen_at
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import bounded, bounded_vector
from dq_marine.checks import finite_number
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.envs.kit import VELOCITY, EpisodeContext, Goal, Observed, define_task, goal_along
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, effort, observed_velocity, peak
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.starts import under_way

STEPS, STEP_DRAWS = 3, 3  # orders in an episode, and random numbers for each
PERIODS = 300  # control periods of each order
FIRST_DEPTH, LEAST_DEPTH = 30.0, 5.0  # of starts (or ten lengths, if more), and of orders at least [m]
DEPTH, HEADING, SPEED = 0.3, math.radians(3.0), 0.1  # settled within these [m, rad, share of the cruise]
FAR_OFF = 0.5  # heading error from which on rewards tell little [rad]
HELD = 5.0  # success of an order: settled for that long [s]
LOST = 3.0  # episodes end beyond this error of depth [largest steps of depth]


@dataclass(frozen=True)
class Settings:
    """Largest steps of depth [vehicle lengths], heading [degrees] and speed [share of the cruising speed]."""

    depth_step: float = 4.0
    heading_step: float = 90.0
    speed_step: float = 0.2


def fitted(given: Settings, vehicle: Any) -> Settings:
    """Return the settings, checked."""
    return replace(
        given,
        depth_step=finite_number("depth_step", given.depth_step, above=0.0, most=1e2),
        heading_step=finite_number("heading_step", given.heading_step, least=0.0, most=180.0),
        speed_step=finite_number("speed_step", given.speed_step, least=0.0, most=0.5),
    )


class Parameters(NamedTuple):
    """Cruising speed [m/s], largest steps of depth [m], heading [rad] and speed [m/s], first depth [m], period [s]."""

    speed: float
    depth_step: float
    heading_step: float
    speed_step: float
    depth: float
    period: float


class Order(NamedTuple):
    """Depth [m], heading as north and east of a unit vector, speed along the bow over ground [m/s]."""

    depth: float
    north: float
    east: float
    speed: float


class Memory(NamedTuple):
    """The orders to come, that of now first; periods of it gone by, time settled [s], orders obeyed, orders given."""

    orders: Any
    periods: float
    settled: float
    obeyed: float
    given: float


class Metrics(NamedTuple):
    """Errors of depth [m], heading [rad] and speed [m/s], as magnitudes, and how many orders have been obeyed."""

    depth_error: float
    heading_error: float
    speed_error: float
    orders_obeyed: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: peaks at depth, heading and speed, wide at the foot; settled; effort."""

    depth: float = 0.4
    heading: float = 0.4
    speed: float = 0.2
    settled: float = 0.5
    effort: float = 0.02


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    length, cruise = context.vehicle.dimensions.length, cruising_speed(context.vehicle)
    return Parameters(
        cruise,
        max(1.0, length) * settings.depth_step,
        math.radians(settings.heading_step),
        cruise * settings.speed_step,
        starting_depth(context.vehicle, FIRST_DEPTH),
        context.control_period,
    )


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a start under way, level, at any heading."""
    return under_way((0.0, 0.0, own.depth), 2.0 * math.pi * uniforms[0], own.speed)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Return new orders, each a step away from the one before."""
    heading, depth = 2.0 * math.pi * uniforms[0], own.depth
    first, heading, depth = drawn_order(own, heading, depth, uniforms, 1)
    second, heading, depth = drawn_order(own, heading, depth, uniforms, 1 + STEP_DRAWS)
    third, heading, depth = drawn_order(own, heading, depth, uniforms, 1 + 2 * STEP_DRAWS)
    return Memory((first, second, third), 0.0, 0.0, 0.0, 1.0)


def drawn_order(
    own: Parameters, heading: float, depth: float, uniforms: tuple[float, ...], index: int
) -> Any:
    """Return an order a step away from a heading and a depth, and its own heading and depth."""
    depth = max(LEAST_DEPTH, depth + own.depth_step * (2.0 * uniforms[index] - 1.0))
    heading = heading + own.heading_step * (2.0 * uniforms[index + 1] - 1.0)
    speed = own.speed + own.speed_step * (2.0 * uniforms[index + 2] - 1.0)
    return Order(depth, math.cos(heading), math.sin(heading), speed), heading, depth


def errors(order: Order, motion: Motion) -> tuple[float, float, float]:
    """Return how much deeper [m], further to starboard [rad] and faster [m/s] a vehicle should be."""
    bow = rotate(motion.attitude, (1.0, 0.0, 0.0))
    turn = seen_at((bow[0], bow[1]), (order.north, order.east))
    return (order.depth - motion.position_ned[2], turn, order.speed - motion.velocity.linear[0])


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Return how long the order is settled; and the next one where its time is over."""
    deeper, turn, faster = errors(memory.orders[0], motion)
    near = (abs(deeper) < DEPTH) & (abs(turn) < HEADING) & (abs(faster) < SPEED * own.speed)
    settled = select(near, memory.settled + own.period, 0.0)
    over = (memory.periods >= PERIODS - 1.0) & (memory.given < STEPS)
    first, second, third = memory.orders
    return Memory(
        select(over, (second, third, third), (first, second, third)),
        select(over, 0.0, memory.periods + 1.0),
        select(over, 0.0, settled),
        memory.obeyed + select(over & (memory.settled >= HELD), 1.0, 0.0),
        memory.given + select(over, 1.0, 0.0),
    )


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    """Return what `observations` lists."""
    deeper, turn, faster = errors(memory.orders[0], measured)
    sine, cosine = sine_and_cosine(turn)
    return (
        bounded(deeper, 4.0 * LOST * own.depth_step),
        (cosine, sine),
        bounded(faster, 2.0 * SPEED_BOUND),
        spread(memory.orders[0].speed, turn),
        bounded_vector(rotate_inverse(measured.attitude, (0.0, 0.0, 1.0)), 1.0),
        observed_velocity(measured),
    )


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    far = 4.0 * LOST * max(1.0, vehicle.dimensions.length) * settings.depth_step
    return (
        Observed("deeper", "m", 1, far, "by how much the vehicle should be deeper"),
        Observed("turn_cosine_sine", "", 2, 1.0, "cosine and sine of the turn to starboard that is left"),
        Observed(
            "speed_error", "m/s", 1, 2.0 * SPEED_BOUND, "by how much it should be faster, along the bow"
        ),
        Observed("ordered_speed", "m/s", 1, SPEED_BOUND, "along the bow, over ground"),
        Observed("down_body", "", 3, 1.0, "where down is"),
        *VELOCITY,
    )


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return the errors now."""
    deeper, turn, faster = errors(memory.orders[0], motion)
    obeyed = memory.obeyed + select((memory.given >= STEPS) & (memory.settled >= HELD), 1.0, 0.0)
    return Metrics(abs(deeper), abs(turn), abs(faster), obeyed)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    metrics = now.metrics
    return Rewards(
        weights.depth * peak(metrics.depth_error, DEPTH, own.depth_step),
        weights.heading * peak(metrics.heading_error, HEADING, FAR_OFF),
        weights.speed * peak(metrics.speed_error, SPEED * own.speed, own.speed),
        weights.settled * select(now.memory.settled > 0.0, 1.0, 0.0),
        effort(weights.effort, now),
    )


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether all orders were obeyed: settled within 0.3 m, 3 degrees and 10 % of speed for the last 5 s of each."""
    return now.metrics.orders_obeyed > STEPS - 0.5


def terminated(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle has lost its depth."""
    return now.metrics.depth_error > LOST * own.depth_step


def goal(own: Parameters, memory: Memory) -> Goal:
    """Return the depth and the heading that are ordered, for drawing."""
    order = memory.orders[0]
    return goal_along((0.0, 0.0, order.depth), (order.north, order.east, 0.0))


define_task(
    globals(),
    id="dq_marine/DepthHeading-v0",
    summary="Change depth, heading and speed as ordered, in an unseen current.",
    draws=1 + STEPS * STEP_DRAWS,
    units={"depth_error": "m", "heading_error": "rad", "speed_error": "m/s"},
    tolerances={"depth_error": DEPTH, "heading_error": HEADING},
    levels={
        "easy": {"depth_step": 2.0, "heading_step": 45.0, "speed_step": 0.1, "current": 0.0},
        "medium": {"current": 0.3},
        "hard": {
            "depth_step": 6.0,
            "heading_step": 150.0,
            "current": 0.4,
            "randomise": "default",
            "sensors": "auv",
        },
    },
    unsuitable=unable_to_dive_under_way,
    vehicle="remus100",
    control_period=paced,
    max_episode_steps=STEPS * PERIODS,
)
