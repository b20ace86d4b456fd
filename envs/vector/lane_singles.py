"""The environments of a batch one by one: looked at, called and changed as single ones."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import numpy as np

from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.pcg64 import fill_seeded, state_of, words_of
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.goal_env import GoalMarineEnv
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.pixels import picture_size
from dq_marine.envs.vector.lane_memory import LaneMemory
from dq_marine.errors import InvalidInputError
from dq_marine.task.episode import EpisodeParameters

SEED_UNKNOWN = -1
"""Gymnasium's seed of a generator that was set directly."""


class LaneSingles:
    """n environments: their memory in lanes, and single environments that take on the state of one.

    Attributes:
        first: the single environment that stands for all, or for the first.
        memory: of all.
        seeds: of the environments, None where there was none yet.
        actions: those of the last control period as compiled code takes them, shape (n, `ActionMapping.size`), not
            saturated.
        fallbacks: substeps that plain Newton did not solve, so far, shape (n,).
    """

    def __init__(self, singles: list[MarineEnv], n: int, lanes: Lanes, *, keeps_ends: bool) -> None:
        """Lay out n environments like `singles`, one for all or one for each; see `LaneMemory` for the arguments."""
        self._singles = singles
        self._lanes = lanes
        self._keeps_ends = keeps_ends
        self.n = n
        self.first = singles[0]
        self.memory = LaneMemory(singles, n, lanes, keeps_ends=keeps_ends)
        self.seeds: list[int | None] = [None] * n
        self.actions = np.zeros((n, self.first.action_mapping.size))
        self.fallbacks = np.zeros(n, np.int64)

    def seed(self, seeds: Sequence[int | None], wanted: Sequence[int]) -> None:
        """Seed the wanted environments: with their seed, or where they never had one, from fresh entropy."""
        chosen = [index for index in wanted if seeds[index] is not None or self.seeds[index] is None]
        if not chosen:
            return
        fresh = np.random.SeedSequence().generate_state(len(chosen), np.uint64) >> np.uint64(1)
        given = [
            int(entropy if (seed := seeds[index]) is None else seed)
            for index, entropy in zip(chosen, fresh.tolist(), strict=True)
        ]
        for index, seed in zip(chosen, given, strict=True):
            self.seeds[index] = seed
        fill_seeded(self.memory.arrays.generators, given, np.array(chosen))

    def episodes(self, for_all: dict[str, Any], for_each: dict[str, Any]) -> list[EpisodeParameters]:
        """Return the parameters of episodes with given options, one for all or one for each environment."""
        if len(self._singles) == 1 and not for_each:
            return [self.first.episode_parameters(for_all)]
        return [
            self.single(index).episode_parameters(
                for_all | {name: rows[index] for name, rows in for_each.items()}
            )
            for index in range(self.n)
        ]

    def at(self, index: int) -> MarineEnv:
        """Return the single environment of one, at the present state of its episode and its generator."""
        single = self.single(index)
        generator = np.random.Generator(np.random.PCG64())
        generator.bit_generator.state = state_of(self.memory.arrays.generators[index])
        episode = self.memory.episode(index)
        if episode.periods:
            episode.action = np.clip(self.actions[index], -1.0, 1.0)
        single.adopt(episode, generator, self.seeds[index])
        single.fallback_substeps = int(self.fallbacks[index])
        return single

    def call(self, index: int, name: str, *args: Any, **kwargs: Any) -> Any:
        """Call a method of one environment, and keep what it changes."""
        single = self.at(index)
        before = single.episode
        result = getattr(single, name)(*args, **kwargs)
        self.memory.set_episode(index, single.episode)
        if single.episode is not before:  # another one goes on here, whether or not the last had ended
            self.memory.arrays.ended[index] = False
        self._set_generator(index, single.np_random)
        self.actions[index] = single.episode.action
        self.fallbacks[index] = single.fallback_substeps
        return result

    def set_attribute(self, chosen: Sequence[int], name: str, values: Sequence[Any]) -> bool:
        """Set an attribute of chosen environments; return whether the memory had to be laid out anew.

        Args:
            chosen: indices of the environments.
            name: of the attribute.
            values: one for each of them.
        """
        if name == "np_random":
            for index, value in zip(chosen, values, strict=True):
                self._set_generator(index, value)
                self.seeds[index] = SEED_UNKNOWN
            return False
        for_all = len(chosen) == self.n and all(value is values[0] for value in values)
        if not for_all and len(self._singles) == 1:
            self._singles = [copy.copy(self.first) for _ in range(self.n)]
            self.first = self._singles[0]
        for index, value in zip(chosen, values, strict=True):
            setattr(self.single(index), name, value)
        return self._follow()

    def _follow(self) -> bool:
        """Let new episodes begin with what the single environments say now."""
        episodes = [single.episode_parameters({}) for single in self._singles]
        if self.memory.can_hold(episodes):
            self.memory.set_default_episodes(episodes)
            return False
        old = self.memory
        self.memory = LaneMemory(self._singles, self.n, self._lanes, keeps_ends=self._keeps_ends)
        self.memory.take_over(old)
        return True

    def single(self, index: int) -> MarineEnv:
        """Return the single environment of one, whatever its episode."""
        return self._singles[index if len(self._singles) > 1 else 0]

    def _set_generator(self, index: int, generator: np.random.Generator) -> None:
        self.memory.arrays.generators[index] = words_of(dict(generator.bit_generator.state))


def made_singles(
    definition: TaskDefinition, vehicle: Any, n: int, arguments: dict[str, Any]
) -> list[MarineEnv]:
    """Return single environments: one that stands for all n, or where `vehicle` is a list, one for each.

    Raises:
        InvalidInputError: there is not a vehicle for each, they differ in what is to be computed, something is to be
            recorded, or pictures are to be observed.
        VehicleFileError: a vehicle file is wrong.
    """
    made = GoalMarineEnv if definition.has_goals else MarineEnv
    if arguments.pop("record", False):
        raise InvalidInputError(
            "record = True; a vector environment records nothing, make a single one for that"
        )
    if picture_size(arguments.pop("observation", "numbers")) is not None:
        raise InvalidInputError(
            "observation = 'pixels'; a vector environment observes numbers, for a browser would draw each of its "
            "pictures: make a single one for that, or gym.make_vec(..., vectorization_mode='sync')"
        )
    if not isinstance(vehicle, list | tuple):
        return [made(definition, vehicle, **arguments)]
    if arguments.get("randomise") is not None:
        raise InvalidInputError(
            "a list of vehicles and randomise both say what each environment flies; give one of them"
        )
    if len(vehicle) != n:
        raise InvalidInputError(f"{len(vehicle)} vehicles for {n} environments; give one for each")
    singles = [made(definition, one, **arguments) for one in vehicle]
    first = singles[0]
    for index, single in enumerate(singles):
        same_terms = single.scene.composition == first.scene.composition
        if not same_terms or single.action_space != first.action_space:
            raise InvalidInputError(
                f"vehicle[{index}] has terms {list(single.scene.terms)} and actions {single.action_names}, vehicle[0] "
                f"{list(first.scene.terms)} and {first.action_names}; they must not differ"
            )
        if single.observation_space != first.observation_space:
            raise InvalidInputError(
                f"vehicle[{index}] and vehicle[0] differ in what bounds their observations, as their lengths do; give "
                "all the same radii and limits by the task's keywords"
            )
    return singles
