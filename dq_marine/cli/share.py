"""The command `dq-marine share`: an exported policy on the Hugging Face Hub."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples

EXAMPLES = examples(
    "hf auth login",
    "dq-marine share station me/station-keeping-ppo",
    "dq-marine fly --policy hf://me/station-keeping-ppo --html policy.html",
)


def share(
    folder: Annotated[
        Path, typer.Argument(help="Folder with one exported policy (.onnx) and its README.md.")
    ],
    repository: Annotated[
        str, typer.Argument(metavar="OWNER/NAME", help="Repository on the hub; made if there is none.")
    ],
    private: Annotated[
        bool, typer.Option("--private", help="A new repository is seen by its owner alone.")
    ] = False,
    message: Annotated[
        str | None, typer.Option("--message", help="Of the commit.", show_default="the policy's name")
    ] = None,
) -> None:
    """Upload an exported policy and its card to the Hugging Face Hub; needs the extra `hub`.

    The hub's client finds your token: `hf auth login` stores one. Only the policy, its card and TorchScript go up.
    """
    from dq_marine.agents.deployment.address import SCHEME
    from dq_marine.agents.deployment.hub import share as upload

    address = upload(folder, repository, private=private, message=message)
    console.print(f"Shared: {address}", soft_wrap=True)
    console.print(f"Fly it anywhere: dq-marine fly --policy {SCHEME}{repository}", soft_wrap=True)
