"""Training an agent with Stable-Baselines3, in a run folder that survives being killed."""

from __future__ import annotations

import importlib
import importlib.metadata
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as ProgressBar
from rich.table import Table

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import Score, evaluate
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.algorithms import OF_CONTRIB, Model
from dq_marine.agents.training.beginning import check_can_begin
from dq_marine.agents.training.callbacks import (
    Checkpoints,
    Evaluations,
    ProgressUpdates,
    Saver,
    check_callbacks,
)
from dq_marine.agents.training.curriculum import learn_lesson
from dq_marine.agents.training.episode_log import EpisodeLog
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.learners import (
    environments_of,
    load_model,
    make_evaluation_envs,
    make_model,
)
from dq_marine.agents.training.lessons import check_lesson, lessons_of
from dq_marine.agents.training.run_folder import LARGEST_SEED, RunFolder, RunPlan
from dq_marine.agents.training.snapshots import read_progress
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.callbacks import BaseCallback

    importlib.import_module("tensorboard")  # SB3 imports it when it begins to log

EVALUATION_SEED = 1_000_000
"""Of the evaluations while training: far from the seeds that training counts up from."""

SUMMARY_SEED = 2_000_000
"""Of the episodes flown for the summary."""


@dataclass(frozen=True)
class Summary:
    """How a run ended.

    Attributes:
        algorithm: its name.
        timesteps: learned from.
        wall_time: spent [s], over all sessions.
        steps_per_second: of the last session, evaluations included.
        score: of the best model, on episodes it did not see.
    """

    algorithm: str
    timesteps: int
    wall_time: float
    steps_per_second: float
    score: Score

    def as_dict(self) -> dict[str, Any]:
        """Return the summary as nested dictionaries, for JSON."""
        return {**vars(self), "score": self.score.as_dict()}


def begin_training(
    folder: RunFolder,
    settings: TrainingSettings,
    *,
    seed: int = 0,
    force: bool = False,
    console: Console,
    watch: bool = False,
    callbacks: Sequence[BaseCallback] = (),
) -> Summary:
    """Train from scratch.

    Args:
        folder: new or empty.
        settings: what to learn, where and how.
        seed: of networks, environments and draws, at most 2^32 - 1.
        force: replace the run in the folder.
        console: to tell progress on.
        watch: open a page that follows one of the environments.
        callbacks: of Stable-Baselines3's, besides those of a run; such as an experiment tracker's.

    Raises:
        InvalidInputError: the folder is taken, the seed is too large, a callback is none, or see `check_can_begin`.
    """
    check_callbacks(callbacks)
    seed = whole_number("seed", seed, least=0, most=LARGEST_SEED)
    check_can_begin(settings)  # so that a mistake leaves an earlier run untouched
    plan = RunPlan(settings, seed, _versions(settings))
    with folder.begun(plan, force=force):
        return _train(folder, plan, callbacks, console, watch)


def resume_training(
    folder: RunFolder,
    *,
    timesteps: int | None = None,
    console: Console,
    watch: bool = False,
    callbacks: Sequence[BaseCallback] = (),
) -> Summary:
    """Go on from the latest checkpoint, or from scratch if none was reached.

    Args:
        folder: of the run.
        timesteps: a new total; None keeps the run's.
        console: to tell progress on.
        watch: open a page that follows one of the environments.
        callbacks: of Stable-Baselines3's, besides those of a run; such as an experiment tracker's.

    Raises:
        InvalidInputError: there is no run, it has its timesteps already, or a callback is none.
    """
    check_callbacks(callbacks)
    folder.read_plan()  # so that nothing is written where no run is
    with folder.locked():
        plan = folder.read_plan()
        if timesteps is not None:
            settings = plan.settings.model_copy(update={"timesteps": timesteps})
            plan = RunPlan(settings, plan.seed, plan.versions)
        progress, total = folder.progress("checkpoints"), plan.settings.timesteps
        check_lesson(plan.settings, progress.lesson, folder.path)
        if folder.is_finished(total):  # else it may have been killed before it could say how it ended
            raise InvalidInputError(
                f"{folder.path} has learned from {progress.timesteps} timesteps, of {total} asked for; ask for more "
                "with --timesteps"
            )
        folder.write_plan(plan)
        return _train(folder, plan, callbacks, console, watch)


def summary_table(summary: Summary) -> Table:
    """Return the summary as a table."""
    score = summary.score
    table = Table(title=f"{summary.algorithm.upper()}: the best model, over {score.episodes} new episodes")
    table.add_column("quantity")
    table.add_column("value", justify="right", style="bold")
    table.add_row("mean return", f"{score.returns.mean:.1f}")
    for one in score.metrics.values():
        table.add_row(f"{one.metric.label} at the end, mean", one.metric.text(one.final.mean))
    table.add_row("success at the end", f"{score.success_rate:.0%}")
    table.add_row("timesteps", f"{summary.timesteps:,}")
    table.add_row("wall time", f"{summary.wall_time:.0f} s")
    table.add_row("timesteps per second", f"{summary.steps_per_second:,.0f}")
    return table


