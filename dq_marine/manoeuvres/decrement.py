"""Period and damping from the swings of a decaying oscillation, by its logarithmic decrement."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SMALLEST_SHARE = 0.01
"""Smallest damping ratio that counts with its own size in the fit, over the largest."""


@dataclass(frozen=True)
class Decrement:
    """Period and damping, from the extremes of a decaying oscillation.

    A half range, from one extreme to the next and halved, is free of a constant offset. From one to the next, an
    oscillation of damping ratio zeta shrinks by exp(-pi zeta / sqrt(1 - zeta^2)) (any vibrations text). One with

        x'' + 2 zeta omega x' + b |x'| x' + omega^2 x = 0

    loses as much energy at an amplitude a as a linear one of zeta + 4 b a / (3 pi): that line is fitted.

    Attributes:
        peak_times: of the extremes [s], shape (n,).
        peaks: the extremes, as the displacement.
        amplitudes: a mean of successive half ranges, shape (n - 2,).
        ratios: damping ratio from each pair of them, shape (n - 2,).
        period: mean, damped [s].
        damping_ratio: mean.
        linear_ratio: zeta, the line at no amplitude; the mean of less than three.
        quadratic: b, from its slope, 0 of less than three [1 over the unit of the displacement].
    """

    peak_times: Array
    peaks: Array
    amplitudes: Array
    ratios: Array
    period: float
    damping_ratio: float
    linear_ratio: float
    quadratic: float


def decrement_of(time: Array, displacement: Array, smallest: float) -> Decrement | None:
    """Return what the swings say; None with less than three extremes, the release being the first.

    Args:
        time: equally spaced [s], shape (n,).
        displacement: released at rest at the first sample, shape (n,).
        smallest: half range below which swings are not counted.
    """
    times, peaks = extremes(time, displacement)
    ranges = 0.5 * np.abs(np.diff(peaks))
    small = np.flatnonzero(ranges < smallest)
    if small.size:
        times, peaks, ranges = times[: small[0] + 1], peaks[: small[0] + 1], ranges[: small[0]]
    if len(peaks) < 3:
        return None
    logarithms = np.log(ranges[:-1] / ranges[1:])
    ratios = logarithms / np.sqrt(math.pi**2 + logarithms**2)
    # The mean that makes the line exact for b alone, where 1/a grows by the same in every swing.
    amplitudes = ranges[:-1] * ranges[1:] * logarithms / (ranges[:-1] - ranges[1:])
    linear, slope = fitted_line(amplitudes, ratios)
    return Decrement(
        peak_times=times,
        peaks=peaks,
        amplitudes=amplitudes,
        ratios=ratios,
        period=2.0 * float(times[-1] - times[0]) / (len(times) - 1),
        damping_ratio=float(ratios.mean()),
        linear_ratio=linear,
        quadratic=0.75 * math.pi * slope,
    )


def fitted_line(amplitudes: Array, ratios: Array) -> tuple[float, float]:
    """Return intercept and slope of the line through the damping ratios; a level one through less than three.

    Deviations count by their share of the ratio: the line is exact for small damping, and many swings are small.
    """
    if len(ratios) < 3:
        return float(ratios.mean()), 0.0
    sizes = np.abs(ratios)
    floor = SMALLEST_SHARE * float(sizes.max())
    weights = 1.0 / np.maximum(sizes, floor) if floor > 0.0 else None
    slope, intercept = np.polyfit(amplitudes, ratios, 1, w=weights)
    return float(intercept), float(slope)


def extremes(time: Array, displacement: Array) -> tuple[Array, Array]:
    """Return times [s] and values of the extremes, the release included, each from a parabola through three samples."""
    change = np.diff(displacement)
    turning = np.flatnonzero(change[:-1] * change[1:] < 0.0) + 1
    before, peak, after = (displacement[turning + offset] for offset in (-1, 0, 1))
    curvature = before - 2.0 * peak + after
    shift = 0.5 * (before - after) / curvature
    period = float(time[1] - time[0])
    times = time[turning] + shift * period
    values = peak - 0.25 * (before - after) * shift
    return np.concatenate([time[:1], times]), np.concatenate([displacement[:1], values])
