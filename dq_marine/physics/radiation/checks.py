"""Whether a table by frequency can be made a state space model of."""

from __future__ import annotations

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.integrator.fluid_memory import LATERAL, VERTICAL, Plane
from dq_marine.physics.radiation.model import PLANE_NAMES, Array
from dq_marine.physics.waves.radiation import RadiationTable

FEWEST = 8
"""Frequencies that a fit needs."""

MOST_NEGATIVE = 0.02
"""Damping's least eigenvalue may be below zero by this share of its largest: strip theory is not quite symmetric."""

MOST_ACROSS = 0.02
"""Coupling of the planes that a hull which is the same to port and starboard does not have, over the damping."""

MOST_AT_END = 0.95
"""Damping at the last frequency over the largest: beyond, the table ends before it falls."""


def checked_plane(table: RadiationTable, plane: Plane) -> tuple[Array, Array, Array]:
    """Return the frequencies, damping and added mass of a plane's motions, the matrices made symmetric.

    Raises:
        InvalidInputError: they cannot be used.
    """
    omega = np.array(table.frequencies)
    if omega.size < FEWEST:
        raise InvalidInputError(
            f"the radiation table has {omega.size} frequencies; radiation memory needs at least {FEWEST}. Solve for "
            'more of them, or give radiation="constant"'
        )
    b, a = (np.array(part) for part in (table.damping, table.added_mass))
    b, a = 0.5 * (b + b.transpose(0, 2, 1)), 0.5 * (a + a.transpose(0, 2, 1))
    _check_symmetry(b)
    cut = np.ix_(range(omega.size), plane.motions, plane.motions)
    b, a = b[cut], a[cut]
    _check_damping(omega, b, PLANE_NAMES[plane])
    return omega, b, a


def unit_free(b: Array) -> Array:
    """Return matrices with every motion scaled to a largest damping of 1; motions without damping as they are."""
    largest = np.sqrt(np.abs(np.diagonal(b, axis1=1, axis2=2)).max(axis=0))
    scale = np.where(largest > 0.0, largest, 1.0)
    return np.asarray(b / np.outer(scale, scale))


def _check_symmetry(b: Array) -> None:
    across = float(np.abs(unit_free(b)[:, VERTICAL.motions][:, :, LATERAL.motions]).max())
    if across > MOST_ACROSS:
        raise InvalidInputError(
            f"the radiation table couples surge, heave or pitch to sway, roll or yaw by {across:.2g} of their damping, "
            f"more than {MOST_ACROSS:g}; radiation memory is for hulls that are the same to port and starboard. Give "
            'radiation="constant"'
        )


def _check_damping(omega: Array, b: Array, name: str) -> None:
    free = unit_free(b)
    eigenvalues = np.linalg.eigvalsh(free)
    least, largest = eigenvalues.min(axis=1), float(eigenvalues.max())
    worst = int(least.argmin())
    if least[worst] < -MOST_NEGATIVE * largest:
        raise InvalidInputError(
            f"the radiation table's damping in {name} is negative at {omega[worst]:.4g} rad/s: its least eigenvalue is "
            f"{least[worst] / largest:.2g} of its largest, and waves only take energy. Mend the table, or give "
            'radiation="constant"'
        )
    powers = np.trace(free, axis1=1, axis2=2)
    if powers[-1] > MOST_AT_END * powers.max() > 0.0:
        raise InvalidInputError(
            f"the radiation table's damping in {name} has not fallen at its last frequency, {omega[-1]:.4g} rad/s: it "
            f"is {powers[-1] / powers.max():.2g} of its largest, and must be below {MOST_AT_END:g}. Solve for higher "
            'ones, or give radiation="constant"'
        )
