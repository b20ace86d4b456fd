"""A picture of a sea: its spectrum, and a stretch of its elevation."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.physics.weather import Sea
from dq_marine.util.figures import check_picture_path, keep_what_carries_data, new_figure, save_figure
from dq_marine.util.plot_style import BLUE, GREY, ORANGE

LONGEST_SHOWN = 300.0
"""Of a record [s]: more is a grey band."""


def save_sea_plot(sea: Sea, path: Path, *, seconds: float) -> None:
    """Draw spectrum and elevation into a picture file.

    Args:
        sea: what is drawn.
        path: of the picture; its ending chooses the format (.png, .svg, .pdf).
        seconds: of the elevation; the first five minutes of it are shown.

    Raises:
        InvalidInputError: the path cannot be written, or matplotlib does not know its ending.
        MissingDependencyError: matplotlib is not installed.
    """
    check_picture_path(path)
    figure = new_figure(8.0, 6.0)
    spectrum, elevation = figure.subplots(2, 1)
    _draw_spectrum(spectrum, sea)
    _draw_elevation(elevation, sea, min(seconds, LONGEST_SHOWN))
    save_figure(figure, path)


def _draw_spectrum(axes: Any, sea: Sea) -> None:
    """Draw the density, and below it where the components are."""
    spectrum = sea.spectrum
    frequencies = np.linspace(0.3, 4.0, 800) * spectrum.peak_frequency
    density = spectrum.density(frequencies)
    axes.plot(frequencies, density, color=BLUE, linewidth=1.8)
    axes.plot(
        sea.frequencies, np.full(sea.components, -0.04 * density.max()), "|", color=ORANGE, markersize=7
    )
    axes.annotate(
        f"{sea.components} components of equal energy",
        (0.99, 0.12),
        xycoords="axes fraction",
        ha="right",
        color=ORANGE,
    )
    axes.set_xlim(0.0, frequencies[-1])
    axes.set_ylim(-0.08 * density.max(), 1.1 * density.max())
    axes.set_xlabel("angular frequency [rad/s]")
    axes.set_ylabel("S [m$^2$ s/rad]")
    axes.set_title(
        f"Hs = {spectrum.significant_height:.3g} m, Tp = {spectrum.peak_period:.3g} s, "
        f"steepness {spectrum.steepness:.2g}"
    )
    keep_what_carries_data(axes)


def _draw_elevation(axes: Any, sea: Sea, seconds: float) -> None:
    times = np.arange(0.0, seconds, sea.spectrum.peak_period / 40.0)
    axes.plot(times, sea.elevation(times), color=BLUE, linewidth=1.2)
    half = 0.5 * sea.spectrum.significant_height
    for level in (-half, half):
        axes.axhline(level, color=GREY, linestyle="--", linewidth=1.0)
    axes.annotate("Hs/2", (1.0, half), xycoords=("axes fraction", "data"), xytext=(-4, 3),
                  textcoords="offset points", ha="right", color=GREY)  # fmt: skip
    axes.set_xlim(0.0, max(seconds, math.ulp(1.0)))
    axes.set_xlabel("time [s]")
    axes.set_ylabel("elevation [m]")
    keep_what_carries_data(axes)
