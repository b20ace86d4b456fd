"""A catalogue vehicle's own file, written elsewhere to start a vehicle of one's own from."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

from dq_marine.util.files import check_ending, check_targets, replacing_file
from dq_marine.vehicles.loading import catalogue_file

HEADER = """\
# Started from {name}, of the catalogue of dq-marine. Give it a name and numbers of your own, say in `sources` where
# they come from, and check the file with: dq-marine vehicles check {file}
#
"""


def export_vehicle(name: str, file: Path, *, force: bool = False) -> tuple[Path, ...]:
    """Write a vehicle of the catalogue into a file, with its comments and sources, and the tables that it names.

    Args:
        name: in the catalogue.
        file: to write; its name ends in .toml. Tables go beside it, their names beginning with its.
        force: replace files that are there.

    Returns:
        The files written, the vehicle's first.

    Raises:
        InvalidInputError: there is no such vehicle, the file's name has another ending, a file is there already, or
            the folder cannot be written; nothing is changed.
    """
    original = catalogue_file(name)
    check_ending(file, ".toml")
    source = original.read_text(encoding="utf-8")
    tables = _tables(source, original.parent, file)
    check_targets((file, *tables), force=force)
    for target, (_, content) in tables.items():  # before the file that names them
        with replacing_file(target) as temporary:
            temporary.write_bytes(content)
    with replacing_file(file) as temporary:
        temporary.write_text(_adapted(source, name, file, tables), encoding="utf-8")
    return (file, *tables)


def _tables(source: str, folder: Path, file: Path) -> dict[Path, tuple[str, bytes]]:
    """Return the files that a vehicle's file names: where they go, the key that names them, and what is in them."""
    found = {}
    for key, value in tomllib.loads(source).items():
        beside = folder / value if isinstance(value, str) and Path(value).suffix else None
        if beside is not None and beside.is_file():
            found[file.with_name(f"{file.stem}_{key}{beside.suffix}")] = (key, beside.read_bytes())
    return found


def _adapted(source: str, name: str, file: Path, tables: dict[Path, tuple[str, bytes]]) -> str:
    """Return the file's text with a header and a name that tell it from the catalogue's, naming its own tables."""
    text = HEADER.format(name=name, file=file.name) + source
    replaced = {"name": f"My {tomllib.loads(source)['name']}"}
    replaced |= {key: target.name for target, (key, _) in tables.items()}
    for key, value in replaced.items():
        line = f"{key} = {json.dumps(value, ensure_ascii=False)}"
        before, after = re.split(rf'^{key} *= *"[^"]*"', text, maxsplit=1, flags=re.MULTILINE)
        text = before + line + after
    return text
