"""The page of a validation: a table and pictures for each vehicle, written into a folder."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from dq_marine.manoeuvres import Result
from dq_marine.manoeuvres.table import shown
from dq_marine.manoeuvres.views import save_plot
from dq_marine.util.files import with_folder, write_whole
from dq_marine.util.markdown_table import markdown_table
from dq_marine.validation.comparison import Comparison, Verdict
from dq_marine.validation.picture import save_offsets

NAME = "README.md"

INTRODUCTION = """\
# Validation

Please do not edit this page: `dq-marine validate --out docs/validation` writes it. Each vehicle of the
catalogue does the trials that its references are of, and each number stands beside one that was published, or
that a model computed which nobody here wrote. A number agrees if it is as near to the reference as the table
says, or within its bounds. Where it is known why a number differs, that stands below the table. The
references stand in `dq_marine/validation/references`, one file for each vehicle.
"""


def write_page(
    comparisons: Sequence[Comparison], silences: Mapping[str, str], machine: str, folder: Path
) -> Path:
    """Write the page and its pictures; return the page's path.

    Args:
        comparisons: one for each vehicle.
        silences: by vehicle, what is known of why it has no references, or no more.
        machine: versions and commit that it was made with.
        folder: to write into; it is made if need be.

    Raises:
        InvalidInputError: a file cannot be written.
    """
    path = with_folder(folder / NAME)
    parts = [INTRODUCTION, f"Made with {machine}.\n", summary(comparisons)]
    parts += [_vehicle(one, silences.get(one.vehicle, ""), folder) for one in comparisons]
    write_whole(path, "\n".join(parts))
    return path


def summary(comparisons: Sequence[Comparison]) -> str:
    """Return a table of how many numbers of each vehicle agree."""
    rows = []
    for one in comparisons:
        verdicts = [line.verdict for line in one.lines]
        rows.append([one.vehicle, str(len(verdicts)), *(str(verdicts.count(kind)) for kind in Verdict)])
    return markdown_table(["vehicle", "numbers", *(kind.value for kind in Verdict)], rows) + "\n"


def _vehicle(comparison: Comparison, silence: str, folder: Path) -> str:
    parts = [f"## {comparison.title} (`{comparison.vehicle}`)\n"]
    if comparison.lines:
        rows = [
            [
                line.trial,
                line.quantity.label,
                shown(line.quantity.value),
                line.wanted,
                line.quantity.unit,
                line.verdict.value,
                line.expected.source,
            ]
            for line in comparison.lines
        ]
        header = ["trial", "number", "simulated", "reference", "unit", "verdict", "source"]
        parts.append(markdown_table(header, rows, words=True) + "\n")
        parts += _explanations(comparison)
        parts += _pictures(comparison, folder)
    if silence:
        parts.append(silence + "\n")
    return "\n".join(parts)


def _explanations(comparison: Comparison) -> list[str]:
    explained = [line for line in comparison.lines if line.verdict is Verdict.EXPLAINED]
    if not explained:
        return []
    lines = [f"- {line.trial}, {line.quantity.label}: {line.expected.because}" for line in explained]
    return ["Why numbers differ:\n", "\n".join(lines) + "\n"]


def _pictures(comparison: Comparison, folder: Path) -> list[str]:
    """Draw the differences, and the first manoeuvre of each kind; return links to the pictures."""
    offsets = f"{comparison.vehicle}.png"
    save_offsets(comparison, folder / offsets)
    links = [f"![{comparison.title}: differences to the references]({offsets})\n"]
    first: dict[str, tuple[str, Result]] = {}
    for trial, result in comparison.results:
        first.setdefault(result.manoeuvre, (trial, result))
    for trial, result in first.values():
        name = f"{comparison.vehicle}-{_file_name(trial)}.png"
        save_plot(result, folder / name)
        links.append(f"![{comparison.title}: {trial}]({name})\n")
    return links


def _file_name(trial: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", trial.lower()).strip("-")
