"""What the page of a replay carries out, read back from its file."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import umsgpack


def commands_in(path: Path) -> list[dict[str, Any]]:
    """The messages that a replay carries out, in order."""
    return [umsgpack.unpackb(base64.b64decode(command)) for command in constant_in(path, "messages")]


def constant_in(path: Path, name: str) -> Any:
    """The data that a page gives its scripts by a name."""
    found = re.search(rf"const {name} = (.*);", path.read_text(encoding="utf-8"))
    assert found is not None
    return json.loads(found[1])


def track_in(commands: list[dict[str, Any]], path: str, what: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and values, a row each, of what an animation does to the `position` or another property of a thing."""
    animation = next(one for one in commands if one["type"] == "set_animation")
    clip = next(one["clip"] for one in animation["animations"] if one["path"] == path)
    track = next(one for one in clip["tracks"] if one["name"] == f".{what}")
    times, values = (np.frombuffer(track[name].data, dtype="<f4") for name in ("times", "values"))
    return times, values.reshape(len(times), -1)
