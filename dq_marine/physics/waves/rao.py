"""Force transfer functions of a hull (force RAOs): what force each wave makes, by frequency and heading."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.formulas.transfer import WaveTransfer, transferred_waves
from dq_marine.physics.waves.sea import Sea, table
from dq_marine.physics.waves.tables import check_rising, check_table

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

FOLLOWED = 0.01
"""Part of each axis's force, root mean square over sea and headings, that a series in the heading may miss."""

MOST_HARMONICS = 24
LARGEST_GAP = math.radians(60.0)
"""Between headings: what is farther apart cannot be told from its neighbours."""

MIRRORED = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
"""Signs of a wrench, in Fossen's order, when port and starboard are exchanged."""


@dataclass(frozen=True, eq=False)
class ForceRAO:
    """Force transfer functions, in the body frame about the body origin, per metre of wave amplitude.

    A wave that raises the surface at the body origin by a cos(omega t) makes the force Re(a F e^{i omega t}): phases
    are positive where the force leads the crest.

    Attributes:
        frequencies: rising, shape (n,) [rad/s].
        headings: into which the waves go, relative to the vessel's: 0 a following sea, pi/2 from port, pi a head sea;
            rising, less than a turn from first to last, shape (m,) [rad].
        transfer: F in Fossen's order, complex, shape (n, m, 6) [N/m, N].
    """

    frequencies: Array
    headings: Array
    transfer: ComplexArray

    def __post_init__(self) -> None:
        """Refuse what is no set of transfer functions.

        Raises:
            InvalidInputError: with the reason.
        """
        check_rising("frequencies", self.frequencies)
        check_rising("headings", self.headings)
        check_table("transfer", self.transfer, (len(self.frequencies), len(self.headings), 6))
        if self.frequencies[0] <= 0.0:
            raise InvalidInputError("frequencies must be positive and rise")
        if self.headings[-1] - self.headings[0] >= 2.0 * math.pi:
            raise InvalidInputError(
                "headings must rise, by less than a turn in all (0 and 2 pi are the same)"
            )

    def mirrored(self) -> ForceRAO:
        """Return the same for all headings, from headings of 0 to pi and a hull alike on port and starboard."""
        inner = (self.headings > 1e-9) & (self.headings < math.pi - 1e-9)
        other = 2.0 * math.pi - self.headings[inner][::-1]
        reflected = self.transfer[:, inner][:, ::-1] * MIRRORED
        return ForceRAO(
            self.frequencies,
            np.concatenate([self.headings, other]),
            np.concatenate([self.transfer, reflected], axis=1),
        )

    def at(self, frequencies: Array) -> ComplexArray:
        """Return F at frequencies [rad/s], shape (len(frequencies), m, 6).

        Linear between the given ones, in real and imaginary part; as at the lowest below it, zero above the highest.
        """
        own = np.clip(
            np.searchsorted(self.frequencies, frequencies) - 1, 0, max(0, len(self.frequencies) - 2)
        )
        after = np.minimum(own + 1, len(self.frequencies) - 1)
        gap = np.where(after > own, self.frequencies[after] - self.frequencies[own], 1.0)
        part = np.clip((frequencies - self.frequencies[own]) / gap, 0.0, 1.0)[:, None, None]
        between = (1.0 - part) * self.transfer[own] + part * self.transfer[after]
        within = frequencies <= self.frequencies[-1] * (1.0 + 1e-12)
        return np.asarray(between * within[:, None, None])

    def series(self, frequencies: Array, amplitudes: Array) -> list[ComplexArray]:
        """Return the series in the heading that follow F, one for each frequency, each of shape (harmonics, 2, 6).

        Their entries [n, 0] and [n, 1] go with cos(n beta) and sin(n beta). There are as many harmonics as are needed
        to follow every axis's force to 1 % (root mean square over the sea and the headings), or as the headings can
        tell apart: more for short waves.

        Args:
            frequencies: of the sea's components [rad/s].
            amplitudes: of them, which say how much each counts [m].

        Raises:
            InvalidInputError: the headings leave a gap.
        """
        gaps = np.diff(np.append(self.headings, self.headings[0] + 2.0 * math.pi))
        if gaps.max() > LARGEST_GAP + 1e-9:
            raise InvalidInputError(
                f"the headings leave a gap of {math.degrees(gaps.max()):.0f} degrees; give some every "
                f"{math.degrees(LARGEST_GAP):.0f} degrees all around, for a symmetric hull by mirrored()"
            )
        values = self.at(frequencies)
        counts = amplitudes[:, None, None]
        allowed = FOLLOWED * np.sqrt(np.mean(np.abs(counts * values) ** 2, axis=(0, 1)))
        found: list[ComplexArray] = [np.zeros((1, 2, 6), dtype=np.complex128)] * len(frequencies)
        wanted = np.ones(len(frequencies), dtype=np.bool_)
        for order in range(min(MOST_HARMONICS, (len(self.headings) - 1) // 2) + 1):
            at = np.flatnonzero(wanted)
            coefficients, missed = self._fitted(values[at], order)
            for j, of_component in zip(at, coefficients, strict=True):
                found[j] = of_component.reshape(order + 1, 2, 6)
            error = np.sqrt(np.mean(np.abs(counts[at] * missed) ** 2, axis=1))
            wanted[at] = np.any(error > allowed, axis=1)
        return found

    def _fitted(self, values: ComplexArray, order: int) -> tuple[ComplexArray, ComplexArray]:
        """Return the coefficients of series of an order, (j, 2 order + 2, 6), and what they miss of (j, m, 6)."""
        waves = [f(n * self.headings) for n in range(order + 1) for f in (np.cos, np.sin)]
        basis = np.stack(waves, axis=1)
        coefficients = np.einsum("cm,jmi->jci", np.linalg.pinv(basis), values)
        return coefficients, values - np.einsum("mc,jci->jmi", basis, coefficients)

    def term(self, sea: Sea) -> ForceTerm:
        """Return the first-order force of a sea."""
        return ForceTerm("waves", transferred_waves, _transfer(self, sea))


@functools.lru_cache(maxsize=1)
def _transfer(rao: ForceRAO, sea: Sea) -> WaveTransfer:
    """Return the parameters of the force; those of the last hull and sea are kept, for many vehicles of one hull."""
    series = rao.series(sea.frequencies, sea.amplitudes)
    scaled = [amplitude * one for amplitude, one in zip(sea.amplitudes, series, strict=True)]
    parts = [np.stack([one.real, one.imag], axis=2).ravel() for one in scaled]
    harmonics = table(np.array([float(len(one)) for one in series]))
    return WaveTransfer(sea.field, harmonics, table(np.concatenate(parts)))
