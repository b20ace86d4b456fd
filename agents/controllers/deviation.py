"""How a vehicle's deviation from a reference develops: the linear model that LQR and MPC share.

The deviation x = [e; phi; n] is, in the body frame, the place seen from the reference e, the rotation vector phi from
the reference's attitude, which is level, to the body's, and n = nu - nu_r. With the reference's velocity
nu_r = [v_r; w_r] and the wrench tau_r + u, of which tau_r keeps the vehicle on the reference, both in the body's axes,

    e' = n_1 - w_r x e,    phi' = n_2,    n' = M^-1 (F n + G phi + u) - [v_r x n_2; w_r x n_2],      (1)

to first order, with F and G the derivatives of the forces in `hydrodynamic_model` at the reference. The last term is
how the reference's velocity turns as the turning body sees it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.hydrodynamic_model import DOWN, HydrodynamicModel, cross_matrix
from dq_marine.util.extras import extra_needed

with extra_needed("tracking by LQR or MPC", "mpc"):
    from scipy.linalg import expm

Array = NDArray[np.float64]

STATES = 12
"""Components of a deviation: position, attitude, linear and angular velocity, three each."""


class LinearModel(NamedTuple):
    """x_next = A x + B u over a control period, or x' = A x + B u: shapes (..., 12, 12) and (..., 12, 6)."""

    state: Array
    wrench: Array


def deviation_model(model: HydrodynamicModel, reference_velocity: Array) -> LinearModel:
    """Return (1) in continuous time at reference velocities in Fossen's order [m/s, rad/s], shape (..., 6)."""
    leading = reference_velocity.shape[:-1]
    v, w = cross_matrix(reference_velocity[..., :3]), cross_matrix(reference_velocity[..., 3:])
    state = np.zeros((*leading, STATES, STATES))
    state[..., :3, :3] = -w
    state[..., :6, 6:] = np.eye(6)
    state[..., 6:, 3:6] = model.inverse_mass_matrix @ model.restoring_jacobian
    state[..., 6:, 6:] = model.inverse_mass_matrix @ model.jacobian(reference_velocity)
    state[..., 6:9, 9:] -= v
    state[..., 9:, 9:] -= w
    wrench = np.zeros((*leading, STATES, 6))
    wrench[..., 6:, :] = model.inverse_mass_matrix
    return LinearModel(state, wrench)


def sampled(continuous: LinearModel, period: float) -> LinearModel:
    """Return a model over a period [s] in which the wrench is held, exactly (Van Loan 1978, IEEE TAC 23, 395)."""
    size = STATES + 6
    joined = np.zeros((*continuous.state.shape[:-2], size, size))
    joined[..., :STATES, :STATES] = continuous.state
    joined[..., :STATES, STATES:] = continuous.wrench
    flow: Array = expm(period * joined)
    return LinearModel(flow[..., :STATES, :STATES], flow[..., :STATES, STATES:])


def reference_wrench(model: HydrodynamicModel, velocity: Array, acceleration: Array) -> Array:
    """Return tau_r without disturbance: what keeps a level vehicle on the reference, shape (..., 6) [N, N m].

    Args:
        model: of the vehicle.
        velocity: of the reference, shape (..., 6) [m/s, rad/s].
        acceleration: how fast its components change, shape (..., 6) [m/s^2, rad/s^2].
    """
    needed: Array = acceleration @ model.mass_matrix - model.wrench(velocity) - model.restoring(DOWN)
    return needed
