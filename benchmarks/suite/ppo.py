"""Section: training with PPO, against PPO on environments that do nothing."""

from __future__ import annotations

import statistics
from pathlib import Path
from typing import Any

from dq_marine.agents.algorithm_settings import PPOSettings
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.errors import MissingDependencyError
from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed, rounded
from suite.plan import NotInstalledError, Plan, Section
from suite.tables import found, noise, table

PRESET = "ppo"
SIZES = (32, 256, 1024)
QUICK_SIZES = (32, 256)
LEAST_STEPS = 12_288
"""Environment steps in a call of `learn` at the least: three rollouts of the preset's size, more than an episode."""

OURS, IDLE = "dq-marine", "nothing"

METHOD = f"""\
Stable-Baselines3's PPO runs with the project's preset `{PRESET}`: network, hyperparameters, normalisation, number of
torch threads, and environments in `MarineVecEnv`, `VecMonitor` and `VecNormalize`, as in `dq-marine train`. It is
compared with the same PPO on as many environments of the same spaces, in the same wrappers, that do nothing: they
return the same observations at every step, and their episodes do not end. The figures are environment steps per second
of collecting and learning together, over whole rollouts, in alternating rounds. The ratio is that of the two in one
round; it would be 1 for a simulator that costs nothing.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a step of training."""
    try:
        import dq_marine.agents.training.learners  # noqa: F401 - says what is missing
    except MissingDependencyError as error:
        raise NotInstalledError(str(error)) from error
    import torch

    settings = read_settings(PRESET, TrainingSettings)
    torch.set_num_threads(settings.torch_threads)
    rows: list[Row] = []
    for size in plan.pick(SIZES, QUICK_SIZES):
        rows += rows_of_size(plan, settings.model_copy(update={"envs": size}))
    return {"torch_threads": settings.torch_threads, "rows": rows}


def rows_of_size(plan: Plan, settings: TrainingSettings) -> list[Row]:
    """Return both kinds of training with one number of environments, measured in turn."""
    plan.tell(f"{settings.envs:,} environments")
    models = {OURS: model_of(settings), IDLE: model_of(settings, idle=True)}
    cases = {name: learning(model, settings) for name, model in models.items()}
    plan.tell(f"{settings.envs:,} environments, both in turn")
    timings = plan.compare(cases)
    for model in models.values():
        model.get_env().close()
    pairs = zip(timings[IDLE].samples, timings[OURS].samples, strict=True)
    ratios = [rounded(idle / ours) for idle, ours in pairs]
    rows = [
        {"environments": settings.envs, "kind": name} | timing.full_row() for name, timing in timings.items()
    ]
    rows[0]["ratios"] = ratios
    return rows


def model_of(settings: TrainingSettings, *, idle: bool = False) -> Any:
    """Return an untrained model with its environments, which logs nowhere."""
    from dq_marine.agents.training.learners import make_model
    from suite.idle_env import idle_likeness

    model = make_model(settings, seed=0, tensorboard=Path())
    model.tensorboard_log = None
    if idle:
        envs = model.get_vec_normalize_env()
        model.set_env(idle_likeness(envs))
        envs.close()
    return model


def learning(model: Any, settings: TrainingSettings) -> Timed:
    """Return the case of some rollouts, each collected and learned from."""
    assert isinstance(settings.algorithm, PPOSettings)
    rollout = settings.envs * settings.algorithm.n_steps
    steps = rollout * -(-LEAST_STEPS // rollout)
    return Timed(lambda: model.learn(steps, reset_num_timesteps=False), steps)


def tables(content: dict[str, Any]) -> str:
    """Return rates and their ratio by number of environments."""
    rows = content["rows"]
    lines = []
    for size in distinct(rows, "environments"):
        ours, idle = (found(rows, environments=size, kind=kind) for kind in (OURS, IDLE))
        ratios = ours["ratios"]
        rates = [f"{1e9 / row['median_ns']:,.0f}" for row in (ours, idle)]
        spread = f"{min(ratios):.2f} to {max(ratios):.2f}"
        lines.append([f"{size:,}", *rates, three_digits(statistics.median(ratios)), spread])
    header = ["environments", "steps a second (median)", "on nothing", "ratio (median)", "over the rounds"]
    return table(header, lines) + "\n" + noise(rows)


def headline(content: dict[str, Any]) -> str:
    """Return the rates and the ratios."""
    ours = [row for row in content["rows"] if row["kind"] == OURS]
    shown = [
        f"{row['environments']:,} environments {1e9 / row['median_ns']:,.0f} "
        f"({statistics.median(row['ratios']):.0%} of the speed on nothing)"
        for row in ours
    ]
    return f"steps/s of training: {', '.join(shown)}"


SECTION = Section("ppo", "Training with PPO", METHOD, measure, tables, headline)
