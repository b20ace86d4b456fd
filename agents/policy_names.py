"""Trained policies that come with the package: at most one for each task and vehicle, called by the task's name.

One for another vehicle than the task's own has the vehicle's name behind it, as in PathFollowing_otter.

The preset of the same name says how a policy was trained; the card beside its file says with which vehicle, and how
well it flies.
"""

from __future__ import annotations

from pathlib import Path

from dq_marine.agents.deployment.address import SCHEME
from dq_marine.agents.deployment.onnx_policy import ENDING
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError

SHIPPED_FOLDER = Path(__file__).parent / "shipped"


def shipped_policies() -> dict[str, Path]:
    """Return the files of the policies by name, sorted."""
    return {path.stem: path for path in sorted(SHIPPED_FOLDER.glob(f"*/*{ENDING}"))}


def policy_path(policy: str | Path) -> Path:
    """Return the path of a policy, downloaded if need be.

    Args:
        policy: name of one that comes with the package; the path of an exported file or of a run's folder; or an
            address on the Hugging Face Hub, hf://OWNER/NAME@REVISION, as text.

    Raises:
        InvalidInputError: it is a bare name of none; an address is wrong, or the hub refuses. What is wrong at a longer
            path is found when it is read.
        MissingDependencyError: the hub's client is needed, and is not installed.
    """
    if isinstance(policy, Path):
        return policy
    if not isinstance(policy, str):
        raise InvalidInputError(f"policy = {shown(policy)}; give a name or a path")
    if policy.startswith(SCHEME):
        from dq_marine.agents.deployment.hub import fetched  # here: few need it

        return fetched(policy)
    shipped = shipped_policies()
    path = shipped.get(policy, Path(policy))
    if policy and (path.exists() or path.suffix or path.name != policy):
        return path
    raise InvalidInputError(
        f"{shown(policy)} holds no run, and no policy that comes with the package has that name; give one of "
        f"{', '.join(shipped)}, or a run's folder, an exported file or hf://OWNER/NAME"
    )
