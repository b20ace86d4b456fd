"""Writing TOML, which Python's standard library only reads."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(content: Mapping[str, Any]) -> str:
    """Return nested dictionaries as TOML: a table for each, lists and what is in them on one line.

    Args:
        content: strings, numbers, booleans, lists and dictionaries; entries that are None are left out, as TOML has no
            word for it.
    """
    return "\n\n".join(_tables(content, ())) + "\n"


def _tables(content: Mapping[str, Any], path: tuple[str, ...]) -> list[str]:
    """Return a table's own entries, then the tables in it, each as text."""
    own = {key: value for key, value in content.items() if not isinstance(value, Mapping)}
    lines = [f"{_key(key)} = {_value(value)}" for key, value in own.items() if value is not None]
    inner = {key: value for key, value in content.items() if isinstance(value, Mapping)}
    if path and (lines or not inner):
        lines.insert(0, f"[{'.'.join(_key(part) for part in path)}]")
    texts = ["\n".join(lines)] if lines else []
    for key, value in inner.items():
        texts += _tables(value, (*path, key))
    return texts


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _value(key)


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        parts = [f"{_key(key)} = {_value(part)}" for key, part in value.items() if part is not None]
        return f"{{ {', '.join(parts)} }}" if parts else "{}"
    if isinstance(value, Sequence):
        return f"[{', '.join(_value(part) for part in value)}]"
    return repr(value)
