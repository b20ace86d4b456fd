"""The command `dq-marine validate`."""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from dq_marine.cli.common import console, error_console, examples
from dq_marine.cli.manoeuvre import RadiationName, RadiationOption

if TYPE_CHECKING:
    from dq_marine.validation import Comparison, References
    from dq_marine.vehicles import Vehicle

EXAMPLES = examples(
    "dq-marine validate osv83",
    "dq-marine validate --out validation",
    "dq-marine validate my_ship.toml --references my_trials.toml",
    "dq-marine validate otter --json",
    "dq-marine validate supply_vessel --radiation memory",
)


def validate(
    vehicles: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[VEHICLE]...",
            help="Catalogue names, or with --references the path of one TOML file.",
            show_default="all of the catalogue",
        ),
    ] = None,
    references: Annotated[
        Path | None,
        typer.Option("--references", help="Trials of your own (TOML) that one vehicle is held against."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder for a page with pictures; needs Matplotlib.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
    radiation: RadiationOption = RadiationName.CONSTANT,
) -> None:
    """Hold vehicles against trials and against models that nobody here wrote: a verdict for each number.

    Each vehicle does the trials of its references again: constant thrust, acceleration, turning circles, zig-zags, free
    decays. A number agrees if it is as near to its reference as the file of references asks. The exit status is 1 if a
    number differs and the file does not say why.

    A file of your own has a table [[trial]] with name, manoeuvre ("steady", "acceleration", "turning-circle",
    "zig-zag", "stopping" or "decay") and what that takes, and in it [[trial.expected]] with quantity, value and within,
    or at_least and at_most, and source. Those of the catalogue, in dq_marine/validation/references, are examples.
    """
    from dq_marine.physics.radiation.build import CONSTANT, checked_radiation
    from dq_marine.validation import Verdict

    comparisons, silences = [], {}
    chosen = _chosen(vehicles or [], references)
    for _, vehicle, _ in chosen:
        checked_radiation(radiation.value, vehicle)
    if out is not None:
        from dq_marine.util.files import with_folder
        from dq_marine.validation.page import NAME

        with_folder(out / NAME)  # before what takes minutes
    for name, vehicle, own in chosen:
        comparisons.append(_compared(name, vehicle, own, radiation.value))
        silences[name] = own.silence
        if not json:
            _show(comparisons[-1], own.silence)
    if json:
        lines = {one.vehicle: [line.as_dict() for line in one.lines] for one in comparisons}
        typer.echo(json_format.dumps(lines, indent=2, allow_nan=False))
    if out is not None:
        from dq_marine.report.machine import commit, versions
        from dq_marine.validation.page import write_page

        made_with = ", ".join(f"{library} {number}" for library, number in versions().items())
        made_with += f", commit {found}" if (found := commit("dq_marine")) else ""
        made_with += "" if radiation == CONSTANT else f", radiation {radiation.value}"
        page = write_page(comparisons, silences, made_with, out)
        error_console.print(f"Wrote {page}", soft_wrap=True, highlight=False)
    if any(line.verdict is Verdict.DIFFERS for one in comparisons for line in one.lines):
        raise typer.Exit(1)


def _chosen(names: list[str], references: Path | None) -> list[tuple[str, Vehicle, References]]:
    """Return vehicles by name with their references; all are there before the first is simulated."""
    from dq_marine.errors import InvalidInputError
    from dq_marine.validation import load_references, validated_vehicles
    from dq_marine.vehicles import load_vehicle

    if references is None:
        return [(name, load_vehicle(name), load_references(name)) for name in names or validated_vehicles()]
    if len(names) != 1:
        raise InvalidInputError(
            f"--references is of one vehicle, and {len(names)} are given; give its name or file"
        )
    return [(names[0], load_vehicle(names[0]), load_references(references))]


def _compared(name: str, vehicle: Vehicle, references: References, radiation: str) -> Comparison:
    from dq_marine.validation import compared

    title = escape(vehicle.name)
    with error_console.status(title) as status:
        return compared(
            Path(name).stem,
            vehicle,
            references.trial,
            lambda phase, time: status.update(f"{title}: {escape(phase)}, {time:.4g} s"),
            radiation,
        )


def _show(comparison: Comparison, silence: str) -> None:
    from dq_marine.cli.validation_table import comparison_table

    if comparison.lines:
        console.print(comparison_table(comparison))
    if silence:
        console.print(f"{comparison.title}: {silence}", highlight=False, markup=False)
