"""The file of a vehicle from a mesh, complete, with comments on where its numbers come from; its table of radiation."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dq_marine.meshes.building import BuiltVehicle, build_vehicle
from dq_marine.meshes.choices import Choices
from dq_marine.meshes.potential_flow import Progress, untold
from dq_marine.util.files import check_ending, check_folder, check_targets, write_csv, write_whole
from dq_marine.util.toml_text import toml_text

HEADER = """\
{name}, made by `dq-marine vehicles from-mesh` from {mesh} (unit {unit}, axes {axes}). SI units, body frame \
forward-starboard-down, everything about the body origin (CO): {origin}. 6-vectors and matrices in the order \
surge, sway, heave, roll, pitch, yaw. What is called an estimate is one: replace it by what you have measured, and \
check the file with: dq-marine vehicles check {file}"""

ORIGINS = {
    ("center", True): "amidships, in the still waterline",
    ("center", False): "the centre of buoyancy",
    ("mesh", True): "the mesh's own origin",
    ("mesh", False): "the mesh's own origin",
}

COLUMNS = 118


def vehicle_from_mesh(
    mesh: Path, file: Path, choices: Choices, *, force: bool = False, progress: Progress = untold
) -> tuple[BuiltVehicle, tuple[Path, ...]]:
    """Make a vehicle from a mesh and write its file, and beside it a table of radiation if that was asked for.

    Args:
        mesh: an STL file, binary or ASCII, of a closed hull.
        file: to write; its name ends in .toml.
        choices: what else is known.
        force: replace files that are there.
        progress: called with what is being solved, how many problems are done, and how many there are.

    Returns:
        The vehicle, and the files written, its own first.

    Raises:
        InvalidInputError: mesh, choice or file is unfit; nothing is written.
        MissingDependencyError: Capytaine is not installed.
    """
    check_ending(file, ".toml")
    table = file.with_name(f"{file.stem}_radiation.csv")
    files = (file, table) if choices.frequencies else (file,)
    check_targets(files, force=force)
    check_folder(file)
    built = build_vehicle(mesh, choices, progress)
    if built.waves is not None:
        write_csv(table, built.waves.rows())  # before the file that names it
    write_whole(file, file_text(built, mesh, file, choices))
    return built, files


def file_text(built: BuiltVehicle, mesh: Path, file: Path, choices: Choices) -> str:
    """Return a vehicle's file as text."""
    header = HEADER.format(
        name=built.content["name"],
        mesh=mesh.name,
        unit=choices.unit,
        axes=choices.axes,
        origin=ORIGINS[choices.origin, choices.floats],
        file=file.name,
    )
    values = {key: value for key, value in built.content.items() if not isinstance(value, Mapping)}
    if built.waves is not None:
        values["radiation"] = f"{file.stem}_radiation.csv"
    tables = {key: value for key, value in built.content.items() if isinstance(value, Mapping)}
    beside = os.path.relpath(mesh.resolve(), file.parent.resolve())
    tables["appearance"] = {**tables["appearance"], "file": beside}
    parts = [_comment(header)]
    parts += [_with_reasons({key: value}, built.reasons.get(key, ())) for key, value in values.items()]
    parts += [_with_reasons({key: value}, built.reasons.get(key, ())) for key, value in tables.items()]
    return "\n".join(parts)


def _with_reasons(entry: Mapping[str, Any], reasons: Any) -> str:
    """Return one key or table, the reasons for it as comments before it."""
    return "".join([*(_comment(reason) for reason in reasons), toml_text(entry)])


def _comment(text: str) -> str:
    lines = textwrap.wrap(text.replace("\n", " "), COLUMNS - 2, break_on_hyphens=False)
    return "".join(f"# {line}\n" for line in lines)
