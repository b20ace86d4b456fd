"""`dq-marine export`: what a file says of itself, what its card says, and what is not replaced."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from huggingface_hub import ModelCard
from support.command_line import assert_refused, run

from dq_marine.agents.deployment.description import PolicyDescription, described
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings

EPISODES, SEED = 2, 5
"""Those of the fixtures' exports."""


def test_a_file_says_what_it_was_trained_in_and_with(ppo: Any) -> None:
    plan = ppo.run.read_plan()
    description = OnnxPolicy(ppo.onnx).description
    assert description == ppo.exported.description
    assert description.environment == plan.settings.environment
    assert (description.seed, description.versions, description.timesteps) == (1, plan.versions, 128)
    env: Any = make_environment(plan.settings.environment).unwrapped
    assert description.control_period == env.control_period
    assert [one.name for one in description.actions] == list(env.action_names)
    assert [one.high for one in description.actions] == env.vehicle.wrench_limits.tolist()
    assert [(one.name, one.unit, one.size, one.bound) for one in description.observations] == [
        (one.name, one.unit, one.size, one.bound) for one in env.observations
    ]
    assert description.inputs == {"observation": env.observation_space.shape[0]}
    assert description.differences(env) == []


def test_commands_of_actuators_are_described_by_their_channels() -> None:
    environment = EnvironmentSettings(
        id="dq_marine/PathFollowing-v0",
        keywords={"vehicle": "remus100", "actuation": "thrusters", "level": "easy"},
    )
    given = {"algorithm": "sac", "seed": 0, "timesteps": 1, "versions": {}}
    description = described(environment, **given)
    env: Any = make_environment(environment).unwrapped
    assert [tuple(one.model_dump().values()) for one in description.actions] == list(env.vehicle.channels)
    assert (description.level, description.actuation) == ("easy", "thrusters")
    assert PolicyDescription.read(description.model_dump_json(), source="text") == description


def test_the_card_says_what_was_measured(ppo: Any, tmp_path: Path) -> None:
    card = ModelCard.load(ppo.card)
    data = card.data.to_dict()
    assert data["library_name"] == "dq-marine"
    assert {"reinforcement-learning", "ppo", "dq_marine/StationKeeping-v0"} <= set(data["tags"])
    policy = OnnxPolicy(ppo.onnx)
    env = make_environment(policy.description.environment)
    (score,) = evaluate(env, {"policy": policy}, episodes=EPISODES, seed=SEED)
    results = {one.metric_type: one.metric_value for one in card.data.eval_results}
    assert results["mean_reward"] == pytest.approx(score.returns.mean, abs=1e-3)
    assert results["success_rate"] == score.success_rate
    assert results["final_position_error_m"] == pytest.approx(
        score.metrics["position_error"].final.mean, abs=1e-3
    )
    assert f"| return | {score.returns.mean:.1f} | {score.returns.median:.1f} |" in card.text
    assert f"Over {EPISODES} episodes of the environment above, seeds 5 to 6" in card.text
    for said in ("| vehicle | BlueROV2 Heavy |", "| seed | 1 |", "| level | none |", "stable-baselines3 2"):
        assert said in card.text

    found = re.search(r"```toml\n(.*?)```", card.text, re.DOTALL)
    assert found is not None
    preset = tmp_path / "preset.toml"
    preset.write_text(found[1], encoding="utf-8")
    assert read_settings(preset, TrainingSettings) == ppo.run.read_plan().settings
    assert "dq-marine train --run run --preset preset.toml --seed 1" in card.text


def test_the_command_exports_and_says_what_it_wrote(ppo: Any, tmp_path: Path) -> None:
    out = tmp_path / "mine" / "swim | 2.onnx"
    result = run("export", ppo.run.path, "--out", out, "--episodes", "0")
    assert result.exit_code == 0, result.output
    assert f"Wrote {out}" in result.stdout
    assert out.read_bytes() == ppo.onnx.read_bytes()
    card = ModelCard.load(out.parent / "README.md")
    assert card.data.eval_results is None
    assert "No episodes were flown" in card.text
    result = run("evaluate", "--policy", out, "--episodes", "1", "--json", tmp_path / "scores.json")
    assert result.exit_code == 0, result.output
    scores = json.loads((tmp_path / "scores.json").read_text())
    assert [one["agent"] for one in scores["scores"]] == ["swim | 2"]
    assert scores["environment"]["keywords"] == {"start_radius": 1.0, "max_episode_steps": 30}
    assert_refused(
        run("export", ppo.run.path, "--out", out), "exists; choose another name, or replace it with"
    )
    assert run("export", ppo.run.path, "--out", out, "--episodes", "0", "--force").exit_code == 0


def test_nothing_is_replaced_or_written_by_mistake(ppo: Any, tmp_path: Path) -> None:
    (tmp_path / "README.md").write_text("mine")
    before = sorted(tmp_path.iterdir())
    refusals = {
        "README.md exists, and the card would take its place": (ppo.run.path, "--out", tmp_path / "a.onnx"),
        "ending '.h5'": (ppo.run.path, "--out", tmp_path / "a.h5"),
        "are in two folders": (ppo.run.path, "--out", tmp_path / "b/a.onnx", "--out", tmp_path / "c/a.pt"),
        "holds no run": (tmp_path / "nowhere", "--out", tmp_path / "b" / "a.onnx"),
    }
    for message, arguments in refusals.items():
        assert_refused(run("export", *arguments), message)
    assert sorted(tmp_path.iterdir()) == before
    assert (tmp_path / "README.md").read_text() == "mine"
