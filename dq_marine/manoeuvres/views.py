"""The pictures of all manoeuvres."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from dq_marine.manoeuvres import (
    acceleration_view,
    decay_view,
    spiral_view,
    stopping_view,
    turning_circle_view,
    zig_zag_view,
)
from dq_marine.manoeuvres.canvas import save_picture
from dq_marine.manoeuvres.quantities import Result

VIEWS: dict[str, Callable[[Any], Any]] = {
    "acceleration": acceleration_view.draw,
    "decay": decay_view.draw,
    "spiral": spiral_view.draw,
    "stopping": stopping_view.draw,
    "turning-circle": turning_circle_view.draw,
    "zig-zag": zig_zag_view.draw,
}
"""Function that draws each manoeuvre's result, by the manoeuvre's name; it returns a matplotlib figure."""


def save_plot(result: Result, path: Path) -> None:
    """Write the picture of a manoeuvre.

    Raises:
        InvalidInputError: the path's ending is unknown, or it cannot be written.
    """
    save_picture(partial(VIEWS[result.manoeuvre], result), path)
