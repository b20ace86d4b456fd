"""The memory of a batch of environments: laid out for SIMD lanes, filled from single ones, read back as such."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.packing import pack
from dq_marine.backend.pcg64 import STATE_WORDS
from dq_marine.backend.simd.draws import CHOSEN_COLUMNS
from dq_marine.backend.simd.lanes import differing_fields
from dq_marine.backend.simd.packing import (
    Packing,
    aligned_zeros,
    empty_blocks,
    pack_blocks,
    pack_shared,
    packing_of,
)
from dq_marine.backend.simd.period import PeriodArrays, PeriodLayout
from dq_marine.envs.core.episode import Episode
from dq_marine.envs.core.vehicle_pool import VEHICLE_FIELDS
from dq_marine.task.episode import EpisodeParameters

if TYPE_CHECKING:
    from dq_marine.envs.core.marine_env import MarineEnv

OUTCOME = (0.0,) * 6
STATUS, COMPLETED, FALLBACKS, RESIDUAL_SQUARED, SPIN_SQUARED, SPEED_SQUARED = range(6)
"""Fields of an outcome."""


SUCCESS_AND_CURRENT = 4
"""Numbers of a report that follow those that have names: the success, and the current in NED."""

Path = tuple[str | int, ...]


def differing_paths(episodes: Sequence[EpisodeParameters]) -> frozenset[Path]:
    """Return where the parameters of episodes differ: names of fields, and in the task's own a second name."""
    of_task = {("task", name) for name in differing_fields([episode.task for episode in episodes])}
    others = {(name,) for name in differing_fields(episodes) if name != "task"}
    return frozenset({*of_task, *others})


def own_episode_paths(single: MarineEnv, episodes: Sequence[EpisodeParameters]) -> frozenset[Path]:
    """Return which parameters of episodes every environment has for itself."""
    by_options = {("task", name) for name in single.definition.episode_fields}
    by_vehicle = {(name,) for name in VEHICLE_FIELDS} if single.pool.has_choice else set()
    return frozenset({*differing_paths(episodes), *by_options, *by_vehicle})


