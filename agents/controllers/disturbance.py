"""What acts on a vehicle besides its model, estimated: the integral action of controllers that have a model.

Over a control period T the wrench that the model lacks was, at the mean of the velocities before and after,

    d = M (nu_next - nu) / T - f(nu_mean) - g(down_mean) - tau,                                       (1)

and the estimate follows it as a first-order lag. A controller that cancels the estimate leaves no offset, as one with
an integral of the error does not (Muske and Badgwell 2002, Disturbance modeling for offset-free linear model predictive
control, J. Process Control 12, 617). A saturated actuator does not wind it up, for tau is the wrench that was given.
It is kept in axes that do not turn with the vehicle, as the force of a current does not.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.hydrodynamic_model import HydrodynamicModel
from dq_marine.agents.controllers.reading import Reading
from dq_marine.agents.controllers.rotation import both_halves

Array = NDArray[np.float64]


class DisturbanceObserver:
    """The estimate (1), in the axes of a level goal."""

    def __init__(self, model: HydrodynamicModel, period: float, time_constant: float) -> None:
        """Take the vehicle's model, the control period [s] and the lag [s]."""
        self._model, self._period = model, period
        self._share = -math.expm1(-period / time_constant)
        self.reset()

    def reset(self) -> None:
        """Forget the episode before."""
        self._estimate_in_goal = np.zeros(6)
        self._before: tuple[Reading, Array] | None = None

    @property
    def estimate_in_goal(self) -> Array:
        """The disturbance in the goal's axes now, Fossen's order, shape (6,) [N, N m]."""
        return self._estimate_in_goal.copy()

    def ahead(self, turns: Array) -> Array:
        """Return the estimate in the goal's axes once these have turned by angles [rad], (n,), shape (n, 6)."""
        return _turned_back(self._estimate_in_goal, turns)

    def given(self, reading: Reading, wrench_body: Array) -> None:
        """Keep what the vehicle is given in the period that begins at a reading, shape (6,) [N, N m]."""
        self._before = reading, wrench_body

    def observe(self, reading: Reading) -> None:
        """Advance the estimate to a reading, a control period after the one before."""
        if self._before is None:
            return
        before, wrench = self._before
        turn = self._period * reading.goal_velocity_body[3:] @ reading.goal_to_body[:, 2]
        kept = _turned_back(self._estimate_in_goal, np.array([turn]))[0]
        velocity = 0.5 * (before.velocity_body + reading.velocity_body)
        down = 0.5 * (before.goal_to_body[:, 2] + reading.goal_to_body[:, 2])
        change = (reading.velocity_body - before.velocity_body) / self._period
        model = self._model
        lacking = model.mass_matrix @ change - model.wrench(velocity) - model.restoring(down) - wrench
        seen = both_halves(reading.goal_to_body.T, lacking)
        self._estimate_in_goal = kept + self._share * (seen - kept)


def _turned_back(vector: Array, angles: Array) -> Array:
    """Return a 6-vector in axes that have turned about z by angles [rad], (n,), shape (n, 6)."""
    c, s = np.cos(angles), np.sin(angles)
    turned = np.empty((len(angles), 6))
    for first in (0, 3):
        x, y, z = vector[first : first + 3].tolist()
        turned[:, first], turned[:, first + 1], turned[:, first + 2] = c * x + s * y, c * y - s * x, z
    return turned
