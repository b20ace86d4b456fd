"""Letting an algorithm that learns from a memory remember what a teacher and its pupil flew.

Learning then goes on from there rather than from actions at random (Vecerik et al. 2017, arXiv:1707.08817; Ball et al.
2023, arXiv:2302.02948).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.training.fitting import rows_of
from dq_marine.agents.training.teaching import Lessons, Observations
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.buffers import ReplayBuffer
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm


def memory_of(model: OffPolicyAlgorithm) -> ReplayBuffer:
    """Return what a model remembers by.

    Raises:
        InvalidInputError: it was loaded without its replay buffer.
    """
    if model.replay_buffer is None:
        raise InvalidInputError(
            f"{type(model).__name__} has no memory to learn from; load its replay buffer first"
        )
    return model.replay_buffer


def remember(model: OffPolicyAlgorithm, lessons: Lessons) -> None:
    """Let a model remember what was flown, and learn from its first step on: none is at random any more.

    Memory takes as many periods at a time as there are environments; what is left over of the last is not remembered.
    """
    model.learning_starts = 0
    buffer, envs, count = memory_of(model), model.n_envs, len(lessons.rewards)
    last = np.cumsum(lessons.lengths) - 1
    done, cut_off = np.zeros(count, bool), np.zeros(count, bool)
    done[last], cut_off[last] = True, ~lessons.terminated
    following = _following(lessons.observations, lessons.ends, last)
    scaled = model.policy.scale_action(lessons.flown)
    for first in range(0, count - envs + 1, envs):
        rows = np.arange(first, first + envs)
        infos = [{"TimeLimit.truncated": bool(cut_off[row])} for row in rows]
        buffer.add(
            rows_of(lessons.observations, rows),
            rows_of(following, rows),
            scaled[rows],
            lessons.rewards[rows],
            done[rows],
            infos,
        )


def _following(observations: Observations, ends: Any, last: NDArray[np.int64]) -> Observations:
    """Return the observation after each period: that of the next, or what an episode ended with."""
    if isinstance(observations, dict):
        return {name: _after(values, ends[name], last) for name, values in observations.items()}
    return _after(observations, ends, last)


def _after(values: NDArray[Any], ends: Any, last: NDArray[np.int64]) -> NDArray[Any]:
    after = np.roll(values, -1, axis=0)
    after[last] = ends
    return after
