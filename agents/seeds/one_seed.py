"""The run of one seed, wherever it is trained: begun, or gone on with from its latest checkpoint."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
import time
import zipfile
from pathlib import Path

from rich.console import Console

from dq_marine.agents.seeds.seeds_folder import SeedsFolder
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import LOCK_FILE, RunFolder
from dq_marine.util.files import new_folder
from dq_marine.util.locks import is_free

DYING = 120.0
"""How long the worker that trained a seed before may hold its folder after its machine was given up for lost [s]."""


def train_seed(run: RunFolder, settings: TrainingSettings, seed: int, console: Console) -> None:
    """Train one seed to its end; what was trained before is not trained again.

    Args:
        run: new, or of the same settings and seed.
        settings: what to learn, where and how.
        seed: of networks, environments and draws.
        console: to tell progress on.

    Raises:
        InvalidInputError: see `begin_training` and `resume_training`.
        MissingDependencyError: a library that learns is not installed.
        ValueError: the learner met numbers that are not finite.
    """
    from dq_marine.agents.training.training import begin_training, resume_training  # here: it imports torch

    if not run.holds_run:
        begin_training(run, settings, seed=seed, console=console)
    elif not run.is_finished(settings.timesteps):
        resume_training(run, console=console)


def train_seed_anywhere(folder: Path, mark: str, settings: TrainingSettings, seed: int) -> bytes | None:
    """Train one seed in its folder, or, on a machine that does not see it, in one that is then handed over whole.

    Args:
        folder: of all seeds, absolute.
        mark: that the folder has on the machine that asks.
        settings: what to learn, where and how.
        seed: of networks, environments and draws.

    Returns:
        The run's folder, packed, where this machine does not see `folder`; else None.
    """
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        console, seeds = Console(file=nowhere), SeedsFolder(folder)
        if seeds.has_mark(mark):
            run = seeds.run(seed)
            _wait_for_the_dying(run.path / LOCK_FILE)
            train_seed(run, settings, seed, console)
            return None
        with tempfile.TemporaryDirectory(prefix="dq-marine-seed-") as scratch:
            run = RunFolder(Path(scratch) / "run")
            train_seed(run, settings, seed, console)
            return _packed(run.path)


def take_over(packed: bytes, run: RunFolder) -> None:
    """Put a run that was handed over in its place; what was begun there before is replaced.

    Raises:
        InvalidInputError: the folder cannot be written.
    """
    with new_folder(run.path) as folder:
        # Unlike a tar, a zip stays within the folder in any Python.
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            archive.extractall(folder)
        if run.path.exists():
            shutil.rmtree(run.path)


def _packed(folder: Path) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:  # stored: models are compressed already
        for path in sorted(folder.rglob("*")):
            archive.write(path, path.relative_to(folder))
    return content.getvalue()


def _wait_for_the_dying(lock: Path) -> None:
    """Wait until nobody holds a lock, for some time: a lost worker may end later than its work is given to another."""
    end = time.monotonic() + DYING
    while lock.exists() and not is_free(lock) and time.monotonic() < end:
        time.sleep(0.2)
