"""Training end to end with tiny networks: begun, killed, resumed, loaded, evaluated."""

from __future__ import annotations

import io
import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console
from stable_baselines3.common.callbacks import BaseCallback
from support.sweeps import sweep
from support.trainings import ALGORITHMS, REMEMBERING, preset, tiny
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from dq_marine.agents.choice import common_environment, make_agents, other_conditions
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, with_keywords
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.keywords import with_changes
from dq_marine.agents.training.run_folder import REPLAY_BUFFER_FILE, RunFolder
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training, resume_training, summary_table
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError


@pytest.fixture
def console() -> Console:
    return Console(file=io.StringIO(), width=100)


def logged_tags(folder: Path) -> dict[str, list[float]]:
    """Return what TensorBoard shows, by tag."""
    tags: dict[str, list[float]] = {}
    for file in folder.rglob("events.out.tfevents.*"):
        events = EventAccumulator(str(file)).Reload()
        for tag in events.Tags()["scalars"]:
            tags.setdefault(tag, []).extend(event.value for event in events.Scalars(tag))
    return tags


@pytest.mark.parametrize("algorithm", sweep(ALGORITHMS, plain=["ppo", "sac", "recurrent_ppo"]))
def test_a_run_from_start_to_evaluation(tmp_path: Path, algorithm: str, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    summary = begin_training(folder, tiny(tmp_path, algorithm), seed=1, console=console)
    assert summary.timesteps == 256
    assert json.loads((folder.path / "summary.json").read_text())["timesteps"] == 256
    assert list(folder.tensorboard.rglob("events.out.tfevents.*"))
    latest, best = folder.latest("checkpoints"), folder.latest("best")
    assert latest is not None
    assert best is not None
    assert folder.progress("best").mean_return is not None
    assert (latest / REPLAY_BUFFER_FILE).exists() == (algorithm in REMEMBERING)
    assert not (best / REPLAY_BUFFER_FILE).exists()
    console.print(summary_table(summary))
    tags = logged_tags(folder.tensorboard)
    for group in ("episode_end", "eval/episode_end"):
        for name in ("position_error_m", "attitude_error_deg", "success_rate"):
            assert f"{group}/{name}" in tags
    for name in task_named(DEFAULT_ENVIRONMENT.id).reward_names:
        assert f"episode_reward/{name}" in tags
        assert f"eval/episode_reward/{name}" in tags
    assert "timesteps per second" in console.file.getvalue()  # type: ignore[attr-defined]

    assert common_environment([folder.path]).keywords == {"start_radius": 1.0, "max_episode_steps": 30}
    env = make_environment(common_environment([folder.path]), max_episode_steps=10)
    agents = make_agents(["zero"], [folder.path], env, seed=0)
    assert list(agents) == ["zero", "run"]
    first, again = (evaluate(env, agents, episodes=2, seed=5) for _ in range(2))
    assert first == again


class Enough(BaseCallback):
    """Ends a training after some timesteps."""

    def __init__(self, timesteps: int) -> None:
        super().__init__()
        self._timesteps = timesteps

    def _on_step(self) -> bool:
        return self.num_timesteps < self._timesteps


def test_a_callback_of_the_callers_own_follows_a_run_and_may_end_it(tmp_path: Path, console: Console) -> None:
    folder, settings = RunFolder(tmp_path / "run"), tiny(tmp_path, "ppo")
    assert begin_training(folder, settings, console=console, callbacks=[Enough(100)]).timesteps == 100
    assert folder.progress("checkpoints").timesteps == 100
    assert resume_training(folder, console=console, callbacks=[Enough(180)]).timesteps == 180
    assert resume_training(folder, console=console).timesteps == 276


@pytest.mark.parametrize("callbacks", [5, [5], [Enough]])
def test_what_is_no_callback_is_refused_before_anything_is_written(
    tmp_path: Path, console: Console, callbacks: Any
) -> None:
    folder, settings = RunFolder(tmp_path / "run"), tiny(tmp_path, "ppo", 64)
    with pytest.raises(InvalidInputError, match=r"callbacks = .*; give a list of callbacks"):
        begin_training(folder, settings, console=console, callbacks=callbacks)
    assert not folder.path.exists()


def test_training_follows_from_its_seed(tmp_path: Path, console: Console) -> None:
    env = make_environment(DEFAULT_ENVIRONMENT)
    observation, _ = env.reset(seed=0)
    actions = []
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        folder = RunFolder(tmp_path / name)
        begin_training(folder, tiny(tmp_path, "ppo", 64), seed=seed, console=console)
        actions.append(TrainedPolicy(folder).act(observation))
    np.testing.assert_array_equal(actions[0], actions[1])
    assert (actions[0] != actions[2]).any()


def killed_after_first_checkpoint(tmp_path: Path, algorithm: str, folder: RunFolder, timesteps: int) -> None:
    """Train in another process and kill it without warning, some time after its first checkpoint."""
    command = "from dq_marine.cli.main import app; app()"
    arguments = ["train", "--run", str(folder.path), "--preset", str(preset(tmp_path, algorithm, timesteps))]
    process = subprocess.Popen(
        [sys.executable, "-c", command, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        deadline = time.monotonic() + 600.0
        while folder.latest("checkpoints") is None:
            assert process.poll() is None, "it ended before its first checkpoint"
            assert time.monotonic() < deadline, "it took too long to its first checkpoint"
            time.sleep(0.005)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == -signal.SIGKILL


@pytest.mark.parametrize(
    ("algorithm", "timesteps"), sweep([(one, 1024) for one in ALGORITHMS], plain=[("ppo", 1024)])
)
def test_a_killed_run_is_resumed_to_the_same_total(
    tmp_path: Path, algorithm: str, timesteps: int, console: Console
) -> None:
    folder = RunFolder(tmp_path / "run")
    killed_after_first_checkpoint(tmp_path, algorithm, folder, timesteps)
    before = folder.progress("checkpoints")
    assert 0 < before.timesteps < timesteps
    summary = resume_training(folder, console=console)
    assert summary.timesteps == timesteps
    assert folder.progress("checkpoints").timesteps == timesteps
    assert summary.wall_time > before.wall_time
    with pytest.raises(
        InvalidInputError, match=rf"learned from {timesteps} timesteps, .* more with --timesteps"
    ):
        resume_training(folder, console=console)


def test_a_finished_run_is_extended(tmp_path: Path, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, tiny(tmp_path, "ppo", 128), console=console)
    best = folder.progress("best").mean_return
    assert resume_training(folder, timesteps=256, console=console).timesteps == 256
    assert folder.read_plan().settings.timesteps == 256
    after = folder.progress("best").mean_return
    assert best is not None
    assert after is not None
    assert after >= best


@pytest.mark.parametrize("left", ["", "{}", None])
def test_a_run_killed_after_its_last_checkpoint_says_how_it_ended(
    tmp_path: Path, left: str | None, console: Console
) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, tiny(tmp_path, "ppo", 64), console=console)
    summary = folder.path / "summary.json"
    summary.unlink()
    if left is not None:
        summary.write_text(left)
    assert resume_training(folder, console=console).timesteps == 64
    assert json.loads(summary.read_text())["timesteps"] == 64
    with pytest.raises(InvalidInputError, match="learned from 64 timesteps"):
        resume_training(folder, console=console)


def test_a_run_without_checkpoint_starts_again(tmp_path: Path, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, tiny(tmp_path, "ppo", 64), console=console)
    for kind in ("checkpoints", "best"):
        snapshot = folder.latest(kind)
        assert snapshot is not None
        snapshot.rename(tmp_path / kind)
    with pytest.raises(InvalidInputError, match=r"has saved no model yet; continue it with .*--resume"):
        TrainedPolicy(folder)
    assert resume_training(folder, console=console).timesteps == 64


def test_a_wrong_environment_leaves_an_earlier_run_alone(tmp_path: Path, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    settings = tiny(tmp_path, "ppo", 64)
    begin_training(folder, settings, console=console)
    wrong = settings.model_copy(
        update={"environment": with_keywords(settings.environment, vehicle="titanic")}
    )
    with pytest.raises(InvalidInputError, match="titanic"):
        begin_training(folder, wrong, force=True, console=console)
    TrainedPolicy(folder)


@pytest.mark.parametrize("seed", [2**32, -1])
def test_a_seed_that_numpy_does_not_take_is_refused_before_anything_is_written(
    tmp_path: Path, console: Console, seed: int
) -> None:
    """The campaign of hostile cases found this: case 10,097,921."""
    with pytest.raises(InvalidInputError, match=r"seed = .*(from 0 to 4294967295|0 or more)"):
        begin_training(RunFolder(tmp_path / "run"), tiny(tmp_path, "ppo", 64), seed=seed, console=console)
    assert not (tmp_path / "run").exists()


def test_a_policy_is_refused_where_it_does_not_fit(tmp_path: Path, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, tiny(tmp_path, "ppo", 64), console=console)
    source = Path("dq_marine/vehicles/catalogue/bluerov2_heavy.toml")
    text = (Path(__file__).parents[3] / source).read_text(encoding="utf-8")
    limits = "wrench = [113.0, 113.0, 160.0, 34.9, 19.2, 30.2]"
    assert limits in text
    mine = tmp_path / "mine.toml"
    mine.write_text(text.replace(limits, "wrench = [113.0, 0.0, 160.0, 34.9, 19.2, 30.2]"), encoding="utf-8")
    env = make_environment(DEFAULT_ENVIRONMENT, vehicle=str(mine))
    with pytest.raises(
        InvalidInputError, match=r"trained with action shape \(6,\), the environment has \(5,\)"
    ):
        TrainedPolicy(folder).reset(env)


def test_runs_of_different_environments_are_not_compared(tmp_path: Path, console: Console) -> None:
    settings = tiny(tmp_path, "ppo", 64)
    other = settings.model_copy(update={"environment": with_keywords(settings.environment, current=0.1)})
    runs = [tmp_path / "a", tmp_path / "b"]
    for run, one in zip(runs, (settings, other), strict=True):
        begin_training(RunFolder(run), one, console=console)
    with pytest.raises(InvalidInputError, match="compare them one at a time, or say with --set"):
        common_environment(runs)
    together = common_environment(runs, change=lambda one: with_changes(one, {"current": 0.2}))
    assert together.keywords["current"] == 0.2
    assert other_conditions(runs, together) == {
        "a": {"current": (None, 0.2)},
        "b": {"current": (0.1, 0.2)},
    }
    assert other_conditions(runs[:1], common_environment(runs[:1])) == {}
