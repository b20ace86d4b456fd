"""Radiation of a hull as sections of oscillators: a state space model of its added mass and damping by frequency.

In one plane of motions, with the sections' oscillators side by side,

    H(s) = s G^T (s^2 + s D + W^2)^-1 G,    H(j w) = B(w) + j w (A(w) - A_inf)                          (M5)

W is diagonal and positive, D symmetric, positive semidefinite and in blocks of sections, G real. Whatever the numbers
are, H is stable and passive, H(0) = 0, and its kernel K(t) starts with G^T G: what Perez and Fossen (2009) ask of such
models holds by construction, here of the matrix.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.integrator.fluid_memory import LATERAL, VERTICAL, Plane

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PLANE_NAMES = {VERTICAL: "surge, heave and pitch", LATERAL: "sway, roll and yaw"}


class SectionModel(NamedTuple):
    """A section of three oscillators.

    Attributes:
        plane: of the motions that it answers.
        frequencies: diagonal of W, shape (3,) [rad/s].
        damping: D, shape (3, 3) [rad/s].
        gain: G, by oscillator and motion of the plane, shape (3, 3) [kg^(1/2)/s, with m for rotations].
    """

    plane: Plane
    frequencies: Array
    damping: Array
    gain: Array

    def transfer(self, omega: Array) -> ComplexArray:
        """Return H(j w) at frequencies of shape (n,) [rad/s], shape (n, 3, 3)."""
        s = 1j * omega[:, None, None]
        stiff = s * s * np.eye(3) + s * self.damping + np.diag(self.frequencies**2)
        return np.asarray(s * (self.gain.T @ np.linalg.solve(stiff, self.gain + 0.0j)), dtype=np.complex128)

    @property
    def dynamics(self) -> Array:
        """The matrix of (M3) for x = (a, r), shape (6, 6)."""
        w = np.diag(self.frequencies)
        return np.block([[np.zeros((3, 3)), w], [-w, -self.damping]])


class Quality(NamedTuple):
    """How well a model reproduces its table in one plane.

    Both are root mean squares over the table's frequencies and the plane's motions, these scaled to the same largest
    damping, over the same of the table's.

    Attributes:
        damping: error of B.
        added_mass: error of w A, of the force that added mass makes.
    """

    damping: float
    added_mass: float


@dataclass(frozen=True)
class RadiationModel:
    """What was identified of a hull's radiation.

    Attributes:
        sections: their models.
        added_mass: A_inf that goes with them, symmetric, in Fossen's order, shape (6, 6) [kg, kg m, kg m^2].
        published: A_inf that came with the table, likewise.
        quality: of the fit, by plane.
    """

    sections: tuple[SectionModel, ...]
    added_mass: Array
    published: Array
    quality: dict[Plane, Quality]

    @property
    def planes(self) -> tuple[Plane, ...]:
        """Of each section."""
        return tuple(section.plane for section in self.sections)

    @property
    def shift(self) -> Array:
        """What the identified A_inf has more than the published one, shape (6, 6)."""
        return self.added_mass - self.published

    def summary(self) -> tuple[str, ...]:
        """Return how many states the model has and how well it fits, each plane for reading."""
        return tuple(
            f"{PLANE_NAMES[plane]}: {6 * self.planes.count(plane)} states, damping to {quality.damping:.1%}, "
            f"added mass to {quality.added_mass:.1%}"
            for plane, quality in self.quality.items()
        )

    def transfer(self, omega: Array) -> ComplexArray:
        """Return H(j w) at frequencies of shape (n,) [rad/s], in Fossen's order, shape (n, 6, 6)."""
        total = np.zeros((omega.size, 6, 6), dtype=np.complex128)
        for section in self.sections:
            total[np.ix_(range(omega.size), section.plane.motions, section.plane.motions)] += (
                section.transfer(omega)
            )
        return total

    def damping_at(self, omega: Array) -> Array:
        """Return B at frequencies, shape (n, 6, 6)."""
        return self.transfer(omega).real

    def added_mass_at(self, omega: Array) -> Array:
        """Return A at positive frequencies, shape (n, 6, 6)."""
        return np.asarray(self.added_mass + self.transfer(omega).imag / omega[:, None, None])
