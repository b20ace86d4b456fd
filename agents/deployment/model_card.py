"""The card of an exported policy: Markdown with the front matter of the Hugging Face Hub.

All in it follows from the run, from the exported files and from episodes that were flown.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dq_marine.agents.deployment.description import PolicyDescription
from dq_marine.agents.deployment.onnx_policy import ENDING
from dq_marine.agents.evaluation.evaluation import Score, Spread
from dq_marine.agents.training.run_folder import RunPlan
from dq_marine.checks import printable
from dq_marine.util.toml_text import toml_text

CARD_FILE = "README.md"
"""Of the card, where the hub looks for it."""


@dataclass(frozen=True)
class Evaluated:
    """What the policy achieved, and in which episodes.

    Attributes:
        score: of the policy.
        seed: of the first episode.
    """

    score: Score
    seed: int


def card(
    files: Sequence[Path], plan: RunPlan, description: PolicyDescription, evaluated: Evaluated | None
) -> str:
    """Return the card.

    Args:
        files: that were exported, in its folder.
        plan: of the run.
        description: that the files hold.
        evaluated: None if no episodes were flown.
    """
    name = printable(files[0].stem)
    sections = [
        _front_matter(name, description, evaluated),
        f"# {name}\n\n{_introduction(description)}",
        _facts(description),
        _scores(files, evaluated),
        _flying(files),
        _training(plan),
        _interface(description),
    ]
    return "\n\n".join(sections) + "\n"


def _front_matter(name: str, description: PolicyDescription, evaluated: Evaluated | None) -> str:
    """Return YAML, each value in its JSON form, which YAML takes."""
    task = description.environment.id
    content: dict[str, Any] = {
        "library_name": "dq-marine",
        "pipeline_tag": "reinforcement-learning",
        "tags": ["reinforcement-learning", "gymnasium", "marine-robotics", description.algorithm, task],
    }
    if evaluated is not None:
        result = {
            "task": {"type": "reinforcement-learning", "name": "reinforcement-learning"},
            "dataset": {"type": task, "name": task},
            "metrics": _hub_metrics(evaluated.score),
        }
        content["model-index"] = [{"name": name, "results": [result]}]
    lines = [f"{key}: {json.dumps(value, ensure_ascii=False)}" for key, value in content.items()]
    return "\n".join(["---", *lines, "---"])


def _hub_metrics(score: Score) -> list[dict[str, Any]]:
    values = {"mean_reward": score.returns.mean, "success_rate": score.success_rate}
    values |= {f"final_{one.metric.shown_name}": one.final.mean for one in score.metrics.values()}
    return [{"type": name, "name": name, "value": round(value, 4)} for name, value in values.items()]


def _introduction(description: PolicyDescription) -> str:
    return (
        f"A policy for `{description.environment.id}` with the vehicle {printable(description.vehicle)}, trained in "
        "simulation by dq-marine. Normalisation of the observations and limits of the actions are inside the graph: it "
        "takes raw observations and gives actions in [-1, 1]."
    )


def _facts(description: PolicyDescription) -> str:
    versions = ", ".join(f"{name} {number}" for name, number in description.versions.items())
    rows = {
        "task": f"`{description.environment.id}`",
        "vehicle": printable(description.vehicle),
        "level": description.level or "none",
        "environment": f"`{json.dumps(description.environment.keywords)}`",
        "control period": f"{description.control_period:g} s",
        "algorithm": description.algorithm.upper(),
        "timesteps": f"{description.timesteps:,}",
        "seed": str(description.seed),
        "versions": versions,
    }
    return "\n".join(
        ["| | |", "|---|---|", *(f"| {name} | {_cell(value)} |" for name, value in rows.items())]
    )


def _scores(files: Sequence[Path], evaluated: Evaluated | None) -> str:
    if evaluated is None:
        return "## Scores\n\nNo episodes were flown for this card."
    score, seed = evaluated.score, evaluated.seed
    rows = [("return", score.returns, "{:.1f}")]
    for one in score.metrics.values():
        rows += [
            (one.metric.heading("at the end"), one.final, "{:.4g}"),
            (one.metric.heading("over the last third"), one.steady, "{:.4g}"),
        ]
    rows += [("mean square of the actions", score.effort, "{:.4g}")]
    shares = {"success at the end": score.success_rate, "ended early": score.early_end_rate}
    if score.collision_rate is not None:
        shares["collisions"] = score.collision_rate
    last = seed + score.episodes - 1
    flown = f"Over {score.episodes} episodes of the environment above, seeds {seed} to {last}, without exploration:"
    lines = ["## Scores", "", flown, "", "| | mean | median | 95 % |", "|---|---|---|---|"]
    lines += [_spread(*row) for row in rows]
    lines += [f"| {name} | {share:.1%} | | |" for name, share in shares.items()]
    for file in files:
        if file.suffix == ENDING:
            counts = ("--episodes", str(score.episodes), "--seed", str(seed))
            command = shlex.join(["dq-marine", "evaluate", "--policy", file.name, *counts])
            lines += ["", f"`{command}` flies them again."]
    return "\n".join(lines)


def _spread(name: str, values: Spread, form: str) -> str:
    cells = (form.format(value) for value in (values.mean, values.median, values.p95))
    return f"| {_cell(name)} | {' | '.join(cells)} |"


def _flying(files: Sequence[Path]) -> str:
    said = ["## Fly"]
    for one in files:
        if one.suffix == ENDING:
            command = shlex.join(["dq-marine", "fly", "--policy", one.name, "--html", "flight.html"])
            said.append(f'```\npip install "dq-marine[deploy,render]"\n{command}\n```')
        else:
            said.append(f"`{printable(one.name)}` is the same graph as TorchScript, for `torch.jit.load`.")
    return "\n\n".join(said)


def _training(plan: RunPlan) -> str:
    command = f"dq-marine train --run run --preset preset.toml --seed {plan.seed}"
    preset = toml_text(plan.settings.model_dump(mode="json"))
    return f"## Training\n\n```\n{command}\n```\n\nwith `preset.toml`:\n\n```toml\n{preset}```"


def _interface(description: PolicyDescription) -> str:
    observed = [
        f"| {_cell(one.input)} | {_cell(one.name)} | {one.size} | {_cell(one.unit) or '1'} | {one.bound:.6g} |"
        for one in description.observations
    ]
    commanded = [
        f"| {_cell(one.name)} | {_cell(one.unit)} | {one.low:.6g} | {one.high:.6g} |"
        for one in description.actions
    ]
    return "\n".join(
        [
            "## What it reads, what it commands\n",
            "| input | numbers | how many | unit | bound |",
            "|---|---|---|---|---|",
            *observed,
            f"\nActions ({description.actuation}), held for a control period:\n",
            "| number | unit | at -1 | at 1 |",
            "|---|---|---|---|",
            *commanded,
        ]
    )


def _cell(text: str) -> str:
    """Return a text that does not end a cell of a table."""
    return printable(text).replace("|", "\\|")
