"""A small task with an instrument of its own: depth keeping by noisy readings, some of which are lost."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.envs.kit import (
    SLOW_START_DRAWS,
    VELOCITY,
    EpisodeContext,
    Motion,
    Observed,
    Situation,
    Start,
    bounded,
    define_task,
    effort,
    observed_velocity,
    select,
    slow_start,
)

DEPTH, NOISE, DROPOUT = 5.0, 0.1, 0.3


class Parameters(NamedTuple):
    """Share of readings that are lost."""

    dropout: float


class Memory(NamedTuple):
    """The last reading of the depth [m], how often there was none, and the error of the next reading [m]."""

    reading: float
    lost: float
    error: float
    heard: float


class Metrics(NamedTuple):
    """Depth less the one to hold [m], readings that were lost."""

    depth_error: float
    lost: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights."""

    depth: float = 1.0
    effort: float = 0.05


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    return Parameters(DROPOUT)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    return slow_start((0.0, 0.0, DEPTH), 1.0, 1.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    return Memory(begun.position_ned[2], 0.0, 0.0, 1.0)


def sense(own: Parameters, memory: Memory, motion: Motion, uniforms: Any) -> Memory:
    heard = select(uniforms[0] < own.dropout, 0.0, 1.0)
    return Memory(memory.reading, memory.lost, NOISE * (2.0 * uniforms[1] - 1.0), heard)


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    now = motion.position_ned[2] + memory.error
    reading = select(memory.heard > 0.5, now, memory.reading)
    return Memory(reading, memory.lost + 1.0 - memory.heard, memory.error, memory.heard)


def observe(own: Parameters, memory: Memory, measured: Motion) -> Any:
    return (bounded(memory.reading - DEPTH, 100.0), observed_velocity(measured))


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    return (Observed("depth_reading", "m", 1, 100.0, "depth less the one to hold, as last heard"), *VELOCITY)


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    return Metrics(motion.position_ned[2] - DEPTH, memory.lost)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    error = now.metrics.depth_error
    return Rewards(-(weights.depth * error * error), effort(weights.effort, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    return abs(now.metrics.depth_error) < NOISE


TASK = "tests/Listening-v0"

define_task(
    globals(),
    id=TASK,
    summary="Hold a depth by noisy readings that are lost at times.",
    draws=SLOW_START_DRAWS,
    sense_draws=2,
    units={"depth_error": "m", "lost": "1"},
)
