"""The memory of a batch of environments: laid out for SIMD lanes, filled from single ones, read back as such."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.engines.lane_draws import CHOSEN_COLUMNS
from dq_marine.engines.lane_packing import (
    Packing,
    aligned_zeros,
    empty_blocks,
    pack_blocks,
    pack_shared,
    packing_of,
)
from dq_marine.engines.lane_period import PeriodArrays, PeriodLayout
from dq_marine.engines.lane_type import Lanes
from dq_marine.engines.lanes import differing_fields
from dq_marine.engines.one_body import AT_REST
from dq_marine.engines.packing import pack, unpack
from dq_marine.engines.pcg64 import STATE_WORDS
from dq_marine.envs.episode import Episode

if TYPE_CHECKING:
    from dq_marine.envs.marine_env import MarineEnv

OUTCOME = (0.0,) * 6
STATUS, COMPLETED, RESCUED, RESIDUAL_SQUARED, SPIN_SQUARED, SPEED_SQUARED = range(6)
"""Fields of an outcome."""


class LaneMemory:
    """Arrays of n environments, padded to whole blocks of lanes.

    Attributes:
        layout: where what stands.
        arrays: what compiled code reads and changes.
        bodies: number of environments, padding included.
    """

    def __init__(self, singles: Sequence[MarineEnv], n: int, lanes: Lanes) -> None:
        """Lay out n environments like `singles`, one for all or one for each."""
        self.n = n
        first = singles[0]
        parameters = [single.base_parameters for single in singles]
        aims = [single.new_aim({}) for single in singles]
        memory = first.task.forget(aims[0])
        pool = first.pool
        own_parameters = {"water", *differing_fields(parameters), *differing_fields(pool.parameters)}
        own_aims = {*first.task.episode_fields, *differing_fields(aims)}
        if pool.has_choice:
            own_aims.update(pool.aim_fields)
        self.layout = PeriodLayout(
            lanes,
            packing_of(parameters[0], lanes, lambda path: len(path) == 1 and path[0] not in own_parameters),
            packing_of(aims[0], lanes, lambda path: len(path) == 1 and path[0] not in own_aims),
            packing_of(AT_REST, lanes, lambda path: False),
            packing_of(memory, lanes, lambda path: False),
            packing_of(OUTCOME, lanes, lambda path: False),
            pool.layout,
            first.restless,
        )
        self.bodies = -(-n // lanes.width) * lanes.width
        self.arrays = self._arrays(first)
        self._like_parameters = parameters[0]
        self._water_velocity = first.scene.composition.water.velocity
        self._action_size = first.drive.size
        self.fill(self.layout.parameters, self.arrays.shared, self.arrays.parameters, parameters)
        self._own_aims = frozenset(own_aims)
        self.set_default_aims(aims)
        np.copyto(self.arrays.aims, self.arrays.default_aims)

    @property
    def bytes_per_environment(self) -> float:
        """Memory held for each environment."""
        return float(sum(array.nbytes for array in self.arrays) / self.n)

    def can_hold(self, aims: Sequence[Any]) -> bool:
        """Whether aims, one for all or one for each, differ only where environments have numbers of their own."""
        return differing_fields(aims) <= self._own_aims

    def set_default_aims(self, aims: Sequence[Any]) -> None:
        """Set what episodes begin with, one for all or one for each; see `can_hold`."""
        self.fill(self.layout.aim, self.arrays.shared_aim, self.arrays.default_aims, aims)

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

    def set_aims(self, wanted: NDArray[np.bool_], aims: Sequence[Any]) -> None:
        """Set the aims of the wanted environments, one for all or one for each environment."""
        rows = np.array([pack(aim) for aim in aims])
        rows = np.broadcast_to(rows, (self.n, rows.shape[1]))
        for index in np.flatnonzero(wanted):
            self._write(self.layout.aim, self.arrays.aims, int(index), rows[index])

    def reset_aims(self, wanted: NDArray[np.bool_]) -> None:
        """Give the wanted environments the default aims; `wanted` has an entry for every lane."""
        lanes = wanted.reshape(-1, 1, self.layout.lanes.width)
        np.copyto(self.arrays.aims, self.arrays.default_aims, where=lanes)

    def episode(self, index: int) -> Episode:
        """Return a copy of one environment's episode; its action is left at zero."""
        arrays, layout = self.arrays, self.layout
        parameters = self._read(layout.parameters, arrays.shared, arrays.parameters, index)
        state = self._read(layout.state, arrays.shared, arrays.states, index)
        water = unpack(self._like_parameters, parameters).water
        return Episode(
            parameters=parameters,
            aim=self._read(layout.aim, arrays.shared_aim, arrays.aims, index),
            state=state,
            memory=self._read(layout.memory, arrays.shared, arrays.memories, index),
            action=np.zeros(self._action_size),
            observation=arrays.observations[index].copy(),
            measures=arrays.measures[:, index].copy(),
            current_ned=np.array(self._water_velocity(water, unpack(AT_REST, state).pose)),
            periods=int(arrays.periods[index]),
            vehicle=int(arrays.vehicles[index]),
            clock=float(arrays.clocks[index]),
        )

    def set_episode(self, index: int, episode: Episode) -> None:
        """Restore one environment's episode."""
        arrays, layout = self.arrays, self.layout
        self._write(layout.parameters, arrays.parameters, index, episode.parameters)
        self._write(layout.aim, arrays.aims, index, episode.aim)
        self._write(layout.state, arrays.states, index, episode.state)
        self._write(layout.memory, arrays.memories, index, episode.memory)
        arrays.observations[index] = episode.observation
        arrays.measures[:, index] = episode.measures
        arrays.periods[index] = episode.periods
        arrays.vehicles[index] = episode.vehicle
        arrays.clocks[index] = episode.clock

    def outcome(self, field: int) -> NDArray[Any]:
        """Return one field of the last period's outcomes, shape (n,)."""
        return self.arrays.outcomes[:, field, :].reshape(-1)[: self.n]  # type: ignore[no-any-return]

    def _arrays(self, single: MarineEnv) -> PeriodArrays:
        layout, bodies = self.layout, self.bodies
        lanes = layout.lanes
        observed, measures = single.observation_bound.size, len(single.task.measure_names)
        return PeriodArrays(
            shared=np.zeros(max(1, layout.parameters.shared)),
            parameters=empty_blocks(layout.parameters, self.n, lanes),
            shared_aim=np.zeros(max(1, layout.aim.shared)),
            aims=empty_blocks(layout.aim, self.n, lanes),
            default_aims=empty_blocks(layout.aim, self.n, lanes),
            states=empty_blocks(layout.state, self.n, lanes),
            memories=empty_blocks(layout.memory, self.n, lanes),
            outcomes=empty_blocks(layout.outcome, self.n, lanes),
            generators=np.zeros((bodies, STATE_WORDS), np.uint64),
            pool=single.pool.rows,
            vehicles=np.zeros(bodies),
            currents=pack(single.current_draw),
            chosen=np.full((bodies, CHOSEN_COLUMNS), np.nan),
            drawn_currents=np.zeros((bodies, 3)),
            periods=np.zeros(bodies),
            clocks=np.zeros(bodies),
            ended=np.zeros(bodies, np.bool_),
            observations=aligned_zeros((bodies, observed), np.float32),
            final_observations=aligned_zeros((bodies, observed), np.float32),
            rewards=np.zeros(bodies),
            terminated=np.zeros(bodies, np.bool_),
            truncated=np.zeros(bodies, np.bool_),
            measures=aligned_zeros((measures, bodies), np.float64),
            final_measures=aligned_zeros((measures, bodies), np.float64),
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
