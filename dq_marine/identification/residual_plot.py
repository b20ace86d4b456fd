"""A picture of what a fit leaves: residuals over time, one small diagram for each output."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.identification.fit import Fit
from dq_marine.identification.problem import OUTPUTS
from dq_marine.util.extras import extra_needed
from dq_marine.util.figures import check_picture_path, keep_what_carries_data, new_figure, save_figure
from dq_marine.util.files import check_folder
from dq_marine.util.plot_style import BLUE, INK, SETTINGS, VERMILLION

COLUMNS = 3


def check_plot_path(path: Path) -> None:
    """Check that a picture can be written to a path.

    Raises:
        InvalidInputError: matplotlib does not know its ending, or its folder does not exist.
        MissingDependencyError: matplotlib is not installed.
    """
    check_picture_path(path)
    check_folder(path)


def save_residuals(fit: Fit, path: Path) -> None:
    """Draw the residuals of all outputs that were measured, each with its root of the mean square.

    Raises:
        InvalidInputError: the path cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    with extra_needed("plotting", "report"):
        from matplotlib import rc_context
    settings: Any = SETTINGS
    with rc_context(settings):
        save_figure(_figure(fit), path)


def _figure(fit: Fit) -> Any:
    shown = np.flatnonzero(~np.isnan(fit.noise))
    rows = -(-len(shown) // COLUMNS)
    figure = new_figure(11.0, 1.2 + 1.9 * rows)
    title = f"{fit.nominal.name}: measured less simulated, {fit.log}"
    figure.suptitle(title, fontsize=12.0, color=INK, fontweight="bold", x=0.01, ha="left")
    for place, output in enumerate(shown, start=1):
        axes = figure.add_subplot(rows, COLUMNS, place)
        name, unit = OUTPUTS[output]
        axes.plot(fit.time, fit.residuals[:, output], ".", color=BLUE, markersize=1.2)
        for side in (-1.0, 1.0):
            axes.axhline(side * fit.noise[output], color=VERMILLION, linewidth=0.9)
        axes.set_title(f"{name}: rms {fit.noise[output]:.3g} {unit}", loc="left")
        axes.set_ylabel(f"[{unit}]")
        keep_what_carries_data(axes)
        if place > len(shown) - COLUMNS:
            axes.set_xlabel("time [s]")
    return figure
