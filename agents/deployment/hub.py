"""Exported policies on the Hugging Face Hub, by its own client, which also finds the user's token.

Only ONNX files are taken from there: they are data, while the folder of a training run would be unpickled.
"""

from __future__ import annotations

import contextlib
import glob
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dq_marine.agents.deployment.address import SCHEME
from dq_marine.agents.deployment.model_card import CARD_FILE
from dq_marine.agents.deployment.onnx_policy import ENDING, policy_bytes
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import optional_library


def share(folder: Path, repository: str, *, private: bool = False, message: str | None = None) -> str:
    """Upload a folder that `dq-marine export` wrote, and return the address of what the hub keeps.

    Args:
        folder: with a policy and its card, which are uploaded with what is TorchScript there; other files stay here.
        repository: OWNER/NAME; made if there is none.
        private: whether a new repository is seen by its owner alone.
        message: of the commit.

    Raises:
        InvalidInputError: the folder holds no policy or no card, or the hub refuses.
        MissingDependencyError: the hub's client is not installed.
    """
    policies = sorted(folder.glob(f"*{ENDING}"))
    if len(policies) != 1 or not (folder / CARD_FILE).is_file():
        raise InvalidInputError(
            f"{folder} holds {len(policies)} {ENDING} files and {'a' if (folder / CARD_FILE).is_file() else 'no'} "
            f"{CARD_FILE}; give a folder with one policy and its card, as `dq-marine export RUN --out "
            f"FOLDER/policy{ENDING}` writes it"
        )
    policy_bytes(policies[0])
    shared = [policies[0].name, CARD_FILE, *(one.name for one in folder.glob("*.pt"))]
    client = _client()
    with _refusals_of_the_hub(repository):
        api = client.HfApi()
        api.create_repo(repository, private=private, exist_ok=True)
        commit = api.upload_folder(
            repo_id=repository,
            folder_path=folder,
            allow_patterns=[glob.escape(name) for name in shared],
            commit_message=message or f"{policies[0].stem}, exported by dq-marine",
        )
    return str(commit.commit_url)


def fetched(address: str) -> Path:
    """Return the policy of a repository, downloaded if need be.

    Args:
        address: hf://OWNER/NAME, with @REVISION after it for another than the latest.

    Raises:
        InvalidInputError: the address is wrong, the hub refuses, or the repository does not hold one policy.
        MissingDependencyError: the hub's client is not installed.
    """
    repository, _, revision = address.removeprefix(SCHEME).partition("@")
    client = _client()
    with _refusals_of_the_hub(repository):
        folder = client.snapshot_download(
            repository, revision=revision or None, allow_patterns=[f"*{ENDING}"]
        )
    found = sorted(Path(folder).glob(f"*{ENDING}"))
    if len(found) != 1:
        names = ", ".join(one.name for one in found) or "none"
        raise InvalidInputError(
            f"{address} holds {len(found)} {ENDING} files ({names}); give a repository with one, as `dq-marine share` "
            "makes it: nothing else is loaded from the hub"
        )
    return found[0]


def _client() -> Any:
    return optional_library("the Hugging Face Hub", "huggingface_hub", "hub")


@contextlib.contextmanager
def _refusals_of_the_hub(repository: str) -> Iterator[None]:
    """Say what the hub or its client refuses in this package's words."""
    try:
        yield
    except Exception as error:  # its own errors and those of HTTP beneath it have no base in common
        first = str(error).strip().split("\n")[0]
        raise InvalidInputError(
            f"the Hugging Face Hub refuses {shown(repository)}: {first or type(error).__name__}; check its name, the "
            "network, and that `hf auth login` has been run where a token is needed"
        ) from error
