"""The folder of a training run: what was asked, checkpoints, the best model, logs.

    run.json               settings, seed and versions
    checkpoints/000007/    the latest, and the one before: model.zip, normalisation.pkl, progress.json (SAC:
                           replay_buffer.pkl too)
    best/000003/           the best evaluated, and the one before: the same, without the replay buffer
    tensorboard/           logs
    summary.json           how it ended
    run.lock               process number of the training in progress, which keeps others out

A snapshot folder is complete or absent, and the latest has the highest number, so a run can be resumed whenever
it was killed. Where the latest was damaged since, the one before takes its place.
"""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from dq_marine.agents.locked_folder import folder_locked, holds_anything
from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.snapshots import Progress, is_whole, read_progress, write_progress
from dq_marine.checks import existing_file, possible_path, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import new_folder, unwritable, write_json

MODEL_FILE = "model.zip"
NORMALISATION_FILE = "normalisation.pkl"
REPLAY_BUFFER_FILE = "replay_buffer.pkl"
LOCK_FILE = "run.lock"

LARGEST_SEED = 2**32 - 1
"""Of a run: NumPy's global generator, which stable-baselines3 seeds too, takes no larger one."""

Kind = Literal["checkpoints", "best"]


@dataclass(frozen=True)
class RunPlan:
    """What a run was asked to do: `run.json`."""

    settings: TrainingSettings
    seed: int
    versions: dict[str, str]


def damaged_summary(path: Path, error: Exception) -> InvalidInputError:
    """Return what to raise where a run's summary does not say how the run ended."""
    return InvalidInputError(
        f"{path} is missing or damaged: {shown(error)}; remove it, and continue the run, which writes it again"
    )


