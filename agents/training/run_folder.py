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

from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.snapshots import Progress, is_whole, read_progress, write_progress
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import new_folder, write_json
from dq_marine.util.locks import FileLock, HeldLockError

MODEL_FILE = "model.zip"
NORMALISATION_FILE = "normalisation.pkl"
REPLAY_BUFFER_FILE = "replay_buffer.pkl"
LOCK_FILE = "run.lock"

Kind = Literal["checkpoints", "best"]


@dataclass(frozen=True)
class RunPlan:
    """What a run was asked to do: `run.json`."""

    settings: TrainingSettings
    seed: int
    versions: dict[str, str]


class RunFolder:
    """Reads and writes a run's folder; knows nothing of what is in the models."""

    def __init__(self, path: str | Path) -> None:
        """Take a folder, which need not exist."""
        self.path = Path(path).expanduser()
        self.tensorboard = self.path / "tensorboard"
        self._plan_file = self.path / "run.json"
        self._summary_file = self.path / "summary.json"

    @property
    def holds_run(self) -> bool:
        """Whether a run was begun here."""
        return self._plan_file.is_file()

    def begin(self, plan: RunPlan, *, force: bool) -> None:
        """Create the folder and write the plan.

        Raises:
            InvalidInputError: a run is here and `force` is not set, or something else than a run is here.
        """
        if self.holds_run:
            if not force:
                raise InvalidInputError(
                    f"{self.path} holds a run already; continue it with --resume, replace it with --force, or "
                    "choose another folder"
                )
            with self.locked():
                self._remove_run()
        elif self.path.exists() and (not self.path.is_dir() or self._holds_anything()):
            raise InvalidInputError(
                f"{self.path} exists and is not a run; choose a new or empty folder (nothing was removed)"
            )
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InvalidInputError(
                f"{self.path} cannot be made: {error.strerror}; choose a folder that can be written"
            ) from error
        self.write_plan(plan)

    @contextlib.contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other processes from training here.

        Raises:
            InvalidInputError: one trains here already, or the folder cannot be written.
        """
        try:
            lock = FileLock(self.path / LOCK_FILE)
        except HeldLockError as error:
            raise InvalidInputError(
                f"{self.path} is being trained by process {error.owner}; wait until it has ended, or end it"
            ) from error
        except OSError as error:
            raise InvalidInputError(f"{self.path} cannot be written: {error.strerror}") from error
        try:
            yield
        finally:
            lock.release()

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
            InvalidInputError: there is no run here, or its plan is damaged.
        """
        if not self.holds_run:
            raise InvalidInputError(
                f"{self.path} holds no run (no run.json); check the path given with --run"
            )
        source = str(self._plan_file)
        try:
            content = json.loads(self._plan_file.read_text(encoding="utf-8"))
            seed, versions, settings = content["seed"], content["versions"], content["settings"]
        except (ValueError, KeyError, TypeError) as error:
            raise InvalidInputError(f"{source} is damaged: {error!r}; train anew with --force") from error
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

    def progress(self, kind: Kind) -> Progress:
        """Return how far the run was at the latest snapshot; nowhere if there is none."""
        folder = self.latest(kind)
        if folder is None:
            return Progress(0, 0.0)
        return read_progress(folder)

    def write_summary(self, content: dict[str, Any]) -> None:
        """Write `summary.json`."""
        write_json(self._summary_file, content)

    def _snapshots(self, kind: Kind) -> list[Path]:
        return list((self.path / kind).glob("[0-9]*"))

    def _holds_anything(self) -> bool:
        return any(one.name != LOCK_FILE for one in self.path.iterdir())

    def _remove_run(self) -> None:
        """Remove what a run writes, and nothing else; the plan last, so that an interrupted removal can be resumed."""
        for folder in (self.path / "checkpoints", self.path / "best", self.tensorboard):
            shutil.rmtree(folder, ignore_errors=True)
        self._summary_file.unlink(missing_ok=True)
        self._plan_file.unlink()
