"""Added mass and wave radiation damping of a hull afloat at the frequencies that its motions have."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.potential_flow import PotentialFlow
from dq_marine.meshes.rounding import rounded
from dq_marine.meshes.surface import Array, area_vectors
from dq_marine.physics.fields import MOTIONS

PANELS_PER_WAVE = 8.0
"""The shortest wave is so many panels long."""

LONGEST_WAVE = 20.0
"""Over the hull's length."""

NEGATIVE = 0.02
"""A damping below 0 by more than this part of its largest is no round-off."""

ITERATIONS = 50


@dataclass(frozen=True, eq=False)
class Radiated:
    """Coefficients by frequency.

    Attributes:
        table: entries of `RadiationTable`.
        at_natural_frequencies: damping of heave, roll and pitch, each at its own natural frequency; 0 elsewhere, (6,).
    """

    table: dict[str, Any]
    at_natural_frequencies: Array

    def rows(self) -> list[dict[str, Any]]:
        """Return the lines of the CSV file that `read_radiation` reads."""
        return [
            {
                "frequency": omega,
                "force": MOTIONS[i],
                "motion": MOTIONS[j],
                "added_mass": self.table["added_mass"][n][i][j],
                "damping": self.table["damping"][n][i][j],
            }
            for n, omega in enumerate(self.table["frequencies"])
            for i in range(6)
            for j in range(6)
            if self.table["added_mass"][n][i][j] or self.table["damping"][n][i][j]
        ]


def radiated(flow: PotentialFlow, count: int, rigid_body_matrix: Array, stiffness: Array) -> Radiated:
    """Return what a hull's motions radiate.

    Args:
        flow: of a hull afloat.
        count: of frequencies.
        rigid_body_matrix: M_RB about the body origin, shape (6, 6).
        stiffness: of heave, roll and pitch, shape (3, 3).

    Raises:
        InvalidInputError: the solver gives a damping that feeds energy in.
    """
    frequencies = rounded(_frequencies(flow, count))
    added, damping = flow.by_frequency(frequencies)
    diagonals = np.einsum("nii->ni", damping)
    largest = diagonals.max(axis=0)
    wrong = diagonals < -NEGATIVE * np.maximum(largest, 0.0)
    if wrong.any():
        n, i = np.argwhere(wrong)[0]
        raise InvalidInputError(
            f"the solver gives a damping of {diagonals[n, i]:.4g} in {MOTIONS[i]} at {frequencies[n]:.4g} rad/s, "
            "which feeds energy in; give more --panels, or mend the mesh where it is thin"
        )
    natural = np.zeros(6)
    for axis in (2, 3, 4):
        omega = _natural_frequency(
            frequencies, added[:, axis, axis], rigid_body_matrix[axis, axis], stiffness[axis - 2, axis - 2]
        )
        natural[axis] = np.interp(omega, frequencies, diagonals[:, axis])
    table = {"frequencies": frequencies, "added_mass": rounded(added), "damping": rounded(damping)}
    return Radiated(table, natural)


def _frequencies(flow: PotentialFlow, count: int) -> Array:
    """Return frequencies in even ratios, from waves much longer than the hull to those that the panels can tell."""
    areas = np.linalg.norm(area_vectors(flow.panels), axis=1)
    shortest = PANELS_PER_WAVE * math.sqrt(2.0 * float(areas.mean()))
    longest = LONGEST_WAVE * float(np.ptp(flow.panels[..., 0]))
    low, high = (math.sqrt(2.0 * math.pi * flow.gravity / wave) for wave in (longest, shortest))
    return np.geomspace(low, high, count)


def _natural_frequency(frequencies: list[float], added: Array, mass: float, stiffness: float) -> float:
    """Return omega with omega^2 (m + A(omega)) = C, by iteration."""
    omega = math.sqrt(stiffness / (mass + float(added[-1])))
    for _ in range(ITERATIONS):
        omega = math.sqrt(stiffness / (mass + float(np.interp(omega, frequencies, added))))
    return omega
