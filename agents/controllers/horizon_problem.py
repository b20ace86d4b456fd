"""The optimisation of a model predictive controller: a quadratic programme over a horizon, in a solver that is kept.

Over N control periods, with the deviations x_k, the actuators' shares s_k and the wrench u_k = E s_k - t_k beside the
feedforward t_k,

    minimise    sum over k = 1..N-1 of x_k^T Q x_k,  plus x_N^T P x_N,  plus sum over k = 0..N-1 of u_k^T R u_k
    subject to  x_{k+1} = A_k x_k + B_k u_k,    low <= s_k <= high.                                   (1)

Without bounds, and with P of the Riccati equation of the same A and B, u_0 is that of the regulator in `lqr` (Rawlings,
Mayne and Diehl 2017, Model Predictive Control, sec. 1.3). The programme is sparse, in [x_1 .. x_N, s_0 .. s_{N-1}], and
what changes from one period to the next is numbers alone: OSQP (Stellato et al. 2020, Math. Program. Comput. 12, 637)
is set up once and updated. Shares always exist, so that there is always a solution. Deviations are counted in those
that weigh 1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.actuator_box import ActuatorBox
from dq_marine.agents.controllers.deviation import STATES, LinearModel
from dq_marine.agents.controllers.lqr import Weights
from dq_marine.checks import finite_array, finite_number, finite_rows, positive_integer
from dq_marine.util.extras import extra_needed

with extra_needed("tracking by MPC", "mpc"):
    import osqp
    from scipy import sparse

Array = NDArray[np.float64]

TOLERANCE = 1e-4
"""Of the solver, in deviations that weigh 1 and in shares."""

RHO_INTERVAL, CHECK_INTERVAL = 25, 5
"""Iterations between changes of the solver's step, lest it go by the clock, and between its looks at the end."""

SPARING = 1e-6
"""Weight of shares over that of the wrench: among shares that make one wrench, the smaller."""


class Plan(NamedTuple):
    """Deviations and shares of actuators over a horizon, shapes (N, 12) and (N, n), and the solver's iterations."""

    deviations: Array
    shares: Array
    iterations: int