def _train(
    folder: RunFolder, plan: RunPlan, further: Sequence[BaseCallback], console: Console, watch: bool
) -> Summary:
    settings = plan.settings
    torch.set_num_threads(settings.torch_threads)
    saver = Saver(folder)
    model = _model(folder, plan, saver.lesson, console)
    began_at, wall_before = model.num_timesteps, saver.wall_time
    evaluations = Evaluations(
        make_evaluation_envs(settings),
        saver,
        every=settings.evaluation.every,
        training_envs=settings.envs,
        seed=EVALUATION_SEED,
        best=folder.progress("best").mean_return,
        at_first=settings.imitation is not None,
    )
    _learn(model, settings, saver, evaluations, further, console, watch)
    environments_of(model).close()
    saver.save("checkpoints", model)
    if folder.latest("best") is None:  # the run was shorter than the first evaluation
        saver.save("best", model)
    speed = (model.num_timesteps - began_at) / (saver.wall_time - wall_before)
    summary = Summary(
        settings.algorithm.name, model.num_timesteps, saver.wall_time, speed, _score(folder, settings)
    )
    folder.write_summary(summary.as_dict())
    return summary


def _learn(
    model: Model,
    settings: TrainingSettings,
    saver: Saver,
    evaluations: Evaluations,
    further: Sequence[BaseCallback],
    console: Console,
    watch: bool,
) -> None:
    """Let a model learn the lesson that it is at, and those that follow."""
    with _progress_bar(console) as bar:
        name, total = settings.algorithm.name.upper(), settings.timesteps
        task = bar.add_task(name, total=total, completed=model.num_timesteps, late="-", best="-")
        callbacks = [
            Checkpoints(saver, settings.checkpoint_every),
            EpisodeLog(),
            evaluations,
            ProgressUpdates(bar, task, evaluations),
            *further,
        ]
        while model.num_timesteps < total:
            if watch:
                environments_of(model).watch(0)
            if not learn_lesson(model, settings, saver.lesson, callbacks):
                break  # it has its timesteps, or a callback ended it
            saver.lesson += 1
            saver.save("checkpoints", model)
            console.print(_passed(settings, saver.lesson, model.num_timesteps))


def _passed(settings: TrainingSettings, lesson: int, timesteps: int) -> str:
    """Return what is said when a lesson comes next."""
    before, coming = (one.environment.keywords.get("level") for one in lessons_of(settings)[lesson - 1 :][:2])
    return f"Level {before} is learned after {timesteps:,} timesteps; next: {coming or 'without a level'}"


def _model(folder: RunFolder, plan: RunPlan, lesson: int, console: Console) -> Model:
    """Return the model to go on with: of the latest checkpoint, or a new one, which may begin as a copy."""
    checkpoint, settings = folder.latest("checkpoints"), lessons_of(plan.settings)[lesson]
    if checkpoint is None:
        model = make_model(settings, plan.seed, folder.tensorboard)
        if settings.imitation is not None:
            title = f"Imitating the {settings.imitation.teacher}"
            with console.status(title) as status:
                error = imitate(
                    model, settings, plan.seed, say=lambda words: status.update(f"{title}: {words}")
                )
            console.print(
                f"Begins as a copy of the {settings.imitation.teacher}: its actions differ by "
                f"{math.sqrt(error):.3f} of the actuators' reach, root mean square"
            )
        return model
    done = read_progress(checkpoint).timesteps
    return load_model(settings, checkpoint, (plan.seed + done) % (LARGEST_SEED + 1), folder.tensorboard)


def _score(folder: RunFolder, settings: TrainingSettings) -> Score:
    """Fly the best model on new episodes."""
    env = make_environment(settings.environment)
    agents: dict[str, Agent] = {settings.algorithm.name: TrainedPolicy(folder)}
    scores = evaluate(env, agents, episodes=settings.evaluation.episodes, seed=SUMMARY_SEED)
    env.close()
    return scores[0]


def _progress_bar(console: Console) -> ProgressBar:
    return ProgressBar(
        TextColumn("[bold]{task.description}"),
        BarColumn(bar_width=20),
        TextColumn("{task.percentage:3.0f}% of {task.total:,}"),
        TimeRemainingColumn(),
        TextColumn("return {task.fields[late]}, best {task.fields[best]}"),
        console=console,
    )


def _versions(settings: TrainingSettings) -> dict[str, str]:
    """Return what a run's numbers depend on beyond its settings."""
    names = ["dq-marine", "stable-baselines3", "torch", "numpy", "gymnasium"]
    if settings.algorithm.name in OF_CONTRIB:
        names.append("sb3-contrib")
    return {"python": sys.version.split()[0], **{name: importlib.metadata.version(name) for name in names}}
