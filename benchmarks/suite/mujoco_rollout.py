"""MuJoCo's other way to advance many simulations: `mujoco.rollout`, which returns every state on the way."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from mujoco_baseline import Array, MujocoBaseline


def rollout_exists() -> bool:
    """Whether the installed MuJoCo has it."""
    return find_spec("mujoco.rollout") is not None


class MujocoRollout:
    """A baseline's bodies, from where they are, under the forces that they have now.

    Arrays are allocated once and MuJoCo's checks are left out, to be as fast as it can.

    Args:
        baseline: whose model, state and forces are taken over.
        threads: that advance them; with one, it is the caller's.
        steps: of each call.
    """

    def __init__(self, baseline: MujocoBaseline, threads: int, steps: int) -> None:
        from mujoco import MjData, mj_stateSize, mjtState
        from mujoco.rollout import Rollout

        models, each = baseline.bodies // baseline.bodies_per_model, baseline.bodies_per_model
        self.bodies, self.bodies_per_model = baseline.bodies, each
        self._models = [baseline.model] * models
        self._data = [MjData(baseline.model) for _ in range(threads)]
        times, poses, velocities = (
            np.zeros((models, 1)),
            baseline.poses.reshape(models, 7 * each),
            baseline.velocities.reshape(models, 6 * each),
        )
        self._start = np.hstack([times, poses, velocities])
        self._forces = np.repeat(baseline.forces.reshape(models, 1, 6 * each), steps, axis=1)
        self._held = int(mjtState.mjSTATE_QFRC_APPLIED)
        self._states = np.empty((models, steps, mj_stateSize(baseline.model, mjtState.mjSTATE_FULLPHYSICS)))
        self._sensors = np.empty((models, steps, 0))
        if self._states.shape[2] != self._start.shape[1]:
            raise RuntimeError(
                f"MuJoCo's state has {self._states.shape[2]} numbers, not {self._start.shape[1]}"
            )
        self._rollout = Rollout(nthread=threads if threads > 1 else 0)

    @property
    def velocities(self) -> Array:
        """Velocity of the centre of buoyancy, NED, and angular velocity, body [m/s, rad/s], shape (bodies, 6)."""
        return self._start[:, -6 * self.bodies_per_model :].reshape(self.bodies, 6).copy()

    def advance(self) -> None:
        """Take the steps with all bodies."""
        self._rollout.rollout(
            self._models,
            self._data,
            self._start,
            self._forces,
            control_spec=self._held,
            skip_checks=True,
            nstep=self._states.shape[1],
            state=self._states,
            sensordata=self._sensors,
        )
        self._start[...] = self._states[:, -1]

    def close(self) -> None:
        """End the threads."""
        self._rollout.close()
