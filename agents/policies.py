"""What a path of a trained policy leads to: the folder of a training run, or a file that was exported from one."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.deployment.onnx_policy import ENDING, OnnxPolicy, policy_bytes
from dq_marine.agents.policy_names import policy_path
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.training.run_folder import MODEL_FILE, RunFolder
from dq_marine.agents.training.snapshots import digests_of


def is_exported(policy: Path) -> bool:
    """Whether a path is that of an exported file; else it is taken for a run's folder."""
    return policy.suffix == ENDING and not policy.is_dir()


def named_policies(policies: Sequence[Path]) -> list[tuple[str, Path]]:
    """Return policies with what they go by: names of run folders, of exported files, or of repositories on the hub.

    Where two would go by one name, names of folders above, or of owners, are put before all, as many as it takes.
    """
    places = [_place(policy) for policy in policies]
    for depth in range(1, max(map(len, places), default=0) + 1):
        names = ["-".join(place[-depth:]) for place in places]
        if len(set(names)) == len(set(places)):
            return list(zip(names, policies, strict=True))
    return [(str(policy), policy) for policy in policies]


def _place(policy: Path) -> tuple[str, ...]:
    """Return a policy's name after those of what it lies in."""
    if not is_exported(policy):
        return policy.resolve().parts[1:]
    file = policy.absolute()
    if len(file.parents) > 2 and file.parents[1].name == "snapshots":  # the hub's client: models--OWNER--NAME
        kind, *owner_and_name = file.parents[2].name.split("--")
        if kind == "models":
            return tuple(owner_and_name)
    return (*file.parent.parts[1:], file.stem)


def trained_environment(policy: str | Path) -> EnvironmentSettings:
    """Return the environment that a policy was trained in.

    Args:
        policy: name of one that comes with the package; the path of an exported file or of a run's folder; or
            hf://OWNER/NAME on the Hugging Face Hub.

    Raises:
        InvalidInputError: there is no policy, or it is damaged.
        MissingDependencyError: the library that reads it is not installed.
    """
    policy = policy_path(policy)
    if is_exported(policy):
        return OnnxPolicy(policy).description.environment
    return RunFolder(policy).read_plan().settings.environment


def policy_digest(policy: Path) -> str:
    """Return a hash over a policy, 16 digits: what another one of the same name flew is not its own.

    Raises:
        InvalidInputError: there is no policy, or it is damaged.
    """
    if is_exported(policy):
        return hashlib.sha256(policy_bytes(policy)).hexdigest()[:16]
    return digests_of(RunFolder(policy).trained_snapshot)[MODEL_FILE][:16]


def load_policy(policy: str | Path) -> Agent:
    """Return a policy as an agent.

    A run is unpickled, which runs whatever code it holds: load only runs that you trust. An exported file is data.

    Args:
        policy: name of one that comes with the package; the path of an exported file or of a run's folder; or
            hf://OWNER/NAME on the Hugging Face Hub.

    Raises:
        InvalidInputError: there is no policy, or it is damaged.
        MissingDependencyError: the libraries that it needs are not installed.
    """
    policy = policy_path(policy)
    if is_exported(policy):
        return OnnxPolicy(policy)
    from dq_marine.agents.training.trained_policy import TrainedPolicy  # here: it imports torch

    return TrainedPolicy(RunFolder(policy))
