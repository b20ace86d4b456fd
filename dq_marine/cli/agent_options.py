"""From what people type to settings: the environment to fly in, the training to do."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dq_marine.agents.choice import common_environment
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, scenario_settings
from dq_marine.agents.keywords import with_changes
from dq_marine.agents.other_algorithm import with_algorithm
from dq_marine.agents.policies import is_exported
from dq_marine.agents.policy_names import policy_path
from dq_marine.agents.preset_files import read_environment, read_settings, validate_settings
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings
from dq_marine.backend.workers import usable_cores
from dq_marine.checks import one_of
from dq_marine.cli.keyword_values import read_keywords
from dq_marine.envs.core.perturbations import PERTURBATIONS
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError
from dq_marine.util.cluster import Cluster, cluster_workers
from dq_marine.util.side_by_side import Team, team_here
from dq_marine.vehicles import vehicle_names

DEFAULT_ALGORITHM = "ppo"


@dataclass(frozen=True)
class EnvironmentOptions:
    """What was asked of the environment; None and () leave it as it is.

    Attributes:
        task: id of another environment.
        vehicle: a catalogue name or a file's path.
        level: of the task's difficulty.
        current: as `parsed_current` takes it.
        keywords: as `--set` takes them.
        perturb: names of perturbations; they win over what settings say of their keywords.
    """

    task: str | None = None
    vehicle: str | None = None
    level: str | None = None
    current: str | None = None
    keywords: tuple[str, ...] = ()
    perturb: tuple[str, ...] = ()

    def applied(self, settings: EnvironmentSettings) -> EnvironmentSettings:
        """Return settings with what was asked for in its place.

        Raises:
            InvalidInputError: an option is wrong, two contradict each other, or the environment has no such keyword.
        """
        changes = read_keywords(self.keywords)
        options = {
            "vehicle": self.vehicle,
            "level": self.level,
            "current": self.current,
            "perturb": " ".join(self.perturb) or None,
        }
        for name, value in options.items():
            if value is not None and name in changes:
                raise InvalidInputError(
                    f"--{name} {value} and --set {name}=... both say it; give one of them"
                )
        if self.vehicle is not None:
            changes["vehicle"] = self.vehicle
        if self.level is not None:
            changes["level"] = self.level
        if self.current is not None:
            changes["current"] = parsed_current(self.current)
        if self.perturb:
            changes["perturb"] = list(self.perturb)
            said = [PERTURBATIONS[one_of("--perturb", name, PERTURBATIONS)].keywords for name in self.perturb]
            changes = {keyword: None for keywords in said for keyword in keywords} | changes
        if isinstance(changes.get("vehicle"), str):
            changes["vehicle"] = _findable(changes["vehicle"])
        return with_changes(settings, changes, identifier=self.task)

    def given(self) -> dict[str, Any]:
        """Return the options by name, None for those that were not given."""
        return {
            "task": self.task,
            "vehicle": self.vehicle,
            "level": self.level,
            "current": self.current,
            "set": self.keywords or None,
            "perturb": self.perturb or None,
        }


def requested_cluster(processes: int | None, *, distributed: bool, address: str | None) -> Cluster | None:
    """Return the cluster of Ray that is to work, one that is begun here with all cores by default; None without.

    Raises:
        InvalidInputError: an address is given, and the work is not to be distributed.
    """
    if distributed:
        return lambda: cluster_workers(address, processes or usable_cores())
    if address is not None:
        raise InvalidInputError(f"--address {address} needs --distributed; give both, or neither")
    return None


def requested_team(processes: int | None, *, distributed: bool, address: str | None) -> Team:
    """Return who works side by side: processes of this machine, all cores by default, or a cluster of Ray.

    Raises:
        InvalidInputError: an address is given, and the work is not to be distributed.
    """
    cluster = requested_cluster(processes, distributed=distributed, address=address)
    return team_here(processes or usable_cores()) if cluster is None else lambda tasks: cluster()


def requested_policies(policies: Sequence[str]) -> list[Path]:
    """Return the paths of policies, those on the hub downloaded if need be.

    Args:
        policies: names of those that come with the package, exported files, folders of training runs, and addresses as
            hf://OWNER/NAME@REVISION.

    Raises:
        InvalidInputError: there is none at a path, an address is wrong, or the hub refuses.
        MissingDependencyError: the hub's client is needed, and is not installed.
    """
    return [policy_path(one) for one in policies]


def requested_environment(
    runs: list[Path],
    options: EnvironmentOptions,
    *,
    preset: str | None = None,
    scenario: Scenario | None = None,
) -> EnvironmentSettings:
    """Return the environment of policies, of a preset, or station keeping, with what was asked for in its place.

    Args:
        runs: folders of training runs, or exported files.
        options: what was asked for.
        preset: a name or a file's path; None takes the runs' environment or the default.
        scenario: whose environment is taken, of whatever task and in whatever conditions the runs were trained.

    Raises:
        InvalidInputError: there is no policy at a path, the policies disagree, or an option is wrong.
    """
    if scenario is not None:
        if preset is not None:
            raise InvalidInputError(
                f"--preset {preset} and --scenario {scenario.full_name} both say what to fly in; give one of them"
            )
        return options.applied(scenario_settings(scenario))
    if preset is not None and runs:
        option = "--policy" if is_exported(runs[0]) else "--run"
        raise InvalidInputError(
            f"--preset {preset} and {option} {runs[0]} both say what to fly in; give one of them"
        )
    base = DEFAULT_ENVIRONMENT if preset is None else read_environment(preset)
    return common_environment(runs, base=base, change=options.applied)


def requested_training(
    options: EnvironmentOptions,
    *,
    algorithm: str | None = None,
    preset: str | None = None,
    timesteps: int | None = None,
    envs: int | None = None,
    teacher: str | None = None,
    curriculum: list[str] | None = None,
    privileged_critic: list[str] | None = None,
) -> TrainingSettings:
    """Return a preset's settings with what was asked for in its place.

    Args:
        options: of the environment.
        algorithm: whose preset of the same name is taken, for the task of `preset` if that is given; None takes the
            preset's, or "ppo".
        preset: a name or a file's path; None takes the algorithm's.
        timesteps: in all; None keeps the preset's, and so on for the others.
        envs: environments to learn from.
        teacher: the baseline that the policy begins as a copy of; None keeps the preset's, if it has one.
        curriculum: levels that are learned first; None keeps the preset's, if it has any.
        privileged_critic: what the critic sees of what only the simulator knows; None keeps what the preset says.

    Raises:
        InvalidInputError: the preset or an option is wrong, or they contradict each other.
    """
    source = preset or algorithm or DEFAULT_ALGORITHM
    settings = read_settings(source, TrainingSettings)
    if algorithm is not None and algorithm != settings.algorithm.name:
        if preset == settings.algorithm.name:
            raise InvalidInputError(
                f"--algorithm {algorithm} does not go with --preset {preset}, which is another algorithm's; leave one "
                "of them out"
            )
        settings = with_algorithm(settings, algorithm)
    asked = {"timesteps": timesteps, "envs": envs}
    content = settings.model_dump()
    content.update({name: value for name, value in asked.items() if value is not None})
    if teacher is not None:
        content["imitation"] = (content["imitation"] or {}) | {"teacher": teacher}
    if curriculum is not None:
        content["curriculum"] = (content["curriculum"] or {}) | {"levels": curriculum}
    if privileged_critic is not None:
        content["privileged_critic"] = privileged_critic
    content["environment"] = options.applied(settings.environment).model_dump()
    return validate_settings(content, TrainingSettings, source=f"{source} with these options")


def parsed_current(text: str) -> float | list[float]:
    """Return a speed from "0.3", or three components from "0.2,-0.1,0" [m/s].

    Raises:
        InvalidInputError: it is neither.
    """
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 3):
        raise InvalidInputError(
            f"--current {text} is neither a speed nor three components; give 0.3 or 0.2,-0.1,0 (no spaces) [m/s]"
        )
    return numbers[0] if len(numbers) == 1 else numbers


def _findable(vehicle: str) -> str:
    """Return a file's absolute path, so that a run can be flown from any folder; a catalogue name as it is."""
    path = Path(os.path.expanduser(vehicle))  # unlike Path.expanduser, it leaves a user that there is not
    if vehicle in vehicle_names() or not path.is_file():
        return vehicle
    return str(path.resolve())
