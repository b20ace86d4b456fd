"""The picture of a free decay test."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.manoeuvres.canvas import (
    GUIDE_COLOUR,
    HEADING_COLOUR,
    LEGEND,
    MARK_COLOUR,
    new_figure,
    over_time,
)
from dq_marine.manoeuvres.decay import AXES, Decay, displacement_of
from dq_marine.manoeuvres.decrement import Decrement
from dq_marine.util.plot_style import GREEN

Array = NDArray[np.float64]


def draw(result: Decay) -> Any:
    """Return the figure: the swings with their extremes, and the damping ratio against their size."""
    heave = result.motion == "heave"
    unit, factor = ("m", 1.0) if heave else ("deg", math.degrees(1.0))
    figure = new_figure(result, f"free decay of {result.motion} from {factor * result.release:.3g} {unit}")
    swings, ratios = figure.subplots(1, 2, width_ratios=[1.7, 1.0])
    time = result.series.time
    displacement = factor * _displacement(result)
    swings.plot(time, displacement, color=HEADING_COLOUR, linewidth=1.5, label="simulated")
    if result.prediction is not None:
        predicted = factor * result.release * _linear_swing(result, time)
        swings.plot(
            time,
            predicted,
            color=GUIDE_COLOUR,
            linewidth=1.0,
            linestyle="--",
            label="linear equations: M, C and linear D",
            zorder=1,
        )
    over_time(swings, f"{result.motion} [{unit}]")
    swings.set_xlabel("time since the release [s]")
    if result.decrement is not None:
        offset = float(displacement[0]) - factor * float(result.decrement.peaks[0])
        peaks = factor * result.decrement.peaks + offset
        swings.plot(
            result.decrement.peak_times, peaks, "o", color=MARK_COLOUR, markersize=4.5, label="extremes"
        )
        _draw_ratios(ratios, result.decrement, factor)
    if result.prediction is not None:
        ratio = result.prediction.damping_ratio
        ratios.axhline(ratio, color=GUIDE_COLOUR, linewidth=1.0, linestyle="--", label="linear equations")
    ratios.set_xlabel(f"amplitude [{unit}]")
    ratios.set_ylabel("damping ratio [-]")
    ratios.set_xlim(left=0.0)
    for axes in (swings, ratios):
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="upper right", **LEGEND)
    return figure


def _displacement(result: Decay) -> Array:
    """Return the motion, of heave about the place it was released from [m]."""
    values = displacement_of(result.series, AXES[result.motion])
    return np.asarray(values - values[0] + result.release)


def _linear_swing(result: Decay, time: Array) -> Array:
    """Return the linear oscillator's motion from rest at 1."""
    assert result.prediction is not None  # noqa: S101 - for the type checker
    decay = result.prediction.damping_ratio * result.prediction.natural_frequency
    frequency = 2.0 * math.pi / result.prediction.period
    swing = np.cos(frequency * time) + decay / frequency * np.sin(frequency * time)
    return np.asarray(np.exp(-decay * time) * swing)


def _draw_ratios(axes: Any, found: Decrement, factor: float) -> None:
    axes.plot(
        factor * found.amplitudes, found.ratios, "o", color=MARK_COLOUR, markersize=5.0, label="of each swing"
    )
    ends = np.array([0.0, float(found.amplitudes.max())])
    line = found.linear_ratio + 4.0 / (3.0 * math.pi) * found.quadratic * ends
    axes.plot(factor * ends, line, color=GREEN, linewidth=1.3, label="linear and quadratic damping, fitted")
    top = max(float(found.ratios.max()), float(line.max()), 1e-3)
    axes.set_ylim(min(0.0, float(found.ratios.min()), float(line.min())) - 0.05 * top, 1.25 * top)
