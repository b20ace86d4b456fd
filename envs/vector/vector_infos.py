"""The infos of a vector environment, merged as Gymnasium merges those of single environments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.envs.core.observation import in_parts
from dq_marine.envs.core.refusal import integration_report
from dq_marine.envs.vector.lane_memory import COMPLETED, RESIDUAL_SQUARED, SPEED_SQUARED, SPIN_SQUARED, STATUS
from dq_marine.envs.vector.lane_singles import LaneSingles

if TYPE_CHECKING:
    from dq_marine.envs.vector.vector_env import MarineVectorEnv

Flags = NDArray[np.bool_]

REPORTED = (STATUS, COMPLETED, RESIDUAL_SQUARED, SPIN_SQUARED, SPEED_SQUARED)
"""Fields of an outcome that a report of a refusal is made of."""


class VectorInfos:
    """Makes the infos of `reset` and `step` from the memory of all environments.

    Attributes:
        episodes_refused: episodes so far that ended because the integrator refused a step.
        refusals: why it refused the last step, by the index of the environment.
    """

    def __init__(self, envs: MarineVectorEnv, lanes: LaneSingles) -> None:
        self._envs = envs
        self._lanes = lanes
        self._everywhere = np.ones(lanes.n, np.bool_)
        self._none_refused = np.zeros(lanes.n, np.bool_)
        self._flown = np.zeros(lanes.n)
        self.episodes_refused = 0
        self.refusals: dict[int, dict[str, Any]] = {}

    def before_step(self) -> None:
        """Keep which vehicles fly now: an episode that ends may be followed by one with another."""
        if self._has_vehicles:
            self._flown = self._lanes.memory.arrays.vehicles[: self._lanes.n].copy()

    def at_reset(self, wanted: Flags) -> dict[str, Any]:
        """Return the infos of environments that were reset."""
        self.refusals = {}
        return self._reported(wanted, self._none_refused)

    def at_step(self, ended: Flags) -> dict[str, Any]:
        """Return a step's infos.

        Args:
            ended: environments whose episode ended in this step.
        """
        refused = self._refused()
        if self._envs.autoreset_mode is not AutoresetMode.SAME_STEP:
            return self._reported(self._everywhere, refused)
        infos = self._reported(self._everywhere, self._none_refused)
        if not ended.any():
            return infos
        observations = np.full(self._lanes.n, None, dtype=object)
        flat, places = self._lanes.memory.arrays.final_observations, self._lanes.first.observation_places
        for index in np.flatnonzero(ended).tolist():
            observations[index] = flat[index].copy() if places is None else in_parts(flat[index], places)
        infos |= {"final_obs": observations, "_final_obs": ended.copy()}
        return infos | {"final_info": self._reported(ended, refused, final=True), "_final_info": ended.copy()}

    @property
    def _has_vehicles(self) -> bool:
        return self._lanes.first.pool.has_choice

    def _reported(self, where: Flags, refused: Flags, *, final: bool = False) -> dict[str, Any]:
        """Return what is told of some environments, with masks."""
        arrays, single, n = self._lanes.memory.arrays, self._lanes.first, self._lanes.n
        rows = (arrays.final_reports if final else arrays.reports)[:, :n]
        everywhere = where is self._everywhere
        names = single.report_names
        infos: dict[str, Any] = {
            name: self._given(row) if everywhere else np.where(where, row, 0.0)
            for name, row in zip(names, rows, strict=False)
        }
        success, currents = rows[len(names)] != 0.0, rows[len(names) + 1 :].T
        infos["is_success"] = success if everywhere else success & where
        infos["current_ned"] = currents.copy() if everywhere else np.where(where[:, None], currents, 0.0)
        infos["refused"] = refused & where
        if self._has_vehicles:
            flown = self._flown if final else arrays.vehicles[:n]
            infos["vehicle"] = np.where(where, flown, 0.0).astype(np.int64)
        mask = self._given(where)
        return infos | {f"_{name}": mask for name in infos}

    def _refused(self) -> Flags:
        """Return where the integrator refused the step, and keep why."""
        refused = self._lanes.memory.outcome(STATUS) != 0.0
        self.refusals = {}
        if not refused.any():
            return self._none_refused
        indices = np.flatnonzero(refused)
        self.episodes_refused += len(indices)
        outcomes = np.stack([self._lanes.memory.outcome(field)[indices] for field in REPORTED], axis=1)
        for index, (why, completed, *squares) in zip(indices.tolist(), outcomes.tolist(), strict=True):
            step = self._lanes.first.scene.step
            self.refusals[index] = integration_report(step, int(why), int(completed), *squares)
        return np.asarray(refused, np.bool_)

    def _given(self, array: NDArray[Any]) -> NDArray[Any]:
        return array.copy() if self._envs.copy else array
