"""Several vessels that meet, each an agent with physics of its own, by PettingZoo's parallel interface."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium import Space
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from numpy.typing import NDArray

from dq_marine.algebra.level import Level, level_dot
from dq_marine.checks import positive_integer, shown
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.registry import registered_tasks, task_named
from dq_marine.envs.core.shared_memory import parameters_of, task_memory, tell_again, write_task_memory
from dq_marine.envs.multi.watch import Seen, Watch, seen_from_above
from dq_marine.errors import InvalidInputError
from dq_marine.simulation.settings import VehicleLike
from dq_marine.simulation.solids import solids_of
from dq_marine.task.traffic import MISS, TIME_SPREAD, Own
from dq_marine.util.extras import extra_needed
from dq_marine.vehicles import load_vehicle

with extra_needed("an environment of several agents", "multi"):
    from pettingzoo import ParallelEnv

MOST = 8
"""Vessels that one sea holds."""

LEAST_ANGLE, ROOM = math.radians(20.0), math.radians(144.0)
"""Least angle between two courses: the smaller of this, and this over the number of vessels."""

PACE_RATIO = 1.5
"""Largest ratio of the times that two vessels take to the meeting."""


class MarineParallelEnv(ParallelEnv[str, Observation, Action]):
    """Vessels whose routes cross at one place. `parallel_env` makes one.

    Each agent is an environment of its own of a task that has traffic, in which the traffic is the other agents: it
    sees the three that are nearest, where they really are, and is rewarded, and done, by the task's own formulas. Who
    is done leaves the sea. All vessels are in the same current. No vessel feels the water that another moves.

    Attributes:
        possible_agents: names of all agents, in the order of the vehicles.
        agents: of those that are not done.
        origins: by agent, where the origin of its environment is in the sea [m], north and east.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"], "name": "dq_marine_parallel_v0"}

    def __init__(
        self,
        vehicles: Sequence[VehicleLike],
        task: str,
        max_cycles: int | None,
        render_mode: str | None,
        keywords: dict[str, Any],
    ) -> None:
        """Make the environments; see `parallel_env`."""
        definition = task_named(task)
        if definition.meets is None:
            others = [one.id for one in registered_tasks() if one.meets is not None]
            raise InvalidInputError(f"task = {shown(task)} has no vessels that meet; give one of {others}")
        if solids_of(keywords.get("solids", ())):
            raise InvalidInputError(
                f"solids = {shown(keywords['solids'])}: each vessel's axes have an origin of their own, so that solids "
                "would stand elsewhere for each; leave them out"
            )
        if not 2 <= len(vehicles) <= MOST:
            raise InvalidInputError(f"vehicles has {len(vehicles)} entries; give 2 to {MOST}")
        self.max_cycles = (
            definition.max_episode_steps if max_cycles is None else positive_integer("max_cycles", max_cycles)
        )
        self.render_mode = render_mode
        if "control_period" not in keywords:
            periods = [definition.period_for(load_vehicle(one)) for one in vehicles]
            keywords = {**keywords, "control_period": max(periods)}
        self.possible_agents = [f"vessel_{k + 1}" for k in range(len(vehicles))]
        self._envs = {
            name: MarineEnv(definition, one, render_mode=render_mode if k == 0 else None, **keywords)
            for k, (name, one) in enumerate(zip(self.possible_agents, vehicles, strict=True))
        }
        self.agents: list[str] = []
        self.origins: dict[str, Level] = {}
        self._watches: dict[str, Watch] = {}
        self._random: np.random.Generator | None = None
        self._cycles = 0

    def observation_space(self, agent: str) -> Space[Observation]:
        """Return the space of an agent's observations."""
        return self.env_of(agent).observation_space

    def action_space(self, agent: str) -> Space[Action]:
        """Return the space of an agent's actions."""
        return self.env_of(agent).action_space

    def env_of(self, agent: str) -> MarineEnv:
        """Return the environment of an agent: for its settings and state, and for controllers; not to be stepped.

        Raises:
            InvalidInputError: there is no such agent.
        """
        if agent not in self._envs:
            raise InvalidInputError(f"agent = {shown(agent)}; there are {self.possible_agents}")
        return self._envs[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Observation], dict[str, dict[str, Any]]]:
        """Start an episode with all agents.

        Args:
            seed: of the random draws; an episode follows from it bit for bit. None goes on drawing.
            options: of PettingZoo's interface; none are used.

        Returns:
            Observations and infos, by agent.
        """
        if seed is not None or self._random is None:
            self._random = seeding.np_random(seed)[0]
        self.agents, self._cycles, self.origins = list(self.possible_agents), 0, {}
        owns = self._drawn_courses(self._random)
        times = [own.way / own.speed for own in owns.values()]
        if max(times) > PACE_RATIO * min(times):
            raise InvalidInputError(
                f"vehicles take {min(times):.3g} to {max(times):.3g} s to where they meet; give vehicles of which none "
                f"takes more than {PACE_RATIO:g} times as long as another"
            )
        for name, own in owns.items():
            self.origins[name] = _drawn_origin(own, max(times), self._random)
            self._watches[name] = Watch(own, self.origins[name])
        seen = self._all_seen()
        for name, env in self._envs.items():
            lookout = self._watches[name].first(seen[name], _without(seen, name))
            write_task_memory(env, task_memory(env)._replace(lookout=lookout))
            tell_again(env)
        return (
            {name: env.observation for name, env in self._envs.items()},
            {name: env.info for name, env in self._envs.items()},
        )

    def step(
        self, actions: dict[str, Action]
    ) -> tuple[
        dict[str, Observation],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Hold the actions of all agents for one control period.

        Returns:
            Observations, rewards, whether agents are done, whether their time is over, and infos: by agent, of those
            that acted.

        Raises:
            InvalidInputError: an agent has no action, or one that is not there has; or an action is wrong.
            ResetNeeded: before the first reset.
        """
        if not self.origins:
            raise ResetNeeded("step was asked for before reset(); call reset() first")
        if set(actions) != set(self.agents):
            raise InvalidInputError(f"actions are of {sorted(actions)}; give one of each of {self.agents}")
        # Where all will be does not depend on what they see, and what they see is to be where all are then.
        coming = {
            name: seen_from_above(self._envs[name].foreseen(actions[name]), self.origins[name])
            for name in self.agents
        }
        self._cycles += 1
        over = self._cycles >= self.max_cycles
        results = {name: self._stepped(name, actions[name], coming) for name in self.agents}
        acted, self.agents = self.agents, [name for name in self.agents if not (results[name][2] or over)]
        return (
            {name: results[name][0] for name in acted},
            {name: results[name][1] for name in acted},
            {name: results[name][2] for name in acted},
            dict.fromkeys(acted, over),
            {name: results[name][4] for name in acted},
        )

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture about the first vessel, uint8 (height, width, 3); None without a render mode."""
        return self._envs[self.possible_agents[0]].render()

    def close(self) -> None:
        """End whatever rendering started."""
        for env in self._envs.values():
            env.close()

    def _stepped(self, name: str, action: Action, coming: dict[str, Seen]) -> tuple[Any, ...]:
        """Return what a step of an agent's environment returns, with the others as they will be."""
        env = self._envs[name]
        memory = task_memory(env)
        lookout = self._watches[name].kept(
            memory.lookout, coming[name], _without(coming, name), env.control_period
        )
        write_task_memory(env, memory._replace(lookout=lookout))
        return env.step(action)

    def _all_seen(self) -> dict[str, Seen]:
        """Return all agents as they are now."""
        return {name: seen_from_above(self._envs[name].motion, self.origins[name]) for name in self.agents}

    def _drawn_courses(self, random: np.random.Generator) -> dict[str, Own]:
        """Begin all episodes, with courses that are far enough from each other, and return whose way goes where."""
        nearest = math.cos(min(LEAST_ANGLE, ROOM / len(self._envs)))
        owns: dict[str, Own] = {}
        options: dict[str, Any] | None = None
        for name, env in self._envs.items():
            while True:
                env.reset(seed=int(random.integers(2**31)), options=options)
                own = env.definition.meets(parameters_of(env).task, task_memory(env))  # type: ignore[misc]
                if all(level_dot(own.course, other.course) < nearest for other in owns.values()):
                    break
            owns[name] = own
            options = options or {"current": env.episode.current_ned}
        return owns


def _drawn_origin(own: Own, time: float, random: np.random.Generator) -> Level:
    """Return where a vessel begins that comes to the middle of the sea at about a time [s]."""
    when, miss = random.uniform(-1.0, 1.0, 2).tolist()
    back, off = own.speed * time * (1.0 + TIME_SPREAD * when), MISS * own.length * miss
    (north, east) = own.course
    return (-back * north - off * east, -back * east + off * north)


def _without(seen: dict[str, Seen], name: str) -> dict[str, Seen]:
    return {other: one for other, one in seen.items() if other != name}


def parallel_env(
    vehicles: Sequence[VehicleLike] = ("otter", "otter", "otter"),
    task: str = "dq_marine/Encounter-v0",
    *,
    max_cycles: int | None = None,
    render_mode: str | None = None,
    **keywords: Any,
) -> MarineParallelEnv:
    """Return an environment of several vessels that meet, by PettingZoo's parallel interface.

    Args:
        vehicles: one for each agent, 2 to 8, which need about the same time to where they meet.
        task: the id of a task with traffic, that is one that says whom it `meets`.
        max_cycles: control periods after which an episode is truncated; None for those of the task.
        render_mode: None, or "rgb_array" for pictures about the first vessel.
        keywords: of `dq_marine.Settings` and of the task, for all agents. What they say of the traffic has no effect.

    Raises:
        InvalidInputError: a value is wrong, or a keyword unknown.
        MissingDependencyError: PettingZoo is not installed.
    """
    return MarineParallelEnv(vehicles, task, max_cycles, render_mode, keywords)
