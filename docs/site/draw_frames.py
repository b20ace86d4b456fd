"""Draw the picture of the frames: `python docs/site/draw_frames.py`. It needs matplotlib (the extra `render`)."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.vector3 import Vector3, add, scale

PICTURE = Path(__file__).parents[1] / "concepts" / "frames.png"

ORIGIN: Vector3 = (1.0, 2.9, 1.0)
"""Of the body, in NED [m]."""

ATTITUDE = quaternion_from_euler(math.radians(10.0), math.radians(15.0), math.radians(75.0))
TURN, ELEVATION = math.radians(50.0), math.radians(28.0)
"""The observer looks down by the elevation, with the east turned away from the right by 90 degrees less the turn."""

AXES: tuple[Vector3, Vector3, Vector3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NED_NAMES = ("x: north", "y: east", "z: down")
BODY_NAMES = (
    "x: forward\nsurge u, roll rate p",
    "y: starboard\nsway v, pitch rate q",
    "z: down\nheave w, yaw rate r",
)
NED, BODY, HULL = "#1f4e79", "#b3452c", "#8a99a5"


def main(picture: Path = PICTURE) -> None:
    """Draw the axes of both frames, a hull, and what its velocities are called."""
    figure = Figure(figsize=(8.0, 4.4), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(-0.7, 5.2), ylim=(-2.55, 0.7), aspect="equal")
    axes.set_axis_off()
    _hull(axes)
    _line(axes, [(0.0, 0.0, 0.0), ORIGIN], color="black", linestyle=":", linewidth=1.3)
    right, up = _on_paper(scale(0.5, ORIGIN))
    axes.text(right, up + 0.1, "position_ned", fontsize=11, family="monospace", ha="left")
    for axis, name in zip(AXES, NED_NAMES, strict=True):
        _arrow(axes, (0.0, 0.0, 0.0), axis, name, NED)
    for axis, name in zip(AXES, BODY_NAMES, strict=True):
        _arrow(axes, ORIGIN, scale(1.15, rotate(ATTITUDE, axis)), name, BODY)
    axes.text(-0.55, 0.5, "NED frame", color=NED, fontsize=13, weight="bold")
    axes.text(4.0, 0.5, "body frame", color=BODY, fontsize=13, weight="bold")
    figure.savefig(picture, metadata={"Software": ""})


def _on_paper(point_ned: Vector3) -> tuple[float, float]:
    """Return where a point is drawn, to the right and up, by a parallel projection."""
    north, east, down = point_ned
    right = math.cos(TURN) * north + math.sin(TURN) * east
    away = math.sin(TURN) * north - math.cos(TURN) * east
    return right, math.sin(ELEVATION) * away - math.cos(ELEVATION) * down


def _line(axes: Any, points_ned: list[Vector3], **look: Any) -> None:
    axes.plot(*zip(*map(_on_paper, points_ned), strict=True), **look)


def _arrow(axes: Any, start: Vector3, along: Vector3, name: str, colour: str) -> None:
    look = {
        "arrowstyle": "-|>",
        "color": colour,
        "linewidth": 2.2,
        "mutation_scale": 16,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate("", xy=_on_paper(add(start, along)), xytext=_on_paper(start), arrowprops=look)
    right, up = _on_paper(add(start, scale(1.06, along)))
    leans_right = right - _on_paper(start)[0] > 0.2
    side = {"ha": "left", "va": "center"} if leans_right else {"ha": "center", "va": "top"}
    axes.text(right, up, name, color=colour, fontsize=11, **side)


def _hull(axes: Any) -> None:
    """Draw a spheroid 1.6 m long as its circles."""
    angles = [2.0 * math.pi * step / 60 for step in range(61)]
    for station in range(-6, 7):
        along = 0.13 * station
        radius = 0.26 * math.sqrt(1.0 - (along / 0.8) ** 2)
        circle = [(along, radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
        _line(axes, [add(ORIGIN, rotate(ATTITUDE, point)) for point in circle], color=HULL, linewidth=0.8)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
