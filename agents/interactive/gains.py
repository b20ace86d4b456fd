"""The numbers of a controller's preset as sliders, which tune it while it flies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.journeys import Journey
from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.strict_settings import Settings
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.viewer.controls import Event, Group, Slider

RATIO = 5.0
"""How far a slider goes up and down from the number of the preset."""

BELOW = 0.99
"""Where a slider ends, over a bound that its number has to stay below."""

NOTE = "What is moved here holds at once; the controller's integrals begin anew."


class Gains:
    """Tunes the first of some agents that has a preset's numbers: dynamic positioning, or an autopilot's."""

    def __init__(self, agents: dict[str, Agent]) -> None:
        """Take the agents by name; the one that is tuned gives its place to another, with other numbers."""
        self._agents = agents
        self._name = next((name for name, agent in agents.items() if _preset(agent) is not None), "")
        preset = _preset(agents[self._name]) if self._name else None
        self._sliders = {} if preset is None else {one.name: one for one in _sliders(preset)}
        self._paths = {} if preset is None else {_name(path): path for path, _, _ in _numbers(preset)}

    def groups(self) -> tuple[Group, ...]:
        """Return the sliders, as they stand; none where no agent has such numbers."""
        if not self._sliders:
            return ()
        return (Group(f"Gains of {self._name}", tuple(self._sliders.values()), note=NOTE, opened=False),)

    def value(self, name: str) -> float:
        """Return where a slider stands."""
        return self._sliders[name].value

    def take(self, event: Event, env: MarineEnv) -> bool:
        """Tune the agent, if an event is of one of the sliders; return whether it is.

        Raises:
            InvalidInputError: the controller cannot fly so; it flies on as it did.
        """
        if event.name not in self._sliders:
            return False
        agent: Any = self._agents[self._name]  # of a kind that has a preset's numbers: it has sliders
        settings = agent.settings
        content = settings.model_dump()
        *tables, field = self._paths[event.name]
        table = content
        for name in tables:
            table = table[name]
        table[field] = event.value
        tuned = type(agent).for_env(env, validate_settings(content, type(settings), source=event.name))
        tuned.reset(env)
        self._agents[self._name] = tuned
        self._sliders[event.name] = replace(self._sliders[event.name], value=event.value)
        return True


def _preset(agent: Agent) -> Settings | None:
    return agent.settings if isinstance(agent, DPController | Journey) else None


def _numbers(settings: Settings, *tables: str) -> Iterator[tuple[tuple[str, ...], float, list[Any]]]:
    """Yield the path of each number that is given, the number, and its bounds."""
    for name, field in type(settings).model_fields.items():
        value = getattr(settings, name)
        if isinstance(value, Settings):
            yield from _numbers(value, *tables, name)
        elif value is not None:
            yield (*tables, name), value, field.metadata


def _sliders(settings: Settings) -> Iterator[Slider]:
    for path, value, bounds in _numbers(settings):
        most = RATIO * value if value else 1.0
        for bound in bounds:
            limit: Any = getattr(bound, "le", None) or BELOW * getattr(bound, "lt", math.inf)
            most = min(most, limit)
        step = 10.0 ** (math.floor(math.log10(value)) - 2) if value else 0.01
        label = " ".join(path).replace("_", " ")
        yield Slider(_name(path), label, value / RATIO, most, value, step, logarithmic=value > 0.0)


def _name(path: tuple[str, ...]) -> str:
    return "_".join(("gain", *path))
