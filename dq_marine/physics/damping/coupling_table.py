"""Damping that couples axes: a force by one velocity times the magnitude of another."""

from __future__ import annotations

from collections.abc import Iterable
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.fields import Motion, Table


class DampingCoupling(Table):
    """One entry of the tensor of quadratic damping: the force is -coefficient |nu_speed| nu_velocity, or by nu_speed.

    Drag that couples axes has the velocity for its speed, as N_v|v|; lift of body and fins has the surge, as Y_uv,
    by |u|, so that the force is right astern too. What lift has for a moment astern turns over, for the end of the hull
    that sheds it is then the bow: it is signed, by u.

    Attributes:
        force: the axis that it acts in.
        speed: whose magnitude it grows with.
        velocity: that it is proportional to.
        signed: whether it grows with nu_speed itself, and turns over with it.
        coefficient: minus the published derivative, less what M gives already [N s^2/m^2, N s^2/m, N s^2, N m s^2].
    """

    force: Motion
    speed: Motion
    velocity: Motion
    signed: bool = False
    coefficient: float

    @property
    def name(self) -> str:
        """What it does, for reading."""
        speed = self.speed if self.signed else f"|{self.speed}|"
        return f"{self.force} by {speed} {self.velocity}"

    @property
    def indices(self) -> tuple[int, int, int]:
        """Force, velocity and speed as indices in Fossen's order."""
        motions = get_args(Motion)
        return motions.index(self.force), motions.index(self.velocity), motions.index(self.speed)


def coupling_tensor(couplings: Iterable[DampingCoupling]) -> NDArray[np.float64]:
    """Return c_ijk, by the axes of force, velocity and speed in Fossen's order, shape (6, 6, 6)."""
    tensor = np.zeros((6, 6, 6))
    for coupling in couplings:
        tensor[coupling.indices] += coupling.coefficient
    return tensor
