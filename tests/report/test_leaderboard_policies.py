"""A trained policy on the leaderboard: what is known of it, and that it flies by its own model."""

from __future__ import annotations

import io
import shutil
from pathlib import Path

import pytest
from rich.console import Console
from support.trainings import tiny

from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.training.run_folder import MODEL_FILE, RunFolder
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training
from dq_marine.envs.scenarios.environment import make_scenario
from dq_marine.errors import InvalidInputError
from dq_marine.report.leaderboard import Entry, Plan, fly_entry
from dq_marine.report.leaderboard_policies import policies_of

TASK = "dq_marine/StationKeeping-v0"
ENTRY = Entry(TASK, "bluerov2_heavy", "", "mine", "head_current")
PLAN = Plan(0, 0)


def test_a_policy_flies_what_it_fits_by_its_own_model(tmp_path: Path) -> None:
    run = tmp_path / "mine"
    begin_training(RunFolder(run), tiny(tmp_path, "ppo"), seed=1, console=Console(file=io.StringIO()))
    (policy,) = policies_of([run])
    assert (policy.name, policy.task, policy.vehicle) == ("mine", TASK, "bluerov2_heavy")
    assert policy.fits(EnvironmentSettings(id=TASK, keywords={"level": "easy"}))
    assert not policy.fits(EnvironmentSettings(id=TASK, keywords={"sensors": "auv"}))
    assert not policy.fits(EnvironmentSettings(id="dq_marine/Docking-v0"))

    env = make_scenario("StationKeeping/head_current")
    (score,) = evaluate(env, {"mine": TrainedPolicy(RunFolder(run))}, episodes=1, seed=0)
    result = fly_entry(ENTRY, PLAN, policy)
    assert result.score == score.as_dict()
    assert result.policy == policy.digest

    copied = shutil.copytree(run, tmp_path / "again" / "mine")
    assert [one.name for one in policies_of([run, copied])] == [f"{tmp_path.name}-mine", "again-mine"]
    with pytest.raises(InvalidInputError, match="two agents called 'mine'"):
        policies_of([run, run])
    for model in copied.rglob(MODEL_FILE):
        model.write_bytes(b"another")
    with pytest.raises(InvalidInputError, match="is damaged"):
        policies_of([copied])


@pytest.mark.parametrize(
    ("name", "message"), [("nowhere", "holds no run"), ("controller", "two agents called")]
)
def test_what_is_no_policy_is_refused(tmp_path: Path, name: str, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        policies_of([tmp_path / name])
