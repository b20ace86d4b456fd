"""Variants of the catalogue's vehicles: another set of numbers, as the places of a file where it differs."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "catalogue" / "variants"


def variant_names() -> list[str]:
    """Return the names of the variants, sorted."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def read_variant(name: str) -> tuple[str, dict[str, Any]]:
    """Return the vehicle of the catalogue that a variant is of, and by dotted places what it has there instead."""
    content = tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    return content["base"], content["changes"]


def varied(content: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the content of a vehicle file with other values at some places, each replaced as a whole.

    Args:
        content: of the file.
        changes: by place, "damping.couplings" for the key `couplings` of the table `damping`.
    """
    result = copy.deepcopy(content)
    for place, value in changes.items():
        *tables, key = place.split(".")
        inner = result
        for table in tables:
            inner = inner[table]
        inner[key] = value
    return result
