"""Spectra of the sea's surface: how its energy is spread over the frequencies.

All are S(omega) = c omega^-5 exp(-5/4 (omega_p/omega)^4), Bretschneider's form, Jonswap's times its peak enhancement:
they differ in what they are named by. Their integral over omega is m0 = Hs^2/16, with the significant height Hs = 4
standard deviations of the elevation.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.physics.constants import GRAVITY
from dq_marine.physics.gravity import checked_gravity

Array = NDArray[np.float64]

LARGEST_STEEPNESS = 1.0 / 10.0
"""Largest 2 pi Hs/(g Tp^2) of a sea; waves break below it (DNV-RP-C205 limits seas to 1/15 to 1/25)."""

SMALLEST, LARGEST = 1e-6, 1e6
"""What a height [m], a period [s] or a speed [m/s] may be: far beyond, squares over- and underflow."""

LARGEST_ENHANCEMENT = 20.0
"""Largest peak enhancement factor of a Jonswap spectrum."""

LOWEST, HIGHEST = 0.4, 6.0
"""The frequencies, over that of the peak, within which all but some 1e-3 of the energy lies."""

GRID = np.geomspace(LOWEST, HIGHEST, 8001)
"""Frequencies over that of the peak, at which spectra are integrated."""


@dataclass(frozen=True)
class Spectrum(ABC):
    """A spectrum of one peak.

    Attributes:
        gravity: g [m/s^2], which says how long the waves are; in a scene, the scene's takes its place.
    """

    gravity: float = field(default=GRAVITY, kw_only=True)

    def __post_init__(self) -> None:
        """Refuse numbers that no sea has.

        Raises:
            InvalidInputError: with the value, the limit and the remedy.
        """
        for one in fields(self):
            number = finite_number(one.name, getattr(self, one.name), above=SMALLEST, most=LARGEST)
            object.__setattr__(self, one.name, number)
        checked_gravity(self.gravity)
        if self.steepness > LARGEST_STEEPNESS:
            raise InvalidInputError(
                f"significant height {self.significant_height:g} m at peak period {self.peak_period:g} s is a "
                f"steepness of {self.steepness:.3g}, and waves break beyond {LARGEST_STEEPNESS:g}; give a lower sea "
                "or a longer period"
            )

    @property
    @abstractmethod
    def significant_height(self) -> float:
        """Hs [m]."""

    @property
    @abstractmethod
    def peak_period(self) -> float:
        """Tp [s]."""

    @property
    def peak_frequency(self) -> float:
        """Angular frequency of the peak [rad/s]."""
        return 2.0 * math.pi / self.peak_period

    @property
    def steepness(self) -> float:
        """Hs over the length of the wave of period Tp in deep water."""
        return 2.0 * math.pi * self.significant_height / (self.gravity * self.peak_period**2)

    @property
    def enhancement(self) -> float:
        """Factor of the peak over Bretschneider's."""
        return 1.0

    def density(self, frequencies: ArrayLike) -> Array:
        """Return S [m^2 s/rad] at angular frequencies [rad/s], of any shape; zero where they are not positive."""
        relative = np.asarray(frequencies, dtype=np.float64) / self.peak_frequency
        return self._scale * shape_at(relative, self.enhancement)

    def moment(self, order: int) -> float:
        """Return m_n, the integral of omega^n S [m^2 (rad/s)^n], of order n from 0 to 3."""
        within = running_integral(GRID**order * shape_at(GRID, self.enhancement), GRID)[-1]
        beyond = math.pow(HIGHEST, order - 4.0) / (4.0 - order)  # there, S goes with omega^-5
        return self._scale * math.pow(self.peak_frequency, order + 1.0) * (float(within) + beyond)

    @property
    def mean_of_periods(self) -> float:
        """T1 = 2 pi m0/m1 [s]."""
        return 2.0 * math.pi * self.moment(0) / self.moment(1)

    @property
    def zero_crossing_period(self) -> float:
        """Tz = 2 pi sqrt(m0/m2), the mean time between upward crossings of still water [s]."""
        return 2.0 * math.pi * math.sqrt(self.moment(0) / self.moment(2))

    @cached_property
    def _scale(self) -> float:
        """Factor that makes m0 = Hs^2/16."""
        area = float(running_integral(shape_at(GRID, self.enhancement), GRID)[-1]) + 0.25 * math.pow(
            HIGHEST, -4.0
        )
        return self.significant_height * self.significant_height / 16.0 / (area * self.peak_frequency)


