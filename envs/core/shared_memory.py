"""The memory of a task within that of an episode, from outside: to read it, and to write into it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dq_marine.backend.packing import pack, unpack
from dq_marine.task.action import ActuatedMemory
from dq_marine.task.delays import Delayed
from dq_marine.task.episode import EpisodeParameters
from dq_marine.task.ranging import Ranged
from dq_marine.task.sensors.observing import Sensed
from dq_marine.task.start import make_first_report
from dq_marine.task.things import Beam

if TYPE_CHECKING:
    from dq_marine.envs.core.marine_env import MarineEnv


WRAPPINGS = (Ranged, Sensed, ActuatedMemory, Delayed)
"""Memories that have a task's own as `task`."""


def parameters_of(env: MarineEnv) -> EpisodeParameters:
    """Return the numbers of the episode in progress."""
    return unpack(env.episode_parameters({}), env.episode.episode_parameters)  # type: ignore[no-any-return]


def task_memory(env: MarineEnv) -> Any:
    """Return what the task of an environment remembers now."""
    memory = unpack(env.blank_memory, env.episode.memory)
    while isinstance(memory, WRAPPINGS):
        memory = memory.task
    return memory


def beams_told(env: MarineEnv) -> tuple[Beam, ...]:
    """Return the beams of an environment's task, with what they tell the agent now."""
    beams = env.definition.beams(parameters_of(env).task, task_memory(env))
    memory = unpack(env.blank_memory, env.episode.memory)
    while isinstance(memory, WRAPPINGS):
        if isinstance(memory, Ranged):
            return tuple(
                beam._replace(distance=told * beam.reach)
                for beam, told in zip(beams, memory.told, strict=True)
            )
        memory = memory.task
    return tuple(beams)


def write_task_memory(env: MarineEnv, memory: Any) -> None:
    """Let the task of an environment remember something else."""
    env.episode.memory[:] = pack(_within(unpack(env.blank_memory, env.episode.memory), memory))


def tell_again(env: MarineEnv) -> None:
    """Bring the first observation of an episode and what is told of it up to what the task remembers now."""
    episode, parameters, motion = env.episode, parameters_of(env), env.motion
    memory = env.task.begin_showing(parameters.task, unpack(env.blank_memory, episode.memory), motion)
    episode.memory[:] = pack(memory)
    episode.observation[:] = pack(env.task.observe(parameters.task, memory, motion))
    episode.report[:-3] = pack(make_first_report(env.task)(parameters, memory, motion))


def _within(whole: Any, memory: Any) -> Any:
    """Return the memory of an episode with another one of the task."""
    if isinstance(whole, WRAPPINGS):
        return whole._replace(task=_within(whole.task, memory))
    return memory
