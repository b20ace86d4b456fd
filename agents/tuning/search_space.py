"""What a search may change of a training, and between which bounds.

A dimension stands by the path of its field in the settings, as `algorithm.learning_rate`. Two are searched by other
numbers than those of the settings: gamma by the control periods that it looks ahead, 1 / (1 - gamma), because a step
from 0.98 to 0.99 doubles them; and the last learning rate keeps its ratio to the first.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings


class Chooser(Protocol):
    """What proposes values: a trial of Optuna's."""

    def suggest_float(self, name: str, low: float, high: float, *, log: bool = False) -> float:
        """Return a number within bounds."""

    def suggest_int(self, name: str, low: int, high: int, *, log: bool = False) -> int:
        """Return a whole number within bounds, both of them possible."""

    def suggest_categorical(self, name: str, choices: list[str]) -> str:
        """Return one of several."""


class Dimension(Protocol):
    """One thing that may be changed."""

    def chosen(self, name: str, chooser: Chooser) -> Any:
        """Return a value as the settings have it."""

    def proposal(self, value: Any) -> Any:
        """Return what a chooser would have to propose for a value of the settings, at the nearest bound if beyond."""


@dataclass(frozen=True)
class Real:
    """A number within bounds, by its logarithm where it may be of different sizes."""

    low: float
    high: float
    log: bool = False

    def chosen(self, name: str, chooser: Chooser) -> float:
        """Return a number."""
        return chooser.suggest_float(name, self.low, self.high, log=self.log)

    def proposal(self, value: float) -> float:
        """Return the number."""
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class Whole:
    """A whole number within bounds."""

    low: int
    high: int

    def chosen(self, name: str, chooser: Chooser) -> int:
        """Return a number."""
        return chooser.suggest_int(name, self.low, self.high)

    def proposal(self, value: int) -> int:
        """Return the number."""
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class LookAhead:
    """Gamma, by the control periods that it looks ahead."""

    low: float
    high: float

    def chosen(self, name: str, chooser: Chooser) -> float:
        """Return gamma."""
        return 1.0 - 1.0 / chooser.suggest_float(name, self.low, self.high, log=True)

    def proposal(self, value: float) -> float:
        """Return the control periods."""
        return min(max(1.0 / (1.0 - value) if value < 1.0 else self.high, self.low), self.high)


@dataclass(frozen=True)
class OneOf:
    """One of some values, which are written as JSON: Optuna takes no lists."""

    values: tuple[Any, ...]

    def chosen(self, name: str, chooser: Chooser) -> Any:
        """Return one of them."""
        return json.loads(chooser.suggest_categorical(name, [json.dumps(value) for value in self.values]))

    def proposal(self, value: Any) -> str:
        """Return the value as text."""
        return json.dumps(value)

    def including(self, value: Any) -> OneOf:
        """Return the same values, and another if it is not among them."""
        return self if value in map(_listed, self.values) else OneOf((*self.values, value))


Space: TypeAlias = dict[str, Dimension]
"""What may be changed, by the paths of the fields."""

COMMON: Space = {
    "algorithm.learning_rate": Real(1e-4, 3e-3, log=True),
    "algorithm.gamma": LookAhead(10.0, 300.0),
    "network.layers": OneOf(([64, 64], [128, 128], [256, 256])),
}

ROLLOUT: Space = {
    "algorithm.n_steps": OneOf((32, 64, 128, 256)),
    "algorithm.minibatches": OneOf((2, 4, 8)),
    "algorithm.n_epochs": Whole(3, 15),
    "algorithm.gae_lambda": Real(0.8, 0.99),
    "algorithm.clip_range": Real(0.1, 0.3),
    "algorithm.ent_coef": Real(0.0, 0.01),
    "algorithm.log_std_init": Real(-2.0, 0.0),
}

REPLAY: Space = {
    "algorithm.batch_size": OneOf((128, 256, 512)),
    "algorithm.gradient_steps": Whole(1, 8),
}

TARGETS: Space = {"algorithm.tau": Real(0.002, 0.05, log=True)}
ENTROPY: Space = {"algorithm.ent_coef": Real(1e-3, 0.1, log=True)}

SPACES: dict[str, Space] = {
    "ppo": ROLLOUT,
    "recurrent_ppo": ROLLOUT | {"algorithm.lstm_hidden_size": OneOf((32, 64, 128))},
    "sac": REPLAY | TARGETS | ENTROPY,
    "td3": REPLAY
    | TARGETS
    | {
        "algorithm.policy_delay": Whole(1, 4),
        "algorithm.exploration_noise": Real(0.02, 0.5, log=True),
        "algorithm.target_policy_noise": Real(0.02, 0.4, log=True),
    },
    "tqc": REPLAY | TARGETS | ENTROPY | {"algorithm.top_quantiles_to_drop_per_net": Whole(0, 5)},
    "crossq": REPLAY | ENTROPY | {"algorithm.policy_delay": Whole(1, 5)},
}
"""What may be changed of each algorithm, beyond what is common to all."""


def search_space(base: TrainingSettings) -> Space:
    """Return what may be changed of a training, the values that it has among the choices.

    An entropy coefficient of "auto" is left to the algorithm.
    """
    space: Space = {}
    content = base.model_dump(mode="json")
    for name, dimension in {**COMMON, **SPACES[base.algorithm.name]}.items():
        value = _at(content, name)
        if value == "auto":
            continue
        space[name] = dimension.including(value) if isinstance(dimension, OneOf) else dimension
    return space


def proposals_of(base: TrainingSettings, space: Space) -> dict[str, Any]:
    """Return what a chooser would have to propose for a training as it is."""
    content = base.model_dump(mode="json")
    return {name: dimension.proposal(_at(content, name)) for name, dimension in space.items()}


def chosen_values(space: Space, chooser: Chooser) -> dict[str, Any]:
    """Return what a chooser proposes, as the settings have it, by the paths of the fields."""
    return {name: dimension.chosen(name, chooser) for name, dimension in space.items()}


def with_values(base: TrainingSettings, values: Mapping[str, Any]) -> TrainingSettings:
    """Return a training with other values in their places.

    Raises:
        InvalidInputError: they do not go together, as minibatches that do not cut what is collected.
    """
    content = base.model_dump(mode="json")
    ratio = base.algorithm.final_learning_rate / base.algorithm.learning_rate
    for name, value in values.items():
        table, field = name.split(".")
        content[table][field] = value
    content["algorithm"]["final_learning_rate"] = ratio * content["algorithm"]["learning_rate"]
    return validate_settings(content, TrainingSettings, source="a trial")


def _at(content: Mapping[str, Any], name: str) -> Any:
    table, field = name.split(".")
    return content[table][field]


def _listed(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value
