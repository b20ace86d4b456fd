"""The folder of a training run: what was asked, checkpoints, the best model, logs.

    run.json               settings, seed and versions
    checkpoints/000007/    the latest: model.zip, normalisation.pkl, progress.json (SAC: replay_buffer.pkl too)
    best/000003/           the best evaluated: the same, without the replay buffer
    tensorboard/           logs
    summary.json           how it ended

A snapshot folder is complete or absent, and the latest has the highest number, so a run can be resumed whenever
it was killed.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import new_folder, write_json

MODEL_FILE = "model.zip"
NORMALISATION_FILE = "normalisation.pkl"
REPLAY_BUFFER_FILE = "replay_buffer.pkl"
PROGRESS_FILE = "progress.json"

Kind = Literal["checkpoints", "best"]


@dataclass(frozen=True)
class Progress:
    """How far a run was at a snapshot.

    Attributes:
        timesteps: learned from.
        wall_time: spent [s], over all sessions.
        mean_return: of the evaluation that made this the best so far; None if there was none.
    """

    timesteps: int
    wall_time: float
    mean_return: float | None = None


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
            self._remove_run()
        elif self.path.exists() and (not self.path.is_dir() or any(self.path.iterdir())):
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
            write_json(folder / PROGRESS_FILE, vars(progress))
        for older in before:
            shutil.rmtree(older)

    def latest(self, kind: Kind) -> Path | None:
        """Return the folder of the latest snapshot, None if there is none."""
        return max(self._snapshots(kind), default=None)

    def progress(self, kind: Kind) -> Progress:
        """Return how far the run was at the latest snapshot; nowhere if there is none."""
        folder = self.latest(kind)
        if folder is None:
            return Progress(0, 0.0)
        content: dict[str, Any] = json.loads((folder / PROGRESS_FILE).read_text(encoding="utf-8"))
        return Progress(**content)

    def write_summary(self, content: dict[str, Any]) -> None:
        """Write `summary.json`."""
        write_json(self._summary_file, content)

    def _snapshots(self, kind: Kind) -> list[Path]:
        return list((self.path / kind).glob("[0-9]*"))

    def _remove_run(self) -> None:
        """Remove what a run writes, and nothing else; the plan last, so that an interrupted removal can be resumed."""
        for folder in (self.path / "checkpoints", self.path / "best", self.tensorboard):
            shutil.rmtree(folder, ignore_errors=True)
        self._summary_file.unlink(missing_ok=True)
        self._plan_file.unlink()