class RunFolder:
    """Reads and writes a run's folder; knows nothing of what is in the models."""

    def __init__(self, path: str | Path) -> None:
        """Take a folder, which need not exist.

        Raises:
            InvalidInputError: no folder can have such a path.
        """
        self.path = possible_path("run", path)
        self.tensorboard = self.path / "tensorboard"
        self._plan_file = self.path / "run.json"
        self.summary_file = self.path / "summary.json"

    @property
    def holds_run(self) -> bool:
        """Whether a run was begun here."""
        return self._plan_file.is_file()

    @contextlib.contextmanager
    def begun(self, plan: RunPlan, *, force: bool) -> Iterator[None]:
        """Create the folder and write the plan; keep other processes from training here within the block.

        Raises:
            InvalidInputError: a run is here and `force` is not set, something else than a run is here, another process
                trains here, or the folder cannot be written.
        """
        self._check_free(force)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise unwritable(self.path, error) from error
        with self.locked():
            self._check_free(force)  # again: another process may have begun a run before the lock was ours
            self.remove_run()
            self.write_plan(plan)
            yield

    def _check_free(self, force: bool) -> None:
        """Refuse to begin where a run is that is not to be replaced, or something else."""
        if self.holds_run and not force:
            raise InvalidInputError(
                f"{self.path} holds a run already; continue it with --resume, replace it with --force, or choose "
                "another folder"
            )
        if not self.holds_run and holds_anything(self.path, LOCK_FILE):
            raise InvalidInputError(
                f"{self.path} exists and is not a run; choose a new or empty folder (nothing was removed)"
            )

    @contextlib.contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other processes from training here within the block, which writes into the folder.

        Raises:
            InvalidInputError: one trains here already, or the folder cannot be written, at first or later.
        """
        with folder_locked(self.path, LOCK_FILE, doing="trained"):
            yield

    def write_plan(self, plan: RunPlan) -> None:
        """Write `run.json`."""
        content = {
            "seed": plan.seed,
            "settings": plan.settings.model_dump(mode="json"),
            "versions": plan.versions,
        }
        write_json(self._plan_file, content)

    def read_plan(self) -> RunPlan:
        """Read `run.json`.

        Raises:
            InvalidInputError: there is no run here, or its plan is damaged or cannot be read.
        """
        if not self.holds_run:
            raise InvalidInputError(
                f"{self.path} holds no run (no run.json); give the folder that `dq-marine train` wrote"
            )
        source = str(self._plan_file)
        try:
            content = json.loads(self._plan_file.read_text(encoding="utf-8"))
            seed = whole_number("seed", content["seed"], least=0, most=LARGEST_SEED)
            versions = {str(name): str(number) for name, number in content["versions"].items()}
            settings = content["settings"]
        except OSError as error:
            raise InvalidInputError(
                f"{source} cannot be read: {error.strerror}; let yourself read it"
            ) from error
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise InvalidInputError(
                f"{source} is damaged: {shown(error)}; restore it from a copy, or train anew with --force"
            ) from error
        return RunPlan(validate_settings(settings, TrainingSettings, source=source), seed, versions)

    def save(self, kind: Kind, progress: Progress, write: Callable[[Path], None]) -> None:
        """Save a snapshot and drop those before it.

        Args:
            kind: which series it belongs to.
            progress: where the run is.
            write: called with a folder to write model, normalisation and so on into.
        """
        before = self._snapshots(kind)
        number = 1 + max((int(folder.name) for folder in before), default=0)
        with new_folder(self.path / kind / f"{number:06d}") as folder:
            write(folder)
            write_progress(folder, progress)
        for older in sorted(before)[:-1]:
            shutil.rmtree(older)

    def latest(self, kind: Kind) -> Path | None:
        """Return the folder of the latest snapshot that is not damaged, None if there never was one.

        Raises:
            InvalidInputError: there are snapshots, and all are damaged.
        """
        found = sorted(self._snapshots(kind), reverse=True)
        whole = next(filter(is_whole, found), None)
        if found and whole is None:
            raise InvalidInputError(
                f"{found[0]} is damaged: a file is missing or is not as it was written; restore it from a copy, or "
                "train anew with --force"
            )
        return whole

    @property
    def trained_snapshot(self) -> Path:
        """The folder of the best model; of the latest, if none was evaluated yet.

        Raises:
            InvalidInputError: none was saved yet, or all are damaged.
        """
        snapshot = self.latest("best") or self.latest("checkpoints")
        if snapshot is None:
            raise InvalidInputError(
                f"{self.path} has saved no model yet; continue it with `dq-marine train --run {self.path} --resume`"
            )
        return snapshot

    def progress(self, kind: Kind) -> Progress:
        """Return how far the run was at the latest snapshot; nowhere if there is none."""
        folder = self.latest(kind)
        if folder is None:
            return Progress(0, 0.0)
        return read_progress(folder)

    def write_summary(self, content: dict[str, Any]) -> None:
        """Write `summary.json`."""
        write_json(self.summary_file, content)

    def is_summed_up(self, timesteps: int) -> bool:
        """Whether `summary.json` is there, and of a run that ended after so many timesteps."""
        try:
            file = existing_file("summary", self.summary_file)  # a pipe would never end
            return file is not None and bool(
                json.loads(file.read_text(encoding="utf-8"))["timesteps"] == timesteps
            )
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            return False

    def is_finished(self, timesteps: int) -> bool:
        """Whether the run has learned from that many timesteps, and has said how it ended.

        Raises:
            InvalidInputError: all checkpoints are damaged.
        """
        done = self.progress("checkpoints").timesteps
        return done >= timesteps and self.is_summed_up(done)

    def read_summary(self) -> Any:
        """Read `summary.json`.

        Raises:
            InvalidInputError: it is missing, or cannot be read as JSON.
        """
        try:
            return json.loads(self.summary_file.read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError) as error:
            raise damaged_summary(self.summary_file, error) from error

    def _snapshots(self, kind: Kind) -> list[Path]:
        return [one for one in (self.path / kind).glob("[0-9]*") if one.name.isdecimal() and one.is_dir()]

    def remove_run(self) -> None:
        """Remove what a run wrote, and nothing else; the plan last, so that an interrupted removal can be resumed.

        Who calls it holds the lock.
        """
        if not self.holds_run:
            return
        for folder in (self.path / "checkpoints", self.path / "best", self.tensorboard):
            shutil.rmtree(folder, ignore_errors=True)
        self.summary_file.unlink(missing_ok=True)
        self._plan_file.unlink()
