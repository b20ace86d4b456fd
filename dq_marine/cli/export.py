"""The command `dq-marine export`: a trained policy as files that fly without Stable-Baselines3."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples, shown_part

EXAMPLES = examples(
    "dq-marine export runs/ppo --out station/policy.onnx",
    "dq-marine export runs/ppo --out station/policy.onnx --out station/policy.pt --episodes 200",
    "dq-marine fly --policy station/policy.onnx --html policy.html",
)


def export(
    run: Annotated[Path, typer.Argument(help="Folder of a training run. Load only runs you trust.")],
    out: Annotated[
        list[Path],
        typer.Option(
            "--out",
            help="File to write: .onnx, or .pt for TorchScript; may be repeated. The model card, README.md, is written "
            "beside it.",
        ),
    ],
    episodes: Annotated[
        int, typer.Option("--episodes", min=0, help="Number of episodes to fly for the card's scores.")
    ] = 50,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Seed of the first of them; the others count up from it.")
    ] = 0,
    force: Annotated[bool, typer.Option("--force", help="Replace files that are there.")] = False,
) -> None:
    """Export the best policy of a run, with the normalisation of observations and the limits of actions inside.

    The file says what it was trained in, so that `fly`, `evaluate` and `leaderboard` need nothing else: give it to them
    with --policy. ONNX is data; unlike a run's folder, nothing of it is unpickled.
    """
    from dq_marine.agents.deployment.export import export_policy
    from dq_marine.agents.evaluation.evaluation import score_table
    from dq_marine.agents.training.run_folder import RunFolder

    with shown_part("Evaluating") as progress:
        exported = export_policy(
            RunFolder(run), out, episodes=episodes, seed=seed, force=force, progress=progress
        )
    if exported.evaluated is not None:
        console.print(score_table([exported.evaluated.score]))
    for path in exported.files:
        console.print(f"Wrote {path}", soft_wrap=True)
