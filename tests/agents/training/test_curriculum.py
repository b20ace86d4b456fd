"""Levels learned one after the other: when one is passed, what stays, what a stopped run goes on with."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console
from support.trainings import tiny
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator
from typer.testing import CliRunner

from dq_marine.agents.environments import with_keywords
from dq_marine.agents.settings import CurriculumSettings, TrainingSettings
from dq_marine.agents.training import curriculum, training
from dq_marine.agents.training.beginning import check_can_begin
from dq_marine.agents.training.curriculum import Graduation
from dq_marine.agents.training.lessons import lessons_of
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.snapshots import read_progress, write_progress
from dq_marine.agents.training.training import begin_training, resume_training
from dq_marine.agents.tuning.tuning import plan_of
from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError

TAG = "curriculum/lesson"


def learning(tmp_path: Path, timesteps: int = 320, level: str = "medium", **own) -> TrainingSettings:
    """Episodes of at most 30 steps in 2 environments: two end every 60 timesteps."""
    settings = tiny(tmp_path, "ppo", timesteps)
    asked = CurriculumSettings(**{"levels": ["easy"], "success": 0.0, "episodes": 4} | own)
    environment = with_keywords(settings.environment, level=level)
    return settings.model_copy(update={"curriculum": asked, "environment": environment})


def lessons_logged(folder: RunFolder) -> set[float]:
    """What TensorBoard shows, in all the files that it reads as one."""
    files = folder.tensorboard.rglob("events.out.tfevents.*")
    accumulators = [EventAccumulator(str(file)).Reload() for file in files]
    return {event.value for one in accumulators if TAG in one.Tags()["scalars"] for event in one.Scalars(TAG)}


@pytest.fixture
def console() -> Console:
    return Console(file=io.StringIO(), width=100)


@pytest.fixture
def flown_at(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The level of each set of environments that is learned in, in their order."""
    levels: list[str] = []
    for module in (training, curriculum):
        name = "make_model" if module is training else "make_training_envs"
        made = getattr(module, name)

        def note(settings: TrainingSettings, *rest, made=made):
            levels.append(settings.environment.keywords["level"])
            return made(settings, *rest)

        monkeypatch.setattr(module, name, note)
    return levels


def test_a_level_is_passed_once_and_what_was_learned_stays(
    tmp_path: Path, console: Console, flown_at: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    counts: list[float] = []
    go_on_to = curriculum._go_on_to

    def watched(model, lesson):
        counts.append(model.get_env().obs_rms.count)
        go_on_to(model, lesson)
        counts.append(model.get_env().obs_rms.count)

    monkeypatch.setattr(curriculum, "_go_on_to", watched)
    folder = RunFolder(tmp_path / "run")
    summary = begin_training(folder, learning(tmp_path), seed=1, console=console)
    assert flown_at == ["easy", "medium"]
    assert counts[0] == counts[1] > 100.0
    assert summary.timesteps >= 320
    told = console.file.getvalue()  # type: ignore[attr-defined]
    assert "Level easy is learned after 1" in told
    assert told.count("is learned after") == 1
    assert folder.progress("checkpoints").lesson == 1
    assert lessons_logged(folder) == {0.0}


def test_a_stopped_run_goes_on_with_its_lesson(tmp_path: Path, console: Console, flown_at: list[str]) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, learning(tmp_path, 64, episodes=1000), seed=1, console=console)
    assert folder.progress("checkpoints").lesson == 0
    made = training.load_model
    levels: list[str] = []

    def loaded(settings, *rest):
        levels.append(settings.environment.keywords["level"])
        return made(settings, *rest)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training, "load_model", loaded)
        resume_training(folder, timesteps=128, console=console)
        assert levels == ["easy"]
        plan = folder.read_plan()
        sooner = plan.settings.model_copy(
            update={"curriculum": CurriculumSettings(levels=["easy"], success=0.0, episodes=2)}
        )
        folder.write_plan(type(plan)(sooner, plan.seed, plan.versions))
        resume_training(folder, timesteps=320, console=console)
        assert folder.progress("checkpoints").lesson == 1
        resume_training(folder, timesteps=384, console=console)
    assert levels == ["easy", "easy", "medium"]


def test_a_snapshot_at_a_lesson_that_the_run_does_not_have_is_refused(
    tmp_path: Path, console: Console
) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, tiny(tmp_path, "ppo", 64), console=console)
    snapshot = folder.latest("checkpoints")
    assert snapshot is not None
    write_progress(snapshot, replace(read_progress(snapshot), lesson=9))
    plan = folder.read_plan()
    with pytest.raises(InvalidInputError, match=r"was at lesson 9, counted from 0, and run\.json has 1;"):
        resume_training(folder, timesteps=128, console=console)
    assert folder.read_plan() == plan


@pytest.mark.parametrize(("enough", "passes"), [(0.5, True), (0.6, False)])
def test_enough_of_the_last_episodes_must_succeed(enough: float, passes: bool) -> None:
    graduation = Graduation(CurriculumSettings(levels=["easy"], success=enough, episodes=4), 0)
    logger = SimpleNamespace(record=lambda *_: None)
    graduation.model = SimpleNamespace(num_timesteps=0, logger=logger)  # type: ignore[assignment]
    # Of two environments, not all of which end at each step.
    ends = [(True, False), (False, False), (True, True)]
    going_on = []
    for successes, dones in zip(ends, [(True, True), (False, True), (True, False)], strict=True):
        graduation.locals = {
            "infos": [{"is_success": one} for one in successes],
            "dones": np.array(dones),
        }
        going_on.append(graduation.on_step())
    assert going_on == [True, True, not passes]


def test_lessons_are_levels_and_at_last_the_run_itself(tmp_path: Path) -> None:
    settings = learning(tmp_path, levels=["easy", "medium"], level="hard")
    levels = [one.environment.keywords["level"] for one in lessons_of(settings)]
    assert levels == ["easy", "medium", "hard"]
    assert lessons_of(settings)[-1] is settings
    assert lessons_of(tiny(tmp_path, "ppo")) == [tiny(tmp_path, "ppo")]


def test_what_cannot_be_learned_one_after_the_other_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="level = 'novice'"):
        check_can_begin(learning(tmp_path, levels=["novice"]))
    with pytest.raises(InvalidInputError, match="at level 'easy' the observations"):
        check_can_begin(learning(tmp_path, level="hard"))
    with pytest.raises(InvalidInputError, match=r"leave \[curriculum\] out"):
        plan_of(learning(tmp_path), seed=0)


def test_the_command_takes_levels() -> None:
    asked = ["train", "--print-preset", "--task", "Docking", "--level", "medium", "--curriculum", "easy"]
    printed = CliRunner().invoke(app, asked)
    assert printed.exit_code == 0, printed.output
    assert '[curriculum]\nlevels = ["easy"]' in printed.output
