"""The linear quadratic regulator of a deviation in discrete time, with weights by Bryson's rule.

The wrench u_k = -K x_k makes the sum of x^T Q x + u^T R u least over all time, for x_next = A x + B u. K follows from
P, the stabilising solution of the discrete algebraic Riccati equation,

    P = A^T P A - A^T P B (R + B^T P B)^-1 B^T P A + Q,    K = (R + B^T P B)^-1 B^T P A,              (1)

and x^T P x is what the least sum comes to. Bryson's rule: a weight is one over the square of a deviation that is as bad
as any other (Bryson and Ho 1975, Applied Optimal Control, sec. 5.2).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.deviation import LinearModel
from dq_marine.agents.settings import TrajectorySettings
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed
from dq_marine.vehicles import Vehicle

with extra_needed("tracking by LQR or MPC", "mpc"):
    from scipy.linalg import solve_discrete_are

Array = NDArray[np.float64]


class Weights(NamedTuple):
    """The diagonals of Q, shape (12,), and of R, shape (6,), which is 0 for axes that nothing drives."""

    state: Array
    wrench: Array


class Regulator(NamedTuple):
    """K of (1), shape (6, 12), with rows of zeros for axes that nothing drives, and P, shape (12, 12)."""

    gain: Array
    cost: Array


def bryson_weights(settings: TrajectorySettings, vehicle: Vehicle) -> Weights:
    """Return the weights that deviations which count the same lead to."""
    worst = (settings.position, settings.attitude, settings.linear_velocity, settings.angular_velocity)
    most = settings.effort * vehicle.wrench_limits
    driven = most > 0.0
    return Weights(
        np.repeat(np.array(worst), 3) ** -2.0,
        np.where(driven, np.where(driven, most, 1.0) ** -2.0, 0.0),
    )


def regulator(model: LinearModel, weights: Weights) -> Regulator:
    """Return the regulator (1) of a sampled model, whose wrench acts on the axes with a weight.

    Args:
        model: A of shape (12, 12), B of shape (12, 6).
        weights: of deviations and wrench.

    Raises:
        InvalidInputError: no wrench on these axes stabilises the model.
    """
    driven = np.flatnonzero(weights.wrench)
    a, b = model.state, model.wrench[:, driven]
    q, r = np.diag(weights.state), np.diag(weights.wrench[driven])
    try:
        cost: Array = solve_discrete_are(a, b, q, r)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InvalidInputError(
            f"the Riccati equation has no stabilising solution with the driven axes {driven.tolist()} ({error}); "
            "give a vehicle that these hold, or a shorter control period"
        ) from error
    gain = np.zeros((6, a.shape[0]))
    gain[driven] = np.linalg.solve(r + b.T @ cost @ b, b.T @ cost @ a)
    return Regulator(gain, cost)
