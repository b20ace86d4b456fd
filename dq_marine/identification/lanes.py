"""Segments of a log, simulated in lanes: each with its own start, for many vehicles and currents at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.identification.log import Log
from dq_marine.identification.model import Model, model_with
from dq_marine.identification.parameters import CURRENT, Parameter, parameters_of
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

GUARD = 1e-3
"""Theta of a lane that nobody reads: it differs in all that may be fitted, so one compiled step serves all fits."""


UNFELT = (0.0, 0.0, 1e-30)
"""A current [m/s] that acts on nothing, yet is a term of the step: in a batch all lanes compute the same terms."""


class Motions(NamedTuple):
    """Motions of segments: the first axis counts simulations, the second rows of the log.

    Attributes:
        position_ned: [m], shape (simulations, rows, 3).
        quaternion_body_to_ned: shape (simulations, rows, 4), of nearly unit length.
        velocity_body: [m/s, rad/s], shape (simulations, rows, 6).
    """

    position_ned: Array
    quaternion_body_to_ned: Array
    velocity_body: Array


class Start(NamedTuple):
    """States that segments start from, a row for each: as in `Motions`."""

    position_ned: Array
    quaternion_body_to_ned: Array
    velocity_body: Array


class SegmentedLog:
    """A log cut into segments of equal length, ready to be simulated.

    Attributes:
        count: of segments.
        length: of a segment, in periods of the log.
        rows: of the log, those that are compared.
        segment: that each of these belongs to.
    """

    def __init__(self, log: Log, model: Model, segment_time: float, step: float) -> None:
        """Cut a log.

        Args:
            log: to be cut.
            model: the vehicle as its file has it, in the current as it was given.
            segment_time: about how long a segment is [s].
            step: largest step of the integrator [s].
        """
        self._model, self._inputs = model, log.inputs
        self._substeps = max(1, int(np.ceil(log.period / step * (1.0 - 1e-9))))
        self._step = log.period / self._substeps
        grid = (log.time - log.time[0]) / log.period
        whole = int(np.floor(grid[-1] + 1e-6))
        self.count = max(1, round(whole * log.period / segment_time))
        self.length = whole // self.count
        nearest = np.rint(np.interp(np.arange(whole), grid, np.arange(len(grid)))).astype(int)
        self._held = log.inputs.values[nearest[: self.count * self.length]]
        node = np.floor(grid + 1e-4).astype(int)
        self.rows = np.flatnonzero(node < self.count * self.length)
        self.segment, self._node = np.divmod(node[self.rows], self.length)
        weight = grid[self.rows] - node[self.rows]
        self._weight = np.where(np.abs(weight) < 1e-4, 0.0, weight)[:, None]
        guards = _all_parameters(model.vehicle)
        self._guard = model_with(model, guards, [GUARD] * len(guards))
        self._channels = self._channel_states() if log.inputs.actuation == "thrusters" else None

    @property
    def first_rows(self) -> NDArray[np.intp]:
        """Place among `rows` of the first row of each segment."""
        return np.searchsorted(self.segment, np.arange(self.count))

    def simulate(self, models: Sequence[Model], starts: Sequence[Start]) -> tuple[Motions, int]:
        """Simulate all segments, each for every pair of a model and its starts.

        Args:
            models: that differ in numbers only.
            starts: of the segments, for each model.

        Returns:
            The motions at the rows of the log, and the number of segments of the first model that were refused.
        """
        batch = self._batch(models)
        size = len(models) * self.count
        parts = [np.concatenate([getattr(start, name) for start in starts]) for name in Start._fields]
        batch.reset(*(np.vstack([part, part[:1]]) for part in parts))
        self._place_channels(batch, len(models))
        shapes = [(self.length + 1, size, width) for width in (3, 4, 6)]
        series = Motions(*(np.empty(shape) for shape in shapes))
        refused: set[int] = set()
        for node in range(self.length + 1):
            for name, part in zip(Motions._fields, series, strict=True):
                part[node] = getattr(batch, name)[:size]
            if node < self.length:
                self._drive(batch, self._held[node :: self.length], len(models))
                refused |= batch.refusals.keys()
        batch.close()
        return self._at_rows(series, len(models)), sum(lane < self.count for lane in refused)

    def _scene(self, model: Model) -> Scene:
        current = model.current_ned if any(model.current_ned) else UNFELT
        return Scene(model.vehicle, step=self._step, current=current, actuation=self._inputs.actuation)

    def _batch(self, models: Sequence[Model]) -> Batch:
        scenes = [self._scene(model) for model in (*models, self._guard)]
        each = [scene.parameters_at(self._step) for scene in scenes]
        lanes = [one for one in each[:-1] for _ in range(self.count)] + each[-1:]
        return Batch(scenes[0].composition, lanes, self._step, len(lanes))

    def _drive(self, batch: Batch, inputs: Array, repeats: int) -> None:
        rows = np.vstack([np.tile(inputs, (repeats, 1)), inputs[:1]])
        if self._inputs.actuation == "thrusters":
            batch.actuate(rows, self._substeps)
        else:
            batch.step(rows, self._substeps)

    def _channel_states(self) -> Array:
        """Return values and commands of all channels where segments start: they do not depend on the motion."""
        batch = self._batch([self._model])
        state, found = np.zeros(2 * self._held.shape[1]), []
        for moment, command in enumerate(self._held):
            if moment % self.length == 0:
                found.append(state)
            batch.reset()  # the motion is of no interest, and shall not grow
            self._set_channels(batch, np.tile(state, (batch.size, 1)))
            batch.actuate(command, self._substeps)
            state = np.concatenate([batch.actuator_values[0], batch.command[0]])
        batch.close()
        return np.array(found)

    def _place_channels(self, batch: Batch, repeats: int) -> None:
        if self._channels is not None:
            self._set_channels(batch, np.vstack([np.tile(self._channels, (repeats, 1)), self._channels[:1]]))

    def _set_channels(self, batch: Batch, channels: Array) -> None:
        state = batch.get_state()
        state[:, -channels.shape[1] :] = channels
        batch.set_state(state)

    def _at_rows(self, series: Motions, repeats: int) -> Motions:
        """Return the motions at the instants of the log, between the ends of periods by their chord."""

        def at_rows(part: Array) -> Array:
            by_segment = part.reshape(self.length + 1, repeats, self.count, part.shape[-1])
            before = by_segment[self._node, :, self.segment]
            after = by_segment[self._node + 1, :, self.segment]
            return np.asarray(np.moveaxis(before + self._weight[:, None] * (after - before), 1, 0))

        return Motions(*map(at_rows, series))


def _all_parameters(vehicle: Vehicle) -> tuple[Parameter, ...]:
    groups = ["linear", "quadratic", "couplings", "cross_flow", "manoeuvring", "gains", CURRENT]
    if np.linalg.eigvalsh(vehicle.added_mass_matrix).min() >= 0.0:
        groups.append("added_mass_full")
    return parameters_of(vehicle, groups)
