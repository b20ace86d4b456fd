"""Policies that come with the package: small, trained as their presets say, found by name, and still successful."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.command_line import assert_refused, run
from support.sweeps import sweep

from dq_marine.agents.deployment.model_card import CARD_FILE
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.policies import load_policy, trained_environment
from dq_marine.agents.policy_names import policy_path, shipped_policies
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.registry import task_called
from dq_marine.errors import InvalidInputError

LARGEST = 2**20
"""Bytes of a policy."""

EPISODES, LEAST = 10, 0.8
UNSEEN = 5_000_000
"""Seed of the first: beyond those of trainings and evaluations."""


@pytest.mark.parametrize("name", shipped_policies())
def test_each_is_small_and_was_trained_as_its_preset_says(name: str) -> None:
    path, settings = policy_path(name), read_settings(name, TrainingSettings)
    assert path.stat().st_size <= LARGEST
    assert trained_environment(path) == settings.environment
    task, _, vehicle = name.partition("_")
    assert settings.environment.id == task_called(settings.environment.id).id == f"dq_marine/{task}-v0"
    assert settings.environment.keywords.get("vehicle", "") == vehicle
    card = (path.parent / CARD_FILE).read_text(encoding="utf-8")
    preset = card.split("```toml\n")[1].split("```")[0]
    assert TrainingSettings.model_validate(tomllib.loads(preset)) == settings


@pytest.mark.parametrize("name", sorted({*shipped_policies()} - {"Encounter"}))
def test_vehicles_are_drawn_at_random_where_a_policy_is_trained(name: str) -> None:
    """Not for Encounter, which gained nothing by it: see docs/howto/shipped_policies.md."""
    assert trained_environment(name).keywords["randomise"] in ("within_20_percent", "default")


@pytest.mark.parametrize("name", sweep(shipped_policies(), plain=["StationKeeping"]))
def test_each_succeeds_in_episodes_that_it_has_never_seen(name: str) -> None:
    path = policy_path(name)
    env = make_environment(trained_environment(path))
    (score,) = evaluate(env, {name: load_policy(path)}, episodes=EPISODES, seed=UNSEEN)
    assert score.success_rate >= LEAST


def test_a_policy_is_flown_by_the_name_of_its_task() -> None:
    flown = run("evaluate", "--policy", "StationKeeping", "--agent", "zero", "--episodes", "1")
    assert flown.exit_code == 0, flown.output
    assert "StationKeeping" in flown.output


def test_python_knows_the_names_and_paths_as_text_too() -> None:
    path = shipped_policies()["StationKeeping"]
    assert (
        trained_environment("StationKeeping") == trained_environment(str(path)) == trained_environment(path)
    )
    assert isinstance(load_policy("StationKeeping"), OnnxPolicy)


@pytest.mark.parametrize("load", [load_policy, trained_environment])
def test_python_refuses_what_is_no_policy(load: Callable[[Any], Any], tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"policy = 7; give a name or a path"):
        load(7)
    with pytest.raises(
        InvalidInputError, match=r"'Stationkeeping' holds no run, and no policy .*StationKeeping"
    ):
        load("Stationkeeping")
    with pytest.raises(InvalidInputError, match=r"absent\.onnx"):
        load(str(tmp_path / "absent.onnx"))
    with pytest.raises(InvalidInputError, match=f"{tmp_path.name}"):
        load(tmp_path)


def test_an_environment_that_it_was_not_trained_for_is_refused_before_anything_is_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No page is opened, because no episode begins that anybody sees."""
    begin = MarineEnv.reset

    def begun(env: MarineEnv, **given: Any) -> Any:
        assert env.render_mode != "human"
        return begin(env, **given)

    monkeypatch.setattr(MarineEnv, "reset", begun)
    flown = run("fly", "--policy", "StationKeeping", "--set", "sensors=auv", "--live")
    assert_refused(flown, r"trained in dq_marine/StationKeeping-v0 .*sensors")


def test_what_is_no_policy_is_answered_with_the_names() -> None:
    assert_refused(
        run("fly", "--policy", "StationKeepin"),
        "'StationKeepin' holds no run, and no policy .*TrajectoryTracking",
    )
    with pytest.raises(InvalidInputError, match="hf://OWNER/NAME"):
        policy_path("nowhere")
    assert_refused(run("fly", "--policy", ""), "'' holds no run, and no policy .*TrajectoryTracking")
