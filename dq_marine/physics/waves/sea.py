"""A sea: a spectrum, a direction and a seed, made into components."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.table import Table
from dq_marine.checks import finite_number, positive_integer, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.dispersion import wave_numbers
from dq_marine.physics.waves.formulas.kinematics import WaveField
from dq_marine.physics.waves.spectra import GRID, Spectrum, running_integral, shape_at

Array = NDArray[np.float64]

MOST_COMPONENTS = 2000
LARGEST_SPREADING = 100.0

JITTER = 0.5
"""Share of a bin's energy within which a component's frequency is drawn; neighbours stay half a bin apart."""


def table(numbers: Array) -> Table:
    """Return numbers as pure functions take them."""
    return Table(np.ravel(numbers).tolist())


def generator(seed: int) -> np.random.Generator:
    """Return a seed's generator.

    Raises:
        InvalidInputError: it is no integer of 0 or more.
    """
    return np.random.default_rng(whole_number("seed", seed, least=0))


@dataclass(frozen=True)
class Sea:
    """A stationary sea, as a sum of linear waves.

    The spectrum is cut into bins of equal energy. Each has one component, of a frequency drawn within the middle half
    of its bin, so that the sea does not repeat itself, and of a phase drawn from all. All components have the same
    amplitude, so the sea has its significant height whatever the seed.

    The waves' lengths follow from the gravity of the spectrum. In a scene the sea is taken under the scene's gravity,
    which may differ: `in_gravity` returns that sea.

    The frequencies are those that an observer at rest over ground meets; what a current does to the waves' length is
    left out.

    Attributes:
        spectrum: how the energy is spread over frequencies.
        direction: where the waves go to, an angle from north towards east [rad].
        components: how many.
        seed: of frequencies, phases and directions.
        spreading: s of the spreading cos^2s about the direction, in the half plane ahead; None for waves of one
            direction.
        depth: of the water [m]; None for deep water.
    """

    spectrum: Spectrum
    direction: float = 0.0
    components: int = 80
    seed: int = 0
    spreading: float | None = None
    depth: float | None = None

    def __post_init__(self) -> None:
        """Refuse what is no sea.

        Raises:
            InvalidInputError: with the value, the limit and the remedy.
        """
        if not isinstance(self.spectrum, Spectrum):
            raise InvalidInputError(
                f"spectrum = {shown(self.spectrum)}; give a Jonswap, PiersonMoskowitz or ModifiedPiersonMoskowitz"
            )
        checked = {
            "direction": finite_number("direction", self.direction),
            "components": positive_integer("components", self.components),
        }
        if checked["components"] > MOST_COMPONENTS:
            raise InvalidInputError(f"components = {self.components}; give at most {MOST_COMPONENTS}")
        if self.spreading is not None:
            spreading = finite_number("spreading", self.spreading, above=0.0)
            if spreading > LARGEST_SPREADING:
                raise InvalidInputError(
                    f"spreading = {spreading:g}; give at most {LARGEST_SPREADING:g}, or None"
                )
            checked["spreading"] = spreading
        if self.depth is not None:
            checked["depth"] = finite_number("depth", self.depth, above=0.0)
        generator(self.seed)
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @cached_property
    def _drawn(self) -> tuple[Array, Array, Array]:
        """Frequencies, directions and phases; each has numbers of its own, whatever the others ask."""
        of_frequency, of_phase, of_direction = generator(self.seed).random((3, self.components))
        middle = 0.5 + JITTER * (of_frequency - 0.5)
        frequencies = energy_quantiles(self.spectrum, (np.arange(self.components) + middle) / self.components)
        directions = np.full(self.components, self.direction)
        if self.spreading is not None:
            # Every direction's share of the components, dealt out to the frequencies at random.
            order = np.argsort(of_direction)
            directions += spreading_quantiles(self.spreading, (order + 0.5) / self.components)
        return frequencies, directions, 2.0 * math.pi * of_phase

    @property
    def gravity(self) -> float:
        """Acceleration of gravity g, that of the spectrum [m/s^2]."""
        return self.spectrum.gravity

    def in_gravity(self, gravity: float) -> Sea:
        """Return the sea under another gravity [m/s^2], or itself if it is the same.

        The waves have the same phases; those of a spectrum that is named by height and period have the same heights and
        frequencies, and other lengths.

        Raises:
            InvalidInputError: it is no number from 0.1 to 30, or the waves would be so short that they break.
        """
        if gravity == self.gravity:
            return self
        return replace(self, spectrum=replace(self.spectrum, gravity=gravity))

    @property
    def amplitudes(self) -> Array:
        """Amplitudes of the components [m], all the same, shape (components,)."""
        return np.full(self.components, self.spectrum.significant_height / math.sqrt(8.0 * self.components))

    @property
    def frequencies(self) -> Array:
        """Angular frequencies of the components [rad/s], rising, shape (components,)."""
        return self._drawn[0]

    @property
    def directions(self) -> Array:
        """Directions in which the components travel [rad], shape (components,)."""
        return self._drawn[1]

    @property
    def phases(self) -> Array:
        """Phases of the components at the world's origin and time 0 [rad], shape (components,)."""
        return self._drawn[2]

    @cached_property
    def wave_numbers(self) -> Array:
        """Wave numbers of the components [rad/m], shape (components,)."""
        return wave_numbers(self.frequencies, self.depth, self.gravity)

    def elevation(self, time: ArrayLike, north: ArrayLike = 0.0, east: ArrayLike = 0.0) -> Array:
        """Return the surface's height above still water [m], in the common shape of the arguments.

        Args:
            time: [s].
            north: of the place [m].
            east: of the place [m].
        """
        k, directions = self.wave_numbers, self.directions
        each = (
            self.amplitudes,
            self.frequencies,
            k * np.cos(directions),
            k * np.sin(directions),
            self.phases,
        )
        t, x, y = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (time, north, east)))
        total = np.zeros(t.shape)
        for a, omega, k_north, k_east, phase in zip(*(part.tolist() for part in each), strict=True):
            total += a * np.cos(omega * t + phase - k_north * x - k_east * y)
        return total

    @cached_property
    def field(self) -> WaveField:
        """The components as the formulas take them."""
        k, directions = self.wave_numbers, self.directions
        echo = np.zeros_like(k) if self.depth is None else np.exp(-2.0 * k * self.depth)
        return WaveField(
            amplitude=table(self.amplitudes),
            frequency=table(self.frequencies),
            wave_number=table(k),
            north=table(k * np.cos(directions)),
            east=table(k * np.sin(directions)),
            phase=table(self.phases),
            echo=table(echo),
        )


def energy_quantiles(spectrum: Spectrum, shares: Array) -> Array:
    """Return the frequencies [rad/s] below which the given shares of a spectrum's energy lie."""
    energy = running_integral(shape_at(GRID, spectrum.enhancement), GRID)
    return np.interp(shares, energy / energy[-1], GRID) * spectrum.peak_frequency


def spreading_quantiles(s: float, shares: Array) -> Array:
    """Return the angles [rad] below which the given shares of a spreading cos^2s lie."""
    angles = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 4001)
    energy = running_integral(np.maximum(np.cos(angles), 0.0) ** (2.0 * s), angles)
    return np.interp(shares, energy / energy[-1], angles)