class LaneMemory:
    """Arrays of n environments, padded to whole blocks of lanes.

    Attributes:
        layout: where what stands.
        arrays: what compiled code reads and changes.
        bodies: number of environments, padding included.
    """

    def __init__(self, singles: Sequence[MarineEnv], n: int, lanes: Lanes, *, keeps_ends: bool) -> None:
        """Lay out n environments like `singles`, one for all or one for each.

        Args:
            singles: the environments.
            n: how many there are to be.
            lanes: the type of their numbers.
            keeps_ends: whether what an episode ends with is kept beside what the next one begins with.
        """
        self.n = n
        first = singles[0]
        parameters = [single.base_parameters for single in singles]
        episodes = [single.episode_parameters({}) for single in singles]
        pool = first.pool
        own_parameters = {"water", *differing_fields(parameters), *differing_fields(pool.parameters)}
        self._own_episode_paths = own_episode_paths(first, episodes)
        self.layout = PeriodLayout(
            lanes,
            packing_of(parameters[0], lanes, lambda path: len(path) == 1 and path[0] not in own_parameters),
            packing_of(episodes[0], lanes, self._is_shared_in_episode),
            packing_of(first.scene.composition.at_rest, lanes, lambda path: False),
            packing_of(first.blank_memory, lanes, lambda path: False),
            packing_of(OUTCOME, lanes, lambda path: False),
            pool.layout,
            first.time_varying,
        )
        self.bodies = -(-n // lanes.width) * lanes.width
        self.arrays = self._arrays(first, self.bodies if keeps_ends else 0)
        self._action_size = first.action_mapping.size
        self.fill(self.layout.parameters, self.arrays.shared, self.arrays.parameters, parameters)
        self.set_default_episodes(episodes)
        np.copyto(self.arrays.episodes, self.arrays.default_episodes)

    def _is_shared_in_episode(self, path: Path) -> bool:
        """Whether all environments have the same number at a path of fields: "task" is looked into."""
        own = any(path[:depth] in self._own_episode_paths for depth in range(1, len(path) + 1))
        return not own and path not in ((), ("task",))

    @property
    def bytes_per_environment(self) -> float:
        """Memory held for each environment."""
        return float(sum(array.nbytes for array in self.arrays) / self.n)

    def can_hold(self, episodes: Sequence[EpisodeParameters]) -> bool:
        """Whether parameters, one for all or one for each, differ only where environments have numbers of their own."""
        return differing_paths(episodes) <= self._own_episode_paths

    def set_default_episodes(self, episodes: Sequence[EpisodeParameters]) -> None:
        """Set the parameters that episodes begin with, one for all or one for each; see `can_hold`."""
        self.fill(self.layout.episode, self.arrays.shared_episode, self.arrays.default_episodes, episodes)

    def take_over(self, other: LaneMemory) -> None:
        """Go on where environments that were laid out otherwise are."""
        for index in range(self.n):
            self.set_episode(index, other.episode(index))
        for name in ("generators", "ended"):
            getattr(self.arrays, name)[: self.n] = getattr(other.arrays, name)[: self.n]

    def fill(
        self, packing: Packing, shared: NDArray[np.float64], blocks: NDArray[Any], structures: Sequence[Any]
    ) -> None:
        """Write structures, one for all or one for each, into a shared array and blocks."""
        rows = [pack(structure) for structure in structures]
        shared[: packing.shared] = pack_shared(packing, rows[0])
        pack_blocks(packing, rows, blocks)

    def set_episodes(self, wanted: NDArray[np.bool_], episodes: Sequence[EpisodeParameters]) -> None:
        """Set the parameters of the wanted environments' episodes, one for all or one for each environment."""
        rows = np.array([pack(episode) for episode in episodes])
        rows = np.broadcast_to(rows, (self.n, rows.shape[1]))
        for index in np.flatnonzero(wanted):
            self._write(self.layout.episode, self.arrays.episodes, int(index), rows[index])

    def reset_episodes(self, wanted: NDArray[np.bool_]) -> None:
        """Give the wanted environments' episodes the default parameters; `wanted` has an entry for every lane."""
        lanes = wanted.reshape(-1, 1, self.layout.lanes.width)
        np.copyto(self.arrays.episodes, self.arrays.default_episodes, where=lanes)

    def episode(self, index: int) -> Episode:
        """Return a copy of one environment's episode; its action is left at zero."""
        arrays, layout = self.arrays, self.layout
        parameters = self._read(layout.parameters, arrays.shared, arrays.parameters, index)
        return Episode(
            parameters=parameters,
            episode_parameters=self._read(layout.episode, arrays.shared_episode, arrays.episodes, index),
            state=self._read(layout.state, arrays.shared, arrays.states, index),
            memory=self._read(layout.memory, arrays.shared, arrays.memories, index),
            action=np.zeros(self._action_size),
            observation=arrays.observations[index].copy(),
            report=arrays.reports[:, index].copy(),
            periods=int(arrays.periods[index]),
            vehicle=int(arrays.vehicles[index]),
            clock=float(arrays.clocks[index]),
        )

    def set_episode(self, index: int, episode: Episode) -> None:
        """Restore one environment's episode."""
        arrays, layout = self.arrays, self.layout
        self._write(layout.parameters, arrays.parameters, index, episode.parameters)
        self._write(layout.episode, arrays.episodes, index, episode.episode_parameters)
        self._write(layout.state, arrays.states, index, episode.state)
        self._write(layout.memory, arrays.memories, index, episode.memory)
        arrays.observations[index] = episode.observation
        arrays.reports[:, index] = episode.report
        arrays.periods[index] = episode.periods
        arrays.vehicles[index] = episode.vehicle
        arrays.clocks[index] = episode.clock

    def outcome(self, field: int) -> NDArray[Any]:
        """Return one field of the last period's outcomes, shape (n,)."""
        return self.arrays.outcomes[:, field, :].reshape(-1)[: self.n]  # type: ignore[no-any-return]

    def _arrays(self, single: MarineEnv, ends: int) -> PeriodArrays:
        layout, bodies = self.layout, self.bodies
        lanes = layout.lanes
        observed, told = single.observation_bound.size, len(single.report_names) + SUCCESS_AND_CURRENT
        return PeriodArrays(
            shared=np.zeros(max(1, layout.parameters.shared)),
            parameters=empty_blocks(layout.parameters, self.n, lanes),
            shared_episode=np.zeros(max(1, layout.episode.shared)),
            episodes=empty_blocks(layout.episode, self.n, lanes),
            default_episodes=empty_blocks(layout.episode, self.n, lanes),
            states=empty_blocks(layout.state, self.n, lanes),
            memories=empty_blocks(layout.memory, self.n, lanes),
            outcomes=empty_blocks(layout.outcome, self.n, lanes),
            generators=np.zeros((bodies, STATE_WORDS), np.uint64),
            pool=single.pool.rows,
            vehicles=np.zeros(bodies),
            currents=pack(single.current_draw),
            chosen=np.full((1, CHOSEN_COLUMNS), np.nan),
            periods=np.zeros(bodies),
            clocks=np.zeros(bodies),
            ended=np.zeros(bodies, np.bool_),
            observations=aligned_zeros((bodies, observed), np.float32),
            final_observations=aligned_zeros((ends, observed), np.float32),
            rewards=np.zeros(bodies),
            terminated=np.zeros(bodies, np.bool_),
            truncated=np.zeros(bodies, np.bool_),
            reports=aligned_zeros((told, bodies), np.float64),
            final_reports=aligned_zeros((told, ends), np.float64),
        )

    def _read(
        self, packing: Packing, shared: NDArray[Any], blocks: NDArray[Any], index: int
    ) -> NDArray[np.float64]:
        block, lane = divmod(index, packing.width)
        return np.array(
            [shared[slot.index] if slot.shared else blocks[block, slot.index, lane] for slot in packing.slots]
        )

    def _write(
        self, packing: Packing, blocks: NDArray[Any], index: int, numbers: NDArray[np.float64]
    ) -> None:
        block, lane = divmod(index, packing.width)
        for slot, number in zip(packing.slots, numbers.tolist(), strict=True):
            if not slot.shared:
                blocks[block, slot.index, lane] = number
