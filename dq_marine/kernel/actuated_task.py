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
    rest = actuation.rest

    def forget(aim: Any) -> ActuatedMemory:
        return ActuatedMemory(forget_task(aim), rest)

    def remember(aim: Any, memory: ActuatedMemory, motion: Motion) -> ActuatedMemory:
        return ActuatedMemory(remember_task(aim, memory.task, motion), memory.values)

    def observe(aim: Any, memory: ActuatedMemory, motion: Motion) -> Any:
        return observe_task(aim, memory.task, motion)

    return dataclasses.replace(task, forget=forget, remember=remember, observe=observe)
