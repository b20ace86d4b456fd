"""What a search found, as files beside it: all trials as CSV, the best as a preset, hyperparameters against returns."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dq_marine.agents.tuning.search_space import search_space, with_values
from dq_marine.agents.tuning.study import Tried
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.util.figures import new_figure, save_figure
from dq_marine.util.files import write_whole
from dq_marine.util.plot_style import INK
from dq_marine.util.toml_text import toml_text

COLUMNS = 4
"""Of the picture."""

LOGARITHMIC = ("learning_rate", "tau", "exploration_noise", "target_policy_noise")
"""Fields of which sizes count."""


def write_results(folder: StudyFolder, plan: StudyPlan, trials: Sequence[Tried]) -> list[Path]:
    """Write what trials came to, the best first, and return the files.

    Without a trial that ended by itself there is no preset, and without one that told anything no picture.

    Raises:
        InvalidInputError: a file cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    names = list(search_space(plan.base))
    written = [folder.trials]
    write_whole(folder.trials, _table(trials, names))
    if trials and trials[0].mean_return is not None and not trials[0].given_up:
        write_whole(folder.preset, _preset(folder, plan, trials))
        written.append(folder.preset)
    if any(one.mean_return is not None for one in trials):
        save_figure(_picture(trials, names), folder.picture)
        written.append(folder.picture)
    return written


def _table(trials: Sequence[Tried], names: Sequence[str]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["trial", "mean_return", "timesteps", "given_up", *names])
    for one in trials:
        values = [_cell(one.values[name]) for name in names]
        writer.writerow([one.number, one.mean_return, one.timesteps, int(one.given_up), *values])
    return text.getvalue()


def _cell(value: Any) -> Any:
    return " ".join(map(str, value)) if isinstance(value, list) else value


def _preset(folder: StudyFolder, plan: StudyPlan, trials: Sequence[Tried]) -> str:
    best, base = trials[0], next((one for one in trials if one.number == 0), None)
    lines = [
        f"# Found by `dq-marine tune --out {folder.path}`: trial {best.number} of {len(trials)}, seed {plan.seed}.",
        f"# Mean return of its best evaluation: {best.mean_return:.2f}, of {plan.base.evaluation.episodes} episodes.",
    ]
    if base is not None and base is not best and base.mean_return is not None:
        lines.append(f"# The training that the search began from: {base.mean_return:.2f}.")
    lines.append("# One seed may be lucky: train with others before you trust it.")
    return "\n".join(lines) + "\n\n" + toml_text(with_values(plan.base, best.values).model_dump(mode="json"))


def _picture(trials: Sequence[Tried], names: Sequence[str]) -> Any:
    told = [one for one in trials if one.mean_return is not None]
    rows = -(-len(names) // COLUMNS)
    figure = new_figure(3.0 * COLUMNS, 2.4 * rows)
    axes = list(figure.subplots(rows, COLUMNS, sharey=True, squeeze=False).flat)
    for axis, name in zip(axes, names, strict=False):
        values = [one.values[name] for one in told]
        positions, labels = _positions(values)
        for given_up, marker in ((False, "o"), (True, "x")):
            which = [i for i, one in enumerate(told) if one.given_up is given_up]
            axis.plot(
                [positions[i] for i in which],
                [told[i].mean_return for i in which],
                marker,
                color=INK,
                alpha=0.6,
                label="given up" if given_up else "ended",
            )
        if labels:
            axis.set_xticks(range(len(labels)), labels)
        elif name.split(".")[1] in LOGARITHMIC:
            axis.set_xscale("log")
        axis.set_xlabel(name.split(".")[1].replace("_", " "))
    for axis in axes[len(names) :]:
        axis.set_visible(False)
    if any(one.given_up for one in told):
        axes[0].legend(fontsize="small")
    for axis in axes[::COLUMNS]:
        axis.set_ylabel("mean return")
    return figure


def _positions(values: Sequence[Any]) -> tuple[list[float], list[str]]:
    """Return where values stand on an axis: numbers where they are, others one after the other with their labels."""
    if all(isinstance(value, int | float) for value in values):
        return [float(value) for value in values], []
    labels = sorted({str(_cell(value)) for value in values})
    return [float(labels.index(str(_cell(value)))) for value in values], labels
