"""A small motion that restores the energy which a step should have kept."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.selection import by_precision, smallest_normal
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.integrator.gauss_stages import weighted_square
from dq_marine.integrator.increment import Increment

STEADY = 1e-8
"""Of the energy's square: below this the square of the momentum's rate counts as zero."""


FAR_FROM_LEVEL = 1e-8
"""Of the energy: one step of Newton's method leaves less than the square of such an excess."""

FAR_FROM_LEVEL_SINGLE = 1e-5
"""`FAR_FROM_LEVEL` where numbers have single precision."""

MOST_LEVELLINGS = 4
"""Steps of Newton's method to an energy level, at the most."""


class Nearer(NamedTuple):
    """An increment nearer to an energy level, the excess of energy before, and the energy it is compared with."""

    increment: Increment
    excess: float
    energy: float


def is_far_from_level(nearer: Nearer) -> bool:
    """Whether one more step of Newton's method is needed."""
    far = by_precision(nearer.energy, FAR_FROM_LEVEL, FAR_FROM_LEVEL_SINGLE)
    return abs(nearer.excess) > far * nearer.energy


def levelling(length_squared: float, rate: Spatial, excess: float, energy: float) -> Spatial:
    """Return the smallest turn and shift delta of the body frame that take away an excess of energy (G10).

    A motion delta that carries the momentum along changes the energy by -rate . delta, where rate is that of the
    momentum, forces included. Where the momentum hardly changes, energy hardly depends on delta, and round-off counts
    more than what is to be corrected.

    Args:
        length_squared: how turns and shifts compare [m^2].
        rate: of the momentum.
        excess: of energy.
        energy: what round-off is compared with.
    """
    steepness = weighted_square(length_squared, rate) + STEADY * energy * energy + smallest_normal(energy)
    gain = excess / steepness
    return Spatial(scale(gain, rate.angular), scale(gain * length_squared, rate.linear))
