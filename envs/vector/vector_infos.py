"""The infos of a vector environment, merged as Gymnasium merges those of single environments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.envs.core.observation import as_shown
from dq_marine.envs.core.refusal import integration_report
from dq_marine.envs.vector.lane_memory import (
    COMPLETED,
    RESIDUAL_SQUARED,
    SPEED_SQUARED,
    SPIN_SQUARED,
    STATUS,
)
from dq_marine.envs.vector.lane_singles import LaneSingles

if TYPE_CHECKING:
    from dq_marine.envs.vector.vector_env import MarineVectorEnv

Flags = NDArray[np.bool_]
Counts = NDArray[np.int64]

REPORTED = (STATUS, COMPLETED, RESIDUAL_SQUARED, SPIN_SQUARED, SPEED_SQUARED)
"""Fields of an outcome that a report of a refusal is made of."""


def only_there(rows: NDArray[Any], where: Flags) -> NDArray[Any]:
    """Return one row, or many, with 0 in the columns that are not asked for; this is fast where few are."""
    columns = np.flatnonzero(where)
    kept = np.zeros_like(rows)
    kept[..., columns] = rows[..., columns]
    return kept


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
        self._no_fallbacks = np.zeros(lanes.n, np.int64)
        self._flown = np.zeros(lanes.n)
        self._has_vehicles = lanes.first.pool.has_choice
        self._names = lanes.first.report_names
        told = (*self._names, "is_success", "current_ned", "refused", "fallback_substeps")
        told += ("vehicle",) * self._has_vehicles
        self._masks = tuple(f"_{name}" for name in told)
        self.episodes_refused = 0
        self.refusals: dict[int, dict[str, Any]] = {}

    def before_step(self) -> None:
        """Keep which vehicles fly now: an episode that ends may be followed by one with another."""
        if self._has_vehicles:
            self._flown = self._lanes.memory.arrays.vehicles[: self._lanes.n].copy()

    def at_reset(self, wanted: Flags) -> dict[str, Any]:
        """Return the infos of environments that were reset."""
        self.refusals = {}
        return self._reported(wanted, self._none_refused, self._no_fallbacks)

    def at_step(self, ended: Flags, fallbacks: Counts) -> dict[str, Any]:
        """Return a step's infos.

        Args:
            ended: environments whose episode ended in this step.
            fallbacks: of each in this step; the infos take the array as their own.
        """
        refused = self._refused()
        if self._envs.autoreset_mode is not AutoresetMode.SAME_STEP or not np.count_nonzero(ended):
            return self._reported(self._everywhere, refused, fallbacks)
        final = self._reported(ended, refused, only_there(fallbacks, ended), final=True)
        fallbacks[ended] = 0
        infos = self._reported(self._everywhere, self._none_refused, fallbacks)
        observations = np.empty(self._lanes.n, dtype=object)
        flat, places = self._lanes.memory.arrays.final_observations, self._lanes.first.observation_places
        for index in np.flatnonzero(ended).tolist():
            observations[index] = as_shown(flat[index], places)
        infos |= {"final_obs": observations, "_final_obs": ended.copy()}
        return infos | {"final_info": final, "_final_info": ended.copy()}

    def _reported(
        self, where: Flags, refused: Flags, fallbacks: Counts, *, final: bool = False
    ) -> dict[str, Any]:
        """Return what is told of some environments, with masks."""
        arrays, n, count = self._lanes.memory.arrays, self._lanes.n, len(self._names)
        rows = self._told((arrays.final_reports if final else arrays.reports)[:, :n], where)
        infos: dict[str, Any] = dict(zip(self._names, rows, strict=False))
        infos["is_success"] = rows[count] != 0.0
        infos["current_ned"] = rows[count + 1 :].T
        infos["refused"] = refused & where
        infos["fallback_substeps"] = fallbacks
        if self._has_vehicles:
            flown = self._flown if final else arrays.vehicles[:n]
            infos["vehicle"] = self._told(flown, where).astype(np.int64)
        infos.update(dict.fromkeys(self._masks, self._given(where)))
        return infos

    def _refused(self) -> Flags:
        """Return where the integrator refused the step, and keep why."""
        refused = self._lanes.memory.outcome(STATUS) != 0.0
        self.refusals = {}
        if not np.count_nonzero(refused):
            return self._none_refused
        indices = np.flatnonzero(refused)
        self.episodes_refused += len(indices)
        outcomes = np.stack([self._lanes.memory.outcome(field)[indices] for field in REPORTED], axis=1)
        for index, (why, completed, *squares) in zip(indices.tolist(), outcomes.tolist(), strict=True):
            step = self._lanes.first.scene.step
            self.refusals[index] = integration_report(step, int(why), int(completed), *squares)
        return np.asarray(refused, np.bool_)

    def _told(self, rows: NDArray[Any], where: Flags) -> NDArray[Any]:
        return self._given(rows) if where is self._everywhere else only_there(rows, where)

    def _given(self, array: NDArray[Any]) -> NDArray[Any]:
        return array.copy() if self._envs.copy else array