def running_integral(density: Array, places: Array) -> Array:
    """Return the integral of a density from the first place to each, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(places))])


def shape_at(relative: Array, enhancement: float) -> Array:
    """Return x^-5 exp(-5/4 x^-4) gamma^b, b = exp(-(x - 1)^2/(2 sigma^2)), for x = omega/omega_p.

    With Jonswap's sigma, 0.07 below the peak and 0.09 above (Hasselmann et al. 1973).
    """
    x = np.where(relative > 0.0, relative, np.inf)
    width = np.where(x <= 1.0, 0.07, 0.09)
    with np.errstate(over="ignore"):
        bretschneider = x**-5.0 * np.exp(-1.25 * x**-4.0)
        peak = np.exp(-0.5 * ((x - 1.0) / width) ** 2)
    return np.asarray(bretschneider * enhancement**peak)


@dataclass(frozen=True)
class Jonswap(Spectrum):
    """A sea that still grows, or of limited fetch (Hasselmann et al. 1973), by its height and peak.

    Attributes:
        height: significant, Hs [m].
        period: of the peak, Tp [s].
        gamma: factor of the peak over Bretschneider's; 3.3 on average, 1 for Pierson and Moskowitz's.
    """

    height: float
    period: float
    gamma: float = 3.3

    def __post_init__(self) -> None:
        """Refuse numbers that no sea has."""
        super().__post_init__()
        if not 1.0 <= self.gamma <= LARGEST_ENHANCEMENT:
            raise InvalidInputError(f"gamma = {self.gamma:g}; give one from 1 to {LARGEST_ENHANCEMENT:g}")

    @property
    def significant_height(self) -> float:
        """Hs [m]."""
        return self.height

    @property
    def peak_period(self) -> float:
        """Tp [s]."""
        return self.period

    @property
    def enhancement(self) -> float:
        """Factor of the peak."""
        return self.gamma


@dataclass(frozen=True)
class PiersonMoskowitz(Spectrum):
    """A sea that no longer grows, by the wind that raised it (Pierson and Moskowitz 1964).

    S = 0.0081 g^2 omega^-5 exp(-0.74 (g/(U omega))^4), hence Hs = 0.209 U^2/g and omega_p = 0.877 g/U.

    Attributes:
        wind_speed: U, at 19.5 m above the sea [m/s].
    """

    wind_speed: float

    @property
    def significant_height(self) -> float:
        """Hs [m]: 16 m0 with m0 = 0.0081 U^4/(4 * 0.74 g^2)."""
        return 4.0 * math.sqrt(0.0081 / 2.96) * self.wind_speed * self.wind_speed / self.gravity

    @property
    def peak_period(self) -> float:
        """Tp [s]: S is largest where omega^4 = 4/5 * 0.74 (g/U)^4."""
        return 2.0 * math.pi * self.wind_speed / (self.gravity * math.pow(0.8 * 0.74, 0.25))


@dataclass(frozen=True)
class ModifiedPiersonMoskowitz(Spectrum):
    """The ITTC's spectrum of two parameters, that of Pierson and Moskowitz by height and mean period.

    S = A omega^-5 exp(-B omega^-4) with A = 173 Hs^2/T1^4 and B = 691/T1^4.

    Attributes:
        height: significant, Hs [m].
        mean_period: T1 = 2 pi m0/m1 [s].
    """

    height: float
    mean_period: float

    @property
    def significant_height(self) -> float:
        """Hs [m]."""
        return self.height

    @property
    def peak_period(self) -> float:
        """Tp [s]: T1 = 2 pi B^(-1/4)/Gamma(3/4), and omega_p^4 = 4/5 B."""
        return self.mean_period * math.gamma(0.75) / math.pow(0.8, 0.25)
