"""A task whose body is driven by actuators: the same task, which also remembers what their channels have reached."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

from dq_marine.kernel.actuation import Actuation
from dq_marine.kernel.body import Motion
from dq_marine.kernel.push import ActuatedMemory
from dq_marine.kernel.task import Task


@functools.cache
def with_actuators(task: Task, actuation: Actuation) -> Task:
    """Return the task for a composition with this actuation; episodes begin with its channels at rest."""
    forget_task, remember_task, observe_task = task.forget, task.remember, task.observe
    first_reading, later_reading = task.sensing.first, task.sensing.later
    rest = actuation.rest

    def forget(aim: Any) -> ActuatedMemory:
        return ActuatedMemory(forget_task(aim), rest)

    def remember(aim: Any, memory: ActuatedMemory, motion: Motion) -> ActuatedMemory:
        return ActuatedMemory(remember_task(aim, memory.task, motion), memory.values)

    def observe(aim: Any, memory: ActuatedMemory, motion: Motion) -> Any:
        return observe_task(aim, memory.task, motion)

    def read_first(aim: Any, memory: ActuatedMemory, motion: Motion, uniforms: Any) -> ActuatedMemory:
        return ActuatedMemory(first_reading(aim, memory.task, motion, uniforms), memory.values)

    def read_later(aim: Any, memory: ActuatedMemory, motion: Motion, uniforms: Any) -> ActuatedMemory:
        return ActuatedMemory(later_reading(aim, memory.task, motion, uniforms), memory.values)

    sensing = task.sensing._replace(first=read_first, later=read_later)
    return dataclasses.replace(task, forget=forget, remember=remember, observe=observe, sensing=sensing)
