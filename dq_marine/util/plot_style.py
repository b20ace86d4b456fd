"""One look for all figures: a colour, a marker and a line for each method, told apart in grey, too."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#767676"
"""Okabe and Ito's palette without its yellow, which white paper swallows, and a grey."""

INK = "#222222"
GRID = "#DDDDDD"

SOLID, DASHED, DOTTED, DASHDOT = "-", (0, (5, 2)), (0, (1.2, 1.6)), (0, (6, 2, 1.2, 2))


@dataclass(frozen=True)
class LineStyle:
    """How a method is drawn in every figure."""

    colour: str
    marker: str
    dash: Any = SOLID
    filled: bool = True

    def arguments(self) -> dict[str, Any]:
        """Return what matplotlib's `plot` takes."""
        return {
            "color": self.colour,
            "marker": self.marker,
            "linestyle": self.dash,
            "linewidth": 1.5,
            "markersize": 5.0,
            "markerfacecolor": self.colour if self.filled else "white",
            "markeredgecolor": self.colour,
        }

    def marks(self) -> dict[str, Any]:
        """Return the arguments of a method that is drawn as points alone."""
        return self.arguments() | {"linestyle": "none"}


STYLES = {
    "dqvi2": LineStyle(BLUE, "o"),
    "dqvi4": LineStyle(SKY, "s"),
    "dqvi6": LineStyle(GREEN, "D"),
    "dqvi8": LineStyle(PURPLE, "^"),
    "gauss6": LineStyle(GREEN, "d", DASHDOT),
    "gauss8": LineStyle(BLACK, "d", DASHDOT),
    "rk4": LineStyle(SKY, "v", DASHDOT),
    "rk8": LineStyle(SKY, "h", DASHDOT),
    "galerkin8": LineStyle(PURPLE, "^", DASHED, filled=False),
    "dqvi_paper": LineStyle(BLUE, "o", DASHED, filled=False),
    "rk4_quaternion": LineStyle(VERMILLION, "v"),
    "rk4_transported": LineStyle(VERMILLION, "d", DASHDOT, filled=False),
    "dop853": LineStyle(BLACK, "*"),
    "rk4_euler": LineStyle(VERMILLION, "v", DASHED, filled=False),
    "rkmk4": LineStyle(ORANGE, "<"),
    "decoupled_lie": LineStyle(ORANGE, ">", DASHED, filled=False),
    "semi_implicit_euler": LineStyle(BLACK, "P", DOTTED),
    "explicit_euler": LineStyle(GREY, "X", DOTTED),
    "scipy_dop853": LineStyle(GREY, "*", DASHDOT),
    "scipy_radau": LineStyle(GREY, "h", DASHDOT, filled=False),
    "scipy_lsoda": LineStyle(BLACK, "p", DASHDOT, filled=False),
    "mujoco_euler": LineStyle(GREEN, "1", DASHED),
    "mujoco_implicitfast": LineStyle(PURPLE, "3", DASHED),
    "mujoco_rk4": LineStyle(GREEN, "2", DASHED),
}

SPARES = tuple(
    LineStyle(colour, marker, DASHDOT)
    for marker in ("d", "3", "4")
    for colour in (PURPLE, SKY, GREEN, BLACK, BLUE)
)
"""For methods that are not named above."""


def style_of(name: str) -> LineStyle:
    """Return how a method is drawn; a method that is not listed gets a spare style by its name."""
    return STYLES.get(name) or SPARES[sum(name.encode()) % len(SPARES)]


SETTINGS = {
    "font.family": ["DejaVu Sans"],
    "font.size": 9.5,
    "axes.titlesize": 10.5,
    "axes.labelsize": 9.5,
    "axes.edgecolor": "#666666",
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "text.hinting": "none",  # text is as wide in a vector as in pixels
    "svg.fonttype": "none",
    "path.simplify": True,
}
"""Of matplotlib, in force while a figure is made and written."""
