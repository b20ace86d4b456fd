"""Tracking by model predictive control: the best wrench over a horizon, within what the actuators can do.

In each control period the programme of `horizon_problem` is solved, with the vehicle's model linearised along the way
of the point for as long as that is shown, and the first wrench is given. Beyond the horizon the cost is that of LQR.
Where the solver finds no plan in time, the plan before goes on, a period later each time; once it is used up, or where
there is none, LQR acts. Both are counted.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.actuator_box import actuator_box
from dq_marine.agents.controllers.deviation import deviation_model, sampled
from dq_marine.agents.controllers.horizon_problem import HorizonProblem
from dq_marine.agents.controllers.lqr import Regulator
from dq_marine.agents.controllers.trajectory_control import Tracked, TrajectoryController
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import TrajectorySettings

Array = NDArray[np.float64]


class MPCController(TrajectoryController):
    """Plans over a horizon, within the actuators' limits.

    Attributes:
        unsolved: control periods since the controller was made in which the solver found no plan.
    """

    def __init__(self, env: gym.Env[Any, Any], settings: TrajectorySettings | None = None) -> None:
        """Prepare for an environment; see `TrajectoryController`."""
        super().__init__(env, settings)
        self.unsolved = 0
        self._box = actuator_box(self.vehicle, marine(env).scene.actuation)
        self._problem: HorizonProblem | None = None
        self._shares_left = np.zeros((0, len(self._box.low)))

    @property
    def periods(self) -> int:
        """Control periods of the horizon, at least one."""
        return max(1, int(self.settings.horizon / self.control_period + 1e-9))

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before, and what the solver kept of it."""
        super().reset(env)
        self._problem, self._shares_left = None, self._shares_left[:0]

    def _wrench(self, tracked: Tracked, found: Regulator) -> Array:
        if self._problem is None:
            self._problem = HorizonProblem(
                self.weights, found.cost, self._box, self.periods, iterations=self.settings.iterations
            )
        models = sampled(deviation_model(self.model, tracked.reference.velocity), self.control_period)
        plan = self._problem.solve(models, tracked.feedforward, tracked.deviation)
        if plan is None:
            self.unsolved += 1
            if not len(self._shares_left):
                regulated: Array = tracked.feedforward[0] - found.gain @ tracked.deviation
                return regulated
        else:
            self._shares_left = plan.shares
        first, self._shares_left = self._shares_left[0], self._shares_left[1:]
        wrench: Array = self._box.matrix @ first
        return wrench
