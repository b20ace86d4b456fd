"""The door of run folders: a small real run of which something is damaged, then read, flown or resumed."""

from __future__ import annotations

import atexit
import functools
import io
import json
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from support.trainings import tiny

from dq_marine.agents.choice import common_environment, make_agents
from dq_marine.agents.environments import make_environment
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training, resume_training
from hostile.texts import spoil_entry
from hostile.values import Rng, spoilt

TIMESTEPS = 128
LARGEST = 1000
"""Of the counts in damaged settings with which a run is resumed: a case is to end within seconds."""


@functools.cache
def whole_run() -> Path:
    """A run that has ended, made once by a process."""
    folder = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    begin_training(RunFolder(folder / "run"), tiny(folder, "ppo", TIMESTEPS), console=quiet())
    return folder / "run"


def quiet() -> Console:
    return Console(file=io.StringIO())


def drawn_run_folder(rng: Rng) -> Callable[[], Any]:
    """A copy of a run, damaged or not, to be read, flown or resumed; it is removed in the end."""
    place = Path(tempfile.mkdtemp())
    run = place / "run"
    shutil.copytree(whole_run(), run)
    for _ in range(rng.integers(3)):
        spoil(rng, run)
    act = (flown, resumed, resumed_longer)[rng.integers(3)]

    def go() -> Any:
        try:
            return act(run)
        finally:
            shutil.rmtree(place)

    return go


def spoil(rng: Rng, run: Path) -> None:
    """Damage one of the files or folders of a run, or what one of its JSON files says."""
    entries = sorted(run.rglob("*"))
    tables = [one for one in entries if one.suffix == ".json" and one.is_file()]
    if not entries or (rng.integers(2) == 0 and not tables):
        return
    if rng.integers(2):
        spoil_entry(rng, entries[rng.integers(len(entries))])
        return
    table = tables[rng.integers(len(tables))]
    try:
        content = json.loads(table.read_bytes())
    except ValueError:  # it was damaged before
        return
    for _ in range(rng.integers(1, 3)):
        content = spoilt(rng, content)
    table.write_text(json.dumps(content, default=lambda value: type(value).__name__, skipkeys=True))


def flown(run: Path) -> Any:
    """Let the policy choose an action, as `fly` and `evaluate` do."""
    env = make_environment(common_environment([run]))
    agent = make_agents([], [run], env, seed=0)["run"]
    observation, _ = env.reset(seed=1)
    agent.reset(env)
    action = agent.act(observation)
    assert np.isfinite(action).all(), "an action that is no number"
    return action


def resumed(run: Path) -> Any:
    """Go on as the run says, which is refused where it has ended."""
    settings = RunFolder(run).read_plan().settings
    counts = (settings.timesteps, settings.envs, settings.evaluation.episodes, *settings.network.layers)
    if max(counts) > LARGEST or not is_short(settings.algorithm):
        return None
    return resume_training(RunFolder(run), console=quiet())


def is_short(algorithm: Any) -> bool:
    """Whether no count of an algorithm is large."""
    return all(value <= LARGEST for value in vars(algorithm).values() if isinstance(value, int | float))


def resumed_longer(run: Path) -> Any:
    """Go on for longer, and fly what came of it."""
    settings = RunFolder(run).read_plan().settings
    if max(settings.envs, settings.evaluation.episodes, *settings.network.layers) > LARGEST:
        return None
    if not is_short(settings.algorithm):
        return None
    resume_training(RunFolder(run), timesteps=TIMESTEPS + 32, console=quiet())
    return flown(run)
