"""An environment of a task with goals, as hindsight replay and Gymnasium's `GoalEnv` want it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_rows
from dq_marine.envs.core.goals import GOAL_TERM
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError


class GoalMarineEnv(MarineEnv):
    """A `MarineEnv` that can tell the reward of a step had another goal been asked for.

    `gym.make` makes one of a task that has a `goal_reward`. Goals are observed in single precision, and by sensors,
    where there are any; to that accuracy the reward at the step's own goal is that of the step.
    """

    def compute_reward(
        self,
        achieved_goal: NDArray[Any],
        desired_goal: NDArray[Any],
        info: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    ) -> Any:
        """Return the reward of steps had they ended at other goals.

        Args:
            achieved_goal: of one step, or with a row for each of n.
            desired_goal: likewise.
            info: that of the step, or one for each: the terms of the reward besides the goal's are taken from it.

        Returns:
            The reward, or those of n steps, shape (n,).

        Raises:
            InvalidInputError: the task has no goals, a shape is wrong, a number is not finite, or an info lacks a term.
        """
        formula, places = self.definition.goal_reward, self.observation_places
        if formula is None or places is None:
            raise InvalidInputError(f"{self.definition.id} has no goals, so no rewards at other goals")
        infos = [info] if isinstance(info, Mapping) else info
        achieved, desired = (
            finite_rows(name, given, len(infos), len(places[name])).tolist()
            for name, given in (("achieved_goal", achieved_goal), ("desired_goal", desired_goal))
        )
        parameters = self.episode_parameters({})
        rewards = np.array(
            [
                formula(parameters.task, parameters.weights, tuple(here), tuple(there)) + self._others(one)
                for here, there, one in zip(achieved, desired, infos, strict=True)
            ]
        )
        alone = np.ndim(desired_goal) == 1 and isinstance(info, Mapping)
        return float(rewards[0]) if alone else rewards

    def _others(self, info: Mapping[str, Any]) -> float:
        """Return the sum of the reward's terms besides the goal's."""
        names = [f"reward/{name}" for name in self.reward_names if name != GOAL_TERM]
        missing = [name for name in names if name not in info]
        if missing:
            raise InvalidInputError(
                f"info lacks {missing}; give the step's own, with HerReplayBuffer(copy_info_dict=True)"
            )
        return sum(float(info[name]) for name in names)
