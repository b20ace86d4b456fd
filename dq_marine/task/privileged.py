"""What only the simulator knows, revealed beside what the agent observes: for a critic that learns with it.

A critic is needed while an agent learns, and not where it flies, so it may see what no sensor tells (Pinto et al. 2017,
asymmetric actor-critic, arXiv:1710.06542): how the water moves, in what the vehicle is not the nominal one, and what
would be observed without sensors that err and readings that come late.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeAlias

from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.vector3 import Vector3, bounded_vector
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, nothing_revealed

Reveal: TypeAlias = Callable[[EpisodeParameters, Any, Motion, Vector3], Any]
"""(episode's parameters, memory, motion, current in NED) -> nested tuples of numbers."""


def current_in_body(
    parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3
) -> Vector3:
    """Return the velocity of the water where the vehicle is, in its axes [m/s], within `SPEED_BOUND`."""
    return bounded_vector(rotate_inverse(motion.attitude, current_ned), SPEED_BOUND)


def vehicle_differences(
    parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3
) -> tuple[float, ...]:
    """Return in what the vehicle is not the nominal one."""
    return parameters.vehicle


def make_true_observation(task: EpisodeTask) -> Reveal:
    """Return what a task observes where nothing stands between it and the true motion."""
    observe = task.observe

    def true_observation(
        parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3
    ) -> Any:
        return observe(parameters.task, memory, motion)

    return true_observation


def make_revealed(parts: tuple[Reveal, ...]) -> Reveal:
    """Return what gives the numbers of all parts, nested in pairs (first, (second, (..., ())))."""
    if not parts:
        return nothing_revealed
    first, rest = parts[0], make_revealed(parts[1:])

    def revealed(parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3) -> Any:
        return (
            first(parameters, memory, motion, current_ned),
            rest(parameters, memory, motion, current_ned),
        )

    return revealed


@functools.cache
def revealing(task: EpisodeTask, names: tuple[str, ...]) -> EpisodeTask:
    """Return a task that reveals parts of what only the simulator knows.

    Args:
        task: as yet without what stands between it and the truth: sensors, delays, a schedule of pings.
        names: of the parts, in the order of their numbers: "current", "vehicle", "truth".
    """
    known = {
        "current": current_in_body,
        "vehicle": vehicle_differences,
        "truth": make_true_observation(task),
    }
    return replace(task, reveal=make_revealed(tuple(known[name] for name in names)))
