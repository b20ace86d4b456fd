"""The memory of a task within that of an episode, from outside: to read it, and to write into it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from dq_marine.backend.packing import pack, unpack
from dq_marine.task.action import ActuatedMemory
from dq_marine.task.delays import Delayed
from dq_marine.task.episode import EpisodeParameters, make_shown
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


def memory_layers(env: MarineEnv) -> list[Any]:
    """Return the memory of the episode in progress, and what it wraps; the task's own is the last."""
    layers = [unpack(env.blank_memory, env.episode.memory)]
    while isinstance(layers[-1], WRAPPINGS):
        layers.append(layers[-1].task)
    return layers


def task_memory(env: MarineEnv) -> Any:
    """Return what the task of an environment remembers now."""
    return memory_layers(env)[-1]


def beams_told(beams: Sequence[Beam], layers: Sequence[Any]) -> tuple[Beam, ...]:
    """Return the beams of a task with what they tell the agent now, by the layers of the memory."""
    for layer in layers:
        if isinstance(layer, Ranged):
            told = zip(beams, layer.told, strict=True)
            return tuple(beam._replace(distance=share * beam.reach) for beam, share in told)
    return tuple(beams)


def write_task_memory(env: MarineEnv, memory: Any) -> None:
    """Let the task of an environment remember something else."""
    env.episode.memory[:] = pack(_within(unpack(env.blank_memory, env.episode.memory), memory))


def tell_again(env: MarineEnv) -> None:
    """Bring the first observation of an episode and what is told of it up to what the task remembers now."""
    episode, parameters, motion = env.episode, parameters_of(env), env.motion
    memory = env.task.begin_showing(parameters.task, unpack(env.blank_memory, episode.memory), motion)
    episode.memory[:] = pack(memory)
    x, y, z = episode.current_ned.tolist()
    episode.observation[:] = pack(make_shown(env.task)(parameters, memory, motion, (x, y, z)))
    episode.report[:-3] = pack(make_first_report(env.task)(parameters, memory, motion))


def _within(whole: Any, memory: Any) -> Any:
    """Return the memory of an episode with another one of the task."""
    if isinstance(whole, WRAPPINGS):
        return whole._replace(task=_within(whole.task, memory))
    return memory
