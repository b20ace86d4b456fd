"""In what two plans differ, in words: a folder may hold another one than was asked for."""

from __future__ import annotations

from typing import Any


def told_differences(found: dict[str, Any], asked: dict[str, Any]) -> str:
    """Return, entry by entry, what a folder's plan has and what was asked for; both are nested dictionaries."""
    theirs, ours = _flat(found), _flat(asked)
    names = [name for name in sorted({*ours, *theirs}) if ours.get(name) != theirs.get(name)]
    return "; ".join(f"{one} is {theirs.get(one)!r}, not {ours.get(one)!r}" for one in names)


def _flat(content: dict[str, Any], above: str = "") -> dict[str, Any]:
    """Return nested dictionaries as one, by names with dots."""
    flat: dict[str, Any] = {}
    for name, value in content.items():
        flat |= _flat(value, f"{above}{name}.") if isinstance(value, dict) else {above + name: value}
    return flat
