"""Environments of scenarios: every episode begins as the scenario says."""

from __future__ import annotations

import os
from typing import Any

import gymnasium as gym

from dq_marine.checks import shown
from dq_marine.envs.core.start import check_is_options
from dq_marine.envs.scenarios.files import load_scenario
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError


class ScenarioStart(gym.Wrapper[Any, Any, Any, Any], gym.utils.RecordConstructorArgs):
    """Lets `reset` begin the scenario, again and again; a seed or an option that is given wins over the scenario's."""

    def __init__(self, env: gym.Env[Any, Any], scenario: Scenario) -> None:
        """Take an environment of the scenario's task.

        Raises:
            InvalidInputError: the environment is of another task, or refuses an option of the scenario's reset.
        """
        gym.utils.RecordConstructorArgs.__init__(self, scenario=scenario)
        gym.Wrapper.__init__(self, env)
        inner: Any = env.unwrapped
        if getattr(inner, "definition", None) != scenario.definition:
            raise InvalidInputError(
                f"the environment is {shown(env)}, and {scenario.full_name} is of {scenario.definition.id}; make it "
                "with dq_marine.make_scenario"
            )
        inner.checked_options(dict(scenario.reset))
        self.scenario = scenario

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start the scenario; see `MarineEnv.reset`.

        Args:
            seed: None for the scenario's.
            options: those of the scenario hold besides.
        """
        check_is_options(options)
        chosen = {**self.scenario.reset, **(options or {})}
        return self.env.reset(seed=self.scenario.seed if seed is None else seed, options=chosen)


def make_scenario(
    scenario: Scenario | str | os.PathLike[str], *, task: str | None = None, **keywords: Any
) -> gym.Env[Any, Any]:
    """Make the environment of a scenario: each `reset()` begins the scenario, with the same bits each time.

    Args:
        scenario: as `load_scenario` takes it.
        task: that it must be of, by name or id.
        keywords: further ones of `gym.make`, such as `render_mode`; they win over the scenario's.

    Raises:
        InvalidInputError: there is no such scenario, or something in it or among the keywords is wrong.
    """
    found = load_scenario(scenario, task=task)
    env = gym.make(found.definition.id, disable_env_checker=True, **{**found.keywords, **keywords})
    return ScenarioStart(env, found)
