"""Finding vehicles by name and reading vehicle files."""

from __future__ import annotations

import csv
import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.physics.waves.radiation import read_radiation
from dq_marine.vehicles.model import Vehicle
from dq_marine.vehicles.validation import validated
from dq_marine.vehicles.variants import read_variant, variant_names, varied

NOTHING: Mapping[str, Any] = {}

_FOLDER = Path(__file__).parent / "catalogue"


def vehicle_names() -> list[str]:
    """Return the names of the catalogue's vehicles, sorted."""
    return sorted(path.stem for path in _FOLDER.glob("*.toml"))


def catalogue_file(name: str) -> Path:
    """Return the file of a vehicle of the catalogue.

    Raises:
        InvalidInputError: there is none of that name.
    """
    if name not in vehicle_names():
        raise InvalidInputError(
            f"there is no vehicle {name!r} in the catalogue; it holds {', '.join(vehicle_names())}"
        )
    return _FOLDER / f"{name}.toml"


def load_vehicle(vehicle: Vehicle | str | os.PathLike[str]) -> Vehicle:
    """Return a vehicle: one of the catalogue by name, one from a TOML file, or the one given.

    Args:
        vehicle: a catalogue name such as "bluerov2_heavy", the name of a variant such as "bluerov2_published", the path
            of a file ending in `.toml`, or a `Vehicle`.

    Raises:
        InvalidInputError: no such name or file.
        VehicleFileError: the file is wrong; the message lists field, value and remedy.
    """
    if isinstance(vehicle, Vehicle):
        return vehicle
    if not isinstance(vehicle, str | os.PathLike):
        raise InvalidInputError(
            f"vehicle is a {type(vehicle).__name__}; give a catalogue name "
            f"({', '.join(vehicle_names())}), the path of a .toml file, or a Vehicle"
        )
    text = os.fspath(vehicle)
    if text in vehicle_names():
        return _read(catalogue_file(text))
    if text in variant_names():
        base, changes = read_variant(text)
        return _read(catalogue_file(base), changes)
    path = existing_file("vehicle", text)
    if path is not None:
        return _read(path)
    kind = "file" if text.endswith(".toml") or os.sep in text else "vehicle"
    raise InvalidInputError(
        f"there is no {kind} {shown(text)}; the catalogue holds {', '.join(vehicle_names())}, with the variants "
        f"{', '.join(variant_names())}, and the path of an existing .toml file is taken too"
    )


def plain_vehicle(vehicle: Vehicle) -> Any:
    """Return a vehicle as text, lists and numbers: the name of one of the catalogue, or the content of a file."""
    for name in vehicle_names():
        if load_vehicle(name) == vehicle:
            return name
    return vehicle.model_dump(mode="json", exclude_defaults=True)


def _read(path: Path, changes: Mapping[str, Any] = NOTHING) -> Vehicle:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise VehicleFileError(f"{path}: not a TOML file: {error}") from error
    except OSError as error:
        raise VehicleFileError(f"{path}: cannot be read: {error.strerror}") from error
    except (RecursionError, ValueError) as error:
        raise VehicleFileError(f"{path}: not a vehicle file: {type(error).__name__}: {error}") from error
    beside = content.get("radiation")
    if isinstance(beside, str):
        try:
            content["radiation"] = read_radiation(path.parent / beside)
        except (OSError, ValueError, csv.Error) as error:
            raise VehicleFileError(f"{path}: radiation = {beside!r} cannot be read: {error}") from error
    _find_mesh(content.get("appearance"), path)
    return validated(varied(content, changes), str(path), VehicleFileError)


def _find_mesh(appearance: Any, path: Path) -> None:
    """Replace the path of a mesh from a vehicle's file by one from anywhere."""
    if not isinstance(appearance, dict) or not isinstance(appearance.get("file"), str):
        return  # nothing, or something that validation names
    beside = path.parent / appearance["file"]
    if existing_file("appearance.file", beside) is None:
        raise VehicleFileError(
            f"{path}: appearance.file = {shown(appearance['file'])}: there is no {shown(str(beside))}; "
            "give the path of a mesh from the vehicle's file"
        )
    appearance["file"] = str(beside.resolve())
