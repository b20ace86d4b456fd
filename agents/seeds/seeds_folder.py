"""The folder of a training with several seeds.

seeds.json     what is trained, and a mark that tells this folder from another of its name on another machine
seed_0/        a run folder as `run_folder.py` has it, and so on for each seed
seeds.csv      how each ended
seeds.lock     process number of the training in progress, which keeps others out
"""

from __future__ import annotations

import contextlib
import json
import re
import uuid
from collections.abc import Iterator
from pathlib import Path

from dq_marine.agents.locked_folder import folder_locked, holds_anything
from dq_marine.agents.plan_differences import told_differences
from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.checks import possible_path, shown
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import unwritable, write_json

LOCK_FILE = "seeds.lock"


class SeedsFolder:
    """Reads and writes the folder; knows nothing of how its runs are trained."""

    def __init__(self, path: str | Path) -> None:
        """Take a folder, which need not exist.

        Raises:
            InvalidInputError: no folder can have such a path.
        """
        self.path = possible_path("run", path)
        self.results = self.path / "seeds.csv"
        self._plan_file = self.path / "seeds.json"

    def run(self, seed: int) -> RunFolder:
        """Return the run folder of a seed, which need not exist."""
        return RunFolder(self.path / f"seed_{seed}")

    @contextlib.contextmanager
    def begun(self, settings: TrainingSettings, *, force: bool) -> Iterator[str]:
        """Create the folder, or check that it is of this training; yield its mark.

        Other processes are kept from training here within the block.

        Args:
            settings: what is trained.
            force: remove the runs that are there first.

        Raises:
            InvalidInputError: another training is here and `force` is not set, something else is here, another process
                trains here, or the folder cannot be written.
        """
        if not self._plan_file.is_file() and holds_anything(self.path, LOCK_FILE):
            raise InvalidInputError(
                f"{self.path} exists and holds no training with several seeds; choose a new or empty folder (nothing "
                "was removed)"
            )
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise unwritable(self.path, error) from error
        with folder_locked(self.path, LOCK_FILE, doing="trained"):
            if force:
                self._remove_runs()
            if force or not self._plan_file.is_file():
                content = {"mark": uuid.uuid4().hex, "settings": settings.model_dump(mode="json")}
                write_json(self._plan_file, content)
            mark, found = self._read_plan()
            self._check_same("another training", found, settings)
            yield mark

    def has_mark(self, mark: str) -> bool:
        """Whether this is the folder of that mark, as this machine sees it."""
        try:
            return self._read_plan()[0] == mark
        except InvalidInputError:
            return False

    def is_finished(self, seed: int, settings: TrainingSettings) -> bool:
        """Whether the run of a seed has ended.

        Raises:
            InvalidInputError: a run of other settings or of another seed is in its folder, or it is damaged.
        """
        run = self.run(seed)
        if not run.holds_run:
            return False
        plan = run.read_plan()
        if plan.seed != seed:
            raise InvalidInputError(
                f"{run.path} holds a run of seed {plan.seed}, not {seed}; move it away, or choose another folder"
            )
        self._check_same(f"another run in {run.path.name}", plan.settings, settings)
        return run.is_finished(settings.timesteps)

    def _check_same(self, what: str, found: TrainingSettings, asked: TrainingSettings) -> None:
        if found == asked:
            return
        differences = told_differences(found.model_dump(mode="json"), asked.model_dump(mode="json"))
        raise InvalidInputError(
            f"{self.path} holds {what}: {differences}; go on with the same options, replace all of its runs with "
            "--force, or choose another folder"
        )

    def _read_plan(self) -> tuple[str, TrainingSettings]:
        source = str(self._plan_file)
        try:
            content = json.loads(self._plan_file.read_text(encoding="utf-8"))
            mark, settings = str(content["mark"]), content["settings"]
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise InvalidInputError(
                f"{source} is missing or damaged: {shown(error)}; restore it from a copy, or train anew with --force"
            ) from error
        return mark, validate_settings(settings, TrainingSettings, source=source)

    def _remove_runs(self) -> None:
        """Remove the runs of all seeds, and nothing else."""
        self.results.unlink(missing_ok=True)
        for folder in sorted(self.path.iterdir()):
            if folder.is_dir() and re.fullmatch(r"seed_\d+", folder.name):
                run = RunFolder(folder)
                with run.locked():
                    run.remove_run()
