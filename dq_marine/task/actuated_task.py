"""A task whose body is driven by actuators: the same task, which also remembers what their channels have reached."""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.integrator.actuation import Actuation
from dq_marine.integrator.body import Motion
from dq_marine.task.action import ActuatedMemory
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, wrapping
from dq_marine.task.protocol import Start


@functools.cache
def with_actuators(task: EpisodeTask, actuation: Actuation) -> EpisodeTask:
    """Return the task for a composition with this actuation; episodes begin with its channels at rest."""
    first_memory, next_memory = task.initial_memory, task.update_memory
    observe_task = task.observe
    first_reading, later_reading = task.sensing.first, task.sensing.later
    rest = actuation.rest

    def initial_memory(parameters: Any, begun: Start, uniforms: tuple[float, ...]) -> ActuatedMemory:
        return ActuatedMemory(first_memory(parameters, begun, uniforms), rest)

    def update_memory(
        parameters: Any, memory: ActuatedMemory, motion: Motion, measured: Motion
    ) -> ActuatedMemory:
        return ActuatedMemory(next_memory(parameters, memory.task, motion, measured), memory.values)

    def observe(parameters: Any, memory: ActuatedMemory, motion: Motion) -> Any:
        return observe_task(parameters, memory.task, motion)

    def read_first(
        parameters: EpisodeParameters, memory: ActuatedMemory, motion: Motion, uniforms: Any
    ) -> ActuatedMemory:
        return ActuatedMemory(first_reading(parameters, memory.task, motion, uniforms), memory.values)

    def read_later(
        parameters: EpisodeParameters, memory: ActuatedMemory, motion: Motion, uniforms: Any
    ) -> ActuatedMemory:
        return ActuatedMemory(later_reading(parameters, memory.task, motion, uniforms), memory.values)

    return wrapping(
        task,
        initial_memory=initial_memory,
        update_memory=update_memory,
        observe=observe,
        sensing=task.sensing._replace(first=read_first, later=read_later),
    )
