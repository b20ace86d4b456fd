"""Damping that couples axes: a force by one velocity times the magnitude of another."""

from __future__ import annotations

from collections.abc import Iterable
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.fields import Motion, Table


class DampingCoupling(Table):
    """One entry of the tensor of quadratic damping: the force is -coefficient |nu_speed| nu_velocity.

    Drag that couples axes has the velocity for its speed, as N_v|v|; lift of body and fins has the surge, as Y_uv,
    by |u|, so that the force is right astern too.

    Attributes:
        force: the axis that it acts in.
        speed: whose magnitude it grows with.
        velocity: that it is proportional to.
        coefficient: minus the published derivative, less what M gives already [N s^2/m^2, N s^2/m, N s^2, N m s^2].
    """

    force: Motion
    speed: Motion
    velocity: Motion
    coefficient: float

    @property
    def indices(self) -> tuple[int, int, int]:
        """Force, velocity and speed as indices in Fossen's order."""
        motions = get_args(Motion)
        return motions.index(self.force), motions.index(self.velocity), motions.index(self.speed)


def coupling_tensor(couplings: Iterable[DampingCoupling]) -> NDArray[np.float64]:
    """Return c with the force -sum_jk c_ijk |nu_k| nu_j on axis i, Fossen's order, shape (6, 6, 6)."""
    tensor = np.zeros((6, 6, 6))
    for coupling in couplings:
        tensor[coupling.indices] += coupling.coefficient
    return tensor
