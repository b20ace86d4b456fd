"""Depth keeping: reach a depth that is drawn for each episode and hold it, moving little."""

from __future__ import annotations

from dataclasses import dataclass
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
    finite_number,
    observed_velocity,
    slow_start,
)

SHALLOWEST, TOLERANCE = 5.0, 0.1  # the least depth that is drawn, and the error that counts as success [m]


@dataclass(frozen=True)
class Settings:
    """The task's own keywords: the greatest depth that is drawn [m]."""

    deepest: float = 9.0


class Parameters(NamedTuple):
    """The numbers of an episode: the greatest depth that is drawn [m]."""

    deepest: float


class Metrics(NamedTuple):
    """Depth less the one to hold [m]."""

    depth_error: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights: squared error [1/m^2], mean square of the action."""

    depth: float = 1.0
    effort: float = 0.05


def parameters(settings: Settings, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    return Parameters(finite_number("deepest", settings.deepest, above=SHALLOWEST))


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return a slow start within 1 m of the least depth, at any heading."""
    return slow_start((0.0, 0.0, SHALLOWEST), 1.0, 1.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> float:
    """Return the depth to hold [m]."""
    return SHALLOWEST + (own.deepest - SHALLOWEST) * uniforms[SLOW_START_DRAWS]


def observe(own: Parameters, memory: float, measured: Motion) -> Any:
    """Return what `observations` lists."""
    return (bounded(measured.position_ned[2] - memory, 100.0), observed_velocity(measured))


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return what an observation consists of."""
    return (Observed("depth_error", "m", 1, 100.0, "depth less the one to hold"), *VELOCITY)


def measure(own: Parameters, memory: float, motion: Motion) -> Metrics:
    """Return how far off the depth is."""
    return Metrics(motion.position_ned[2] - memory)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward."""
    error = now.metrics.depth_error
    return Rewards(-(weights.depth * error * error), effort(weights.effort, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the depth is held."""
    return abs(now.metrics.depth_error) < TOLERANCE


define_task(
    globals(),
    id="my/DepthKeeping-v0",
    summary="Reach a depth that is drawn for each episode, and hold it.",
    draws=SLOW_START_DRAWS + 1,
    units={"depth_error": "m"},
    tolerances={"depth_error": TOLERANCE},
)
