"""What a search may change: within bounds, there and back, and what does not go together is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.trainings import ALGORITHMS, tiny

from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.tuning.search_space import (
    Dimension,
    LookAhead,
    OneOf,
    chosen_values,
    proposals_of,
    search_space,
    with_values,
)
from dq_marine.errors import InvalidInputError


class Fixed:
    """Proposes what it was given, and notes what it was asked for."""

    def __init__(self, proposals: dict[str, Any]) -> None:
        self.proposals = proposals

    def suggest_float(self, name: str, low: float, high: float, *, log: bool = False) -> float:
        assert low <= self.proposals[name] <= high
        assert low > 0.0 or not log
        return float(self.proposals[name])

    def suggest_int(self, name: str, low: int, high: int, *, log: bool = False) -> int:
        assert low <= self.proposals[name] <= high
        return int(self.proposals[name])

    def suggest_categorical(self, name: str, choices: list[str]) -> str:
        assert self.proposals[name] in choices
        return str(self.proposals[name])


def chosen_settings(base: TrainingSettings, space: dict[str, Dimension], chooser: Fixed) -> TrainingSettings:
    return with_values(base, chosen_values(space, chooser))


@pytest.mark.parametrize("name", ALGORITHMS)
def test_the_preset_as_it_is_can_be_proposed(name: str) -> None:
    base = read_settings(name, TrainingSettings)
    space = search_space(base)
    chosen = chosen_settings(base, space, Fixed(proposals_of(base, space)))
    assert chosen.network == base.network
    for field, value in base.algorithm.model_dump().items():
        assert getattr(chosen.algorithm, field) == (
            pytest.approx(value) if isinstance(value, float) else value
        )


def test_what_is_beyond_the_bounds_begins_at_the_bound(tmp_path: Path) -> None:
    base = tiny(tmp_path, "ppo")  # layers of [8], 16 steps, and 2 epochs, where 3 are the fewest
    space = search_space(base)
    chosen = chosen_settings(base, space, Fixed(proposals_of(base, space)))
    assert chosen.network.layers == base.network.layers == (8,)
    assert chosen.algorithm.n_steps == 16
    assert chosen.algorithm.n_epochs == 3


def test_an_automatic_entropy_coefficient_is_left_alone(tmp_path: Path) -> None:
    assert "algorithm.ent_coef" not in search_space(tiny(tmp_path, "sac"))
    assert "algorithm.ent_coef" in search_space(read_settings("sac", TrainingSettings))


def test_the_last_learning_rate_keeps_its_ratio_to_the_first(tmp_path: Path) -> None:
    base = tiny(tmp_path, "ppo")
    space = search_space(base)
    proposals = proposals_of(base, space) | {"algorithm.learning_rate": 2e-3}
    algorithm = chosen_settings(base, space, Fixed(proposals)).algorithm
    assert algorithm.final_learning_rate == pytest.approx(2e-4)


def test_what_does_not_go_together_is_refused(tmp_path: Path) -> None:
    base = tiny(tmp_path, "ppo").model_copy(update={"envs": 1})
    space = search_space(base)
    proposals = proposals_of(base, space) | {"algorithm.n_steps": "16", "algorithm.minibatches": "8"}
    assert chosen_settings(base, space, Fixed(proposals)).algorithm.minibatches == 8
    space["algorithm.minibatches"] = OneOf((2, 5))
    with pytest.raises(InvalidInputError, match="minibatches = 5 does not cut"):
        chosen_settings(base, space, Fixed(proposals | {"algorithm.minibatches": "5"}))


@given(st.floats(10.0, 300.0))
def test_looking_ahead_goes_there_and_back(periods: float) -> None:
    dimension = LookAhead(10.0, 300.0)
    gamma = dimension.chosen("gamma", Fixed({"gamma": periods}))
    assert 0.9 <= gamma < 1.0
    assert dimension.proposal(gamma) == pytest.approx(periods)
    assert dimension.proposal(1.0) == 300.0