class HorizonProblem:
    """The programme (1) for one vehicle, one horizon and one P."""

    def __init__(
        self,
        weights: Weights,
        terminal_cost: Array,
        box: ActuatorBox,
        periods: int,
        *,
        iterations: int = 4000,
        tolerance: float = TOLERANCE,
    ) -> None:
        """Prepare the programme; the solver is set up when it is first solved.

        Args:
            weights: Q and R.
            terminal_cost: P, shape (12, 12).
            box: of the actuators.
            periods: N, at least 1.
            iterations: of the solver, at most.
            tolerance: of the solver.

        Raises:
            InvalidInputError: `periods` or `iterations` is no integer of at least 1, or the tolerance not above 0.
        """
        self.periods = positive_integer("periods", periods)
        self._iterations = positive_integer("iterations", iterations)
        self._tolerance = finite_number("tolerance", tolerance, above=0.0)
        self._weights, self._box = weights, box
        self._count = len(box.low)
        self._scale = weights.state**-0.5
        self._cost = self._cost_matrix(terminal_cost)
        self._pattern, self._order = self._constraint_pattern()
        self._solver: osqp.OSQP | None = None

    def solve(self, models: LinearModel, feedforward: Array, deviation: Array) -> Plan | None:
        """Return the best plan, or None where the solver finds none within its iterations.

        Args:
            models: A_k and B_k, shapes (N, 12, 12) and (N, 12, 6).
            feedforward: t_k, shape (N, 6) [N, N m].
            deviation: x_0, shape (12,).

        Raises:
            InvalidInputError: feedforward or deviation is of another shape, or not finite.
        """
        feedforward = finite_rows("feedforward", feedforward, self.periods, 6)
        deviation = finite_array("deviation", deviation, STATES)
        states = models.state * self._scale / self._scale[:, None]
        wrenches = models.wrench / self._scale[:, None]
        values = np.concatenate(
            [
                np.ones(self.periods * STATES),
                -states[1:].ravel(),
                -(wrenches @ self._box.matrix).ravel(),
                np.ones(self.periods * self._count),
            ]
        )[self._order]
        moved = -(wrenches @ feedforward[..., None])[..., 0]
        moved[0] += states[0] @ (deviation / self._scale)
        linear = -(feedforward * self._weights.wrench) @ self._box.matrix
        cost = np.concatenate([np.zeros(self.periods * STATES), linear.ravel()])
        low = np.concatenate([moved.ravel(), np.tile(self._box.low, self.periods)])
        high = np.concatenate([moved.ravel(), np.tile(self._box.high, self.periods)])
        return self._plan(values, cost, low, high)

    def _plan(self, values: Array, cost: Array, low: Array, high: Array) -> Plan | None:
        """Update the solver, or set it up, and return what it finds."""
        if self._solver is None:
            self._pattern.data = values
            self._solver = osqp.OSQP()
            self._solver.setup(
                self._cost,
                cost,
                self._pattern,
                low,
                high,
                verbose=False,
                eps_abs=self._tolerance,
                eps_rel=self._tolerance,
                max_iter=self._iterations,
                check_termination=CHECK_INTERVAL,
                adaptive_rho_interval=RHO_INTERVAL,
            )
        else:
            self._solver.update(q=cost, l=low, u=high, Ax=values)
        found = self._solver.solve(raise_error=False)
        solved = found.info.status_val == osqp.SolverStatus.OSQP_SOLVED and np.isfinite(found.x).all()
        if not solved:
            self._solver = None  # its next solve would begin where this one went
            return None
        split = self.periods * STATES
        self._warm_start(found.x, split)
        deviations = found.x[:split].reshape(self.periods, STATES) * self._scale
        shares = np.clip(found.x[split:].reshape(self.periods, -1), self._box.low, self._box.high)
        return Plan(deviations, shares, int(found.info.iter))

    def _warm_start(self, solution: Array, split: int) -> None:
        """Let the next solve begin with this plan, a period on, whose last period lasts."""
        kept = [
            np.concatenate([part[size:], part[-size:]])
            for part, size in ((solution[:split], STATES), (solution[split:], self._count))
        ]
        if self._solver is not None:
            self._solver.warm_start(x=np.concatenate(kept))

    def _cost_matrix(self, terminal_cost: Array) -> sparse.csc_matrix:
        """Return the upper triangle of the Hessian."""
        terminal = self._scale[:, None] * terminal_cost * self._scale
        matrix, weight = self._box.matrix, self._weights.wrench
        shares = matrix.T @ (weight[:, None] * matrix)
        shares += SPARING * float(np.diag(shares).max()) * np.eye(self._count)
        blocks = [sparse.eye(STATES)] * (self.periods - 1) + [terminal] + [shares] * self.periods
        return sparse.triu(sparse.block_diag(blocks), format="csc")

    def _constraint_pattern(self) -> tuple[sparse.csc_matrix, NDArray[np.intp]]:
        """Return the constraints' matrix with room for its numbers, and the order in which it takes them."""
        n, m, count = self.periods, STATES, self._count
        rows_x, columns_x = _blocks(range(1, n), range(n - 1), m, m)
        rows_s, columns_s = _blocks(range(n), range(n), m, count)
        of_states, of_shares = np.arange(n * m), n * m + np.arange(n * count)
        rows = np.concatenate([of_states, rows_x, rows_s, of_shares])
        columns = np.concatenate([of_states, columns_x, n * m + columns_s, of_shares])
        numbered = sparse.csc_matrix((np.arange(1.0, len(rows) + 1.0), (rows, columns)))
        return numbered, numbered.data.astype(np.intp) - 1


def _blocks(
    rows: range, columns: range, height: int, width: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return row and column of each number of full blocks, one after the other, each row by row."""
    top, left = height * np.array(rows, dtype=np.intp), width * np.array(columns, dtype=np.intp)
    shape = (len(top), height, width)
    down, across = np.arange(height)[None, :, None], np.arange(width)[None, None, :]
    return (
        np.broadcast_to(top[:, None, None] + down, shape).ravel(),
        np.broadcast_to(left[:, None, None] + across, shape).ravel(),
    )
