"""Gusts: the spectrum of the wind's speed over the open sea, and its harmonics."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.physics.waves.sea import JITTER, generator, table
from dq_marine.physics.waves.spectra import running_integral
from dq_marine.physics.wind.formulas import Harmonics

Array = NDArray[np.float64]

SLOWEST, FASTEST = 1.0 / 600.0, 0.5
"""The frequencies that the spectrum is for [Hz]."""

REFERENCE_HEIGHT = 10.0
"""Height at which the mean speed is given [m]."""


def mean_speed(speed: float, height: float) -> float:
    """Return the mean over an hour at a height [m], from that at 10 m [m/s].

    U(z) = U (1 + C ln(z/10)), C = 0.0573 sqrt(1 + 0.15 U) (Norwegian Petroleum Directorate; ISO 19901-1).
    """
    return speed * (1.0 + 0.0573 * math.sqrt(1.0 + 0.15 * speed) * math.log(height / REFERENCE_HEIGHT))


def gust_spectrum(frequencies: ArrayLike, speed: float, height: float) -> Array:
    """Return the density of the speed's variance [m^2/s^2/Hz] at frequencies [Hz].

    S(f) = 320 (U/10)^2 (z/10)^0.45/(1 + x^n)^(5/(3n)), x = 172 f (z/10)^(2/3) (U/10)^(-3/4), n = 0.468 (Norwegian
    Petroleum Directorate; ISO 19901-1), U the mean over an hour at 10 m [m/s], z the height [m].
    """
    level = height / REFERENCE_HEIGHT
    x = 172.0 * np.asarray(frequencies) * level ** (2.0 / 3.0) * (speed / 10.0) ** -0.75
    n = 0.468
    return np.asarray(320.0 * (speed / 10.0) ** 2 * level**0.45 / (1.0 + x**n) ** (5.0 / (3.0 * n)))


def gust_harmonics(speed: float, height: float, components: int, seed: int) -> Harmonics:
    """Return gusts of the spectrum, as many components of equal energy; see `gust_spectrum`."""
    grid = np.geomspace(SLOWEST, FASTEST, 4001)
    energy = running_integral(gust_spectrum(grid, speed, height), grid)
    of_frequency, of_phase = generator(seed).random((2, components))
    middle = 0.5 + JITTER * (of_frequency - 0.5)
    frequencies = np.interp((np.arange(components) + middle) / components, energy / energy[-1], grid)
    amplitude = math.sqrt(2.0 * float(energy[-1]) / components)
    return Harmonics(
        amplitude=table(np.full(components, amplitude)),
        frequency=table(2.0 * math.pi * frequencies),
        phase=table(2.0 * math.pi * of_phase),
    )
