"""The infos of a vector environment, merged as Gymnasium merges those of single environments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.envs.lane_memory import COMPLETED, RESIDUAL_SQUARED, SPEED_SQUARED, SPIN_SQUARED, STATUS
from dq_marine.envs.lane_singles import LaneSingles
from dq_marine.envs.refusal import integration_report

if TYPE_CHECKING:
    from dq_marine.envs.vector_env import DQMarineVectorEnv

Flags = NDArray[np.bool_]

REPORTED = (STATUS, COMPLETED, RESIDUAL_SQUARED, SPIN_SQUARED, SPEED_SQUARED)
"""Fields of an outcome that a report of a refusal is made of."""


class VectorInfos:
    """Makes the infos of `reset` and `step` from the memory of all environments.

    Attributes:
        episodes_refused: episodes so far that ended because the integrator refused a step.
    """

    def __init__(self, envs: DQMarineVectorEnv, lanes: LaneSingles) -> None:
        self._envs = envs
        self._lanes = lanes
        self._everywhere = np.ones(lanes.n, np.bool_)
        self.episodes_refused = 0

    def at_reset(self, wanted: Flags) -> dict[str, Any]:
        """Return the infos of environments that were reset."""
        return self._measured(wanted) | self._beginnings(wanted)

    def at_step(self, waiting: Flags, ended: Flags) -> dict[str, Any]:
        """Return a step's infos.

        Args:
            waiting: environments whose episode had ended before, and that were reset where the mode is NEXT_STEP.
            ended: environments whose episode ended in this step.
        """
        infos = self._measured(self._everywhere)
        if self._envs.autoreset_mode is not AutoresetMode.SAME_STEP:
            return self._with_refusals(infos) | self._beginnings(waiting)
        if not ended.any():
            return infos
        observations = np.full(self._lanes.n, None, dtype=object)
        for index in np.flatnonzero(ended).tolist():
            observations[index] = self._lanes.memory.arrays.final_observations[index].copy()
        final = self._with_refusals(self._measured(ended, final=True))
        infos |= {"final_obs": observations, "_final_obs": ended.copy()}
        infos |= {"final_info": final, "_final_info": ended.copy()}
        return infos | self._beginnings(ended)

    def _measured(self, where: Flags, *, final: bool = False) -> dict[str, Any]:
        """Return the measures and the success of some environments, with masks."""
        arrays, single = self._lanes.memory.arrays, self._lanes.first
        rows = (arrays.final_measures if final else arrays.measures)[:, : self._lanes.n]
        whole = where is self._everywhere
        measures = {
            name: self._given(row) if whole else np.where(where, row, 0.0)
            for name, row in zip(single.task.measure_names, rows, strict=True)
        }
        infos = measures | {"is_success": single.succeeds(measures) & where}
        return infos | {f"_{name}": self._given(where) for name in infos}

    def _beginnings(self, where: Flags) -> dict[str, Any]:
        """Return the currents and drawn vehicles of newly begun episodes, nothing if there is none."""
        if not where.any():
            return {}
        arrays, n = self._lanes.memory.arrays, self._lanes.n
        currents = np.where(where[:, None], arrays.drawn_currents[:n], 0.0)
        infos = {"current_ned": currents, "_current_ned": where.copy()}
        if self._lanes.first.pool.has_choice:
            vehicles = np.where(where, arrays.vehicles[:n], 0.0).astype(np.int64)
            infos |= {"vehicle": vehicles, "_vehicle": where.copy()}
        return infos

    def _with_refusals(self, infos: dict[str, Any]) -> dict[str, Any]:
        """Add why the integrator refused, where it did."""
        status = self._lanes.memory.outcome(STATUS)
        refused = np.flatnonzero(status)
        if not refused.size:
            return infos
        self.episodes_refused += len(refused)
        outcomes = np.stack([self._lanes.memory.outcome(field)[refused] for field in REPORTED], axis=1)
        for index, (why, completed, *squares) in zip(refused.tolist(), outcomes.tolist(), strict=True):
            report = integration_report(self._lanes.first.scene.step, int(why), int(completed), *squares)
            infos = self._envs._add_info(infos, {"integration": report}, index)
        return infos

    def _given(self, array: NDArray[Any]) -> NDArray[Any]:
        return array.copy() if self._envs.copy else array
