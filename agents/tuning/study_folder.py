"""The folder of a search.

study.json     what is searched: the training that it begins from, its seed, versions
study.db       every trial, by Optuna, in SQLite
tensorboard/   logs of the trials
trials.csv     every trial that ended, the best first
preset.toml    the best trial as a preset: `dq-marine train --preset`
trials.png     every hyperparameter against the return
study.lock     process number of the search in progress, which keeps others out
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from dq_marine.agents.locked_folder import folder_locked, holds_anything
from dq_marine.agents.plan_differences import told_differences
from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import LARGEST_SEED
from dq_marine.checks import possible_path, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import unwritable, write_json

LOCK_FILE = "study.lock"


@dataclass(frozen=True)
class StudyPlan:
    """What is searched: `study.json`.

    Attributes:
        base: the training that the search begins from; a trial is as long as it.
        seed: of every trial's training, and of the choice of trials.
    """

    base: TrainingSettings
    seed: int


class StudyFolder:
    """Reads and writes a search's folder; knows nothing of Optuna."""

    def __init__(self, path: str | Path) -> None:
        """Take a folder, which need not exist.

        Raises:
            InvalidInputError: no folder can have such a path.
        """
        self.path = possible_path("study", path)
        self.database = self.path / "study.db"
        self.tensorboard = self.path / "tensorboard"
        self.trials = self.path / "trials.csv"
        self.preset = self.path / "preset.toml"
        self.picture = self.path / "trials.png"
        self._plan_file = self.path / "study.json"

    @contextlib.contextmanager
    def begun(self, plan: StudyPlan) -> Iterator[None]:
        """Create the folder and write the plan, or check that it is that of the search that is there.

        Other processes are kept from searching here within the block.

        Raises:
            InvalidInputError: another search is here, or something else, another process searches here, or the folder
                cannot be written.
        """
        if not self._plan_file.is_file() and holds_anything(self.path, LOCK_FILE):
            raise InvalidInputError(
                f"{self.path} exists and is not a study; choose a new or empty folder (nothing was removed)"
            )
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise unwritable(self.path, error) from error
        with folder_locked(self.path, LOCK_FILE, doing="searched"):
            if self._plan_file.is_file():
                self._check_same(plan)
            else:
                write_json(self._plan_file, {"seed": plan.seed, "base": plan.base.model_dump(mode="json")})
            yield

    def read_plan(self) -> StudyPlan:
        """Read `study.json`.

        Raises:
            InvalidInputError: there is no study here, or its plan is damaged or cannot be read.
        """
        source = str(self._plan_file)
        try:
            content = json.loads(self._plan_file.read_text(encoding="utf-8"))
            seed = whole_number("seed", content["seed"], least=0, most=LARGEST_SEED)
            base = content["base"]
        except OSError as error:
            raise InvalidInputError(
                f"{self.path} holds no study ({self._plan_file.name}: {error.strerror}); give the folder that "
                "`dq-marine tune` wrote"
            ) from error
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise InvalidInputError(
                f"{source} is damaged: {shown(error)}; restore it from a copy, or search in another folder"
            ) from error
        return StudyPlan(validate_settings(base, TrainingSettings, source=source), seed)

    def _check_same(self, plan: StudyPlan) -> None:
        found = self.read_plan()
        if found == plan:
            return
        theirs, ours = (one.base.model_dump(mode="json") | {"seed": one.seed} for one in (found, plan))
        raise InvalidInputError(
            f"{self.path} holds another study: {told_differences(theirs, ours)}; go on with the same options, or "
            "choose another folder"
        )
