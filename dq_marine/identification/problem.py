"""The least squares problem: what a log and simulations of its segments differ by, and how that depends on theta.

Each segment starts from a state that is fitted, too. Where theta is sought, the starts are taken out by projection
(Golub and Pereyra 1973, SIAM J. Numer. Anal. 10(2)): a residual r and its derivative J by theta become (1 - Q Q^T) r
and (1 - Q Q^T) J, where the columns of Q span the derivative by the segment's start.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from dq_marine.identification.lanes import Motions, SegmentedLog
from dq_marine.identification.log import Log
from dq_marine.identification.model import Model, model_with
from dq_marine.identification.parameters import LARGEST_THETA, Parameter
from dq_marine.identification.starts import AXES, measured_starts, moved, rotation_between

Array = NDArray[np.float64]

OUTPUTS = (
    ("north", "m"), ("east", "m"), ("down", "m"), ("roll", "rad"), ("pitch", "rad"), ("yaw", "rad"),
    ("u", "m/s"), ("v", "m/s"), ("w", "m/s"), ("p", "rad/s"), ("q", "rad/s"), ("r", "rad/s"),
)  # fmt: skip
"""What is compared, with its unit; the attitude by the rotation from the simulated to the measured one, body frame."""

DIFFERENCE = 1e-5
"""Of theta and of starts, for derivatives."""

SEED = 0
"""Of the starts that are drawn as uncertain as the estimated ones."""

SHARES = (1.0, 0.5, 0.25, 0.0)
"""Of the change to the best starts to first order, of which each segment takes the best."""

FAR = 1e6
"""Residual, over the noise, of a vehicle that cannot be simulated: so large that it is never taken."""


class Evaluation(NamedTuple):
    """The problem at one theta.

    Attributes:
        residual: with the best starts to first order, over the noise, shape (rows, 12); 0 where nothing was measured.
        jacobian: its derivative by the free parameters, shape (12 rows, free).
        change: of the starts, to their best, shape (segments, 12).
        drawn: changes of the starts as uncertain as theirs, drawn from a fixed seed, shape (segments, 12).
        refused: segments that could not be simulated to their end.
    """

    residual: Array
    jacobian: Array
    change: Array
    drawn: Array
    refused: int


class Problem:
    """A log, a vehicle in its water, and their parameters.

    Attributes:
        starts: of the segments, from which `evaluate` simulates.
        noise: standard deviation of each output, shape (12,).
        readings: of each output, shape (12,).
        missing: where nothing was measured, shape (rows, 12).
    """

    def __init__(
        self, log: Log, model: Model, parameters: Sequence[Parameter], segments: SegmentedLog
    ) -> None:
        """Take the log, cut into segments."""
        self._model, self._parameters, self._segments = model, tuple(parameters), segments
        vehicle = model.vehicle
        rows = segments.rows
        self._measured = (log.position_ned[rows], log.quaternion_body_to_ned[rows], log.velocity_body[rows])
        self.missing: NDArray[np.bool_] = np.isnan(
            np.hstack([self._measured[0], self._measured[1][:, 1:], self._measured[2]])
        )
        self.readings = (~self.missing).sum(axis=0)
        floats = vehicle.hydrostatics is not None
        position = [axis for axis in range(3) if self.readings[axis] or (axis == 2 and floats)]
        self._start_axes = [*position, *range(3, AXES)]
        self.starts = measured_starts(log, rows[segments.first_rows], vehicle.equilibrium_depth)
        self.noise = np.maximum(self._noise_of_readings(), self.smallest_noise)

    @property
    def smallest_noise(self) -> Array:
        """What noise is taken to be at least: of a millionth of the motion, shape (12,)."""
        attitude = np.full((1, 3), 1.0)
        spread = [np.nanstd(_known(part), axis=0) for part in (self._measured[0], self._measured[2])]
        return np.asarray(1e-6 * np.maximum(np.concatenate([spread[0], attitude[0], spread[1]]), 1e-3))

    @property
    def fitted_numbers(self) -> int:
        """How many numbers the starts of all segments have."""
        return len(self._start_axes) * self._segments.count

    def label(self, index: int) -> str:
        """Return a parameter's name for people."""
        return self._parameters[index].label

    def model_at(self, theta: Array) -> Model:
        """Return the vehicle and its water at a theta of all parameters."""
        return model_with(self._model, self._parameters, theta)

    def evaluate(self, theta: Array, free: Sequence[int], away: Array | None = None) -> Evaluation:
        """Simulate and compare.

        Args:
            theta: of all parameters.
            free: those by which derivatives are taken.
            away: change of the starts for this time, shape (segments, 12).
        """
        begin = self.starts if away is None else moved(self.starts, away)
        steps = np.where(theta > LARGEST_THETA - 1.0, -DIFFERENCE, DIFFERENCE)
        try:
            varied = [self.model_at(theta + steps * np.eye(len(theta))[index]) for index in free]
            models = [self.model_at(theta)] * (1 + len(self._start_axes)) + varied
        except ValidationError:
            residual = np.where(self.missing, 0.0, FAR)
            blank = np.zeros((residual.size, len(free)))
            still = np.zeros((self._segments.count, AXES))
            return Evaluation(residual, blank, still, still, self._segments.count)
        shifted = [moved(begin, DIFFERENCE * np.eye(AXES)[axis]) for axis in self._start_axes]
        starts = [begin, *shifted, *[begin] * len(varied)]
        motions, refused = self._segments.simulate(models, starts)
        residuals = self._residuals(motions)
        slopes = (residuals[1:] - residuals[:1]) / DIFFERENCE
        by_start, by_theta = np.split(slopes, [len(self._start_axes)])
        by_theta = by_theta * np.sign(steps[list(free)])[:, None, None]
        return Evaluation(*self._without_starts(residuals[0], by_start, by_theta), refused)

    def shares_of_noise(self, theta: Array, free: Sequence[int], evaluation: Evaluation) -> Array:
        """Return how much of what the log feels of each free parameter comes from noise in the starts: 0 to about 1.

        A start that is at rest in truth moves a little as it is estimated, and a simulation from there depends on
        parameters of a motion that never was. Other starts, drawn as uncertain, tell how much.
        """
        other = self.evaluate(theta, free, evaluation.drawn).jacobian
        felt = np.linalg.norm(evaluation.jacobian, axis=0)
        return np.asarray(np.linalg.norm(other - evaluation.jacobian, axis=0) / np.maximum(felt, 1e-100))

    def take_starts(self, theta: Array, evaluation: Evaluation) -> None:
        """Start from better states from now on: each segment goes as far to the best to first order as it fits better.

        All the way from a start that is far off, a segment that tumbles would jump to and fro.
        """
        tried = [moved(self.starts, share * evaluation.change) for share in SHARES]
        motions, _ = self._segments.simulate([self.model_at(theta)] * len(SHARES), tried)
        squares = (self._residuals(motions) ** 2).sum(axis=2)
        of_segments = np.add.reduceat(squares, self._segments.first_rows, axis=1)
        best = np.where(np.isnan(of_segments), np.inf, of_segments).argmin(axis=0)
        self.starts = moved(self.starts, np.array(SHARES)[best, None] * evaluation.change)

    def take_noise(self, evaluation: Evaluation) -> None:
        """Weigh outputs by what they differ by from now on."""
        squares = (evaluation.residual**2).sum(axis=0) / np.maximum(self.readings, 1)
        readings = int(self.readings.sum())
        lost = readings / max(readings - self.fitted_numbers - len(self._parameters), 1)
        self.noise = np.maximum(self.noise * np.sqrt(squares * lost), self.smallest_noise)

    def _residuals(self, motions: Motions) -> Array:
        """Return measured less simulated, over the noise, shape (simulations, rows, 12)."""
        position, attitude, velocity = self._measured
        parts = [
            position - motions.position_ned,
            rotation_between(motions.quaternion_body_to_ned, attitude[None]),
            velocity - motions.velocity_body,
        ]
        difference = np.concatenate(parts, axis=-1) / self.noise
        return np.where(self.missing, 0.0, np.clip(difference, -FAR, FAR))

    def _without_starts(
        self, residual: Array, by_start: Array, by_theta: Array
    ) -> tuple[Array, Array, Array, Array]:
        left, slopes = np.empty_like(residual), np.empty((residual.size, len(by_theta)))
        change, drawn = np.zeros((2, self._segments.count, AXES))
        draw = np.random.default_rng(SEED)
        for segment in range(self._segments.count):
            rows = np.flatnonzero(self._segments.segment == segment)
            own = residual[rows].ravel()
            block = by_start[:, rows].reshape(len(by_start), -1).T
            scale = np.maximum(np.linalg.norm(block, axis=0), 1e-300)
            squares, axes = np.linalg.eigh((block / scale).T @ (block / scale))
            kept = squares > 1e-12 * squares[-1]
            toward = axes[:, kept] / np.sqrt(squares[kept])
            basis = block / scale @ toward
            change[segment, self._start_axes] = -(toward @ (basis.T @ own)) / scale
            drawn[segment, self._start_axes] = (toward @ draw.normal(size=basis.shape[1])) / scale
            left[rows] = (own - basis @ (basis.T @ own)).reshape(len(rows), -1)
            of_theta = by_theta[:, rows].reshape(len(by_theta), -1).T
            places = (rows[:, None] * residual.shape[1] + np.arange(residual.shape[1])).ravel()
            slopes[places] = of_theta - basis @ (basis.T @ of_theta)
        return left, slopes, change, drawn

    def _noise_of_readings(self) -> Array:
        """Return the noise that third differences of the readings show: motion hardly has any."""
        position, attitude, velocity = self._measured
        there = ~np.isnan(attitude).any(axis=1)
        turning = rotation_between(attitude[there][:-1], attitude[there][1:])
        found = [_third_difference(column) for column in position.T]
        found += [_third_difference(np.cumsum(column)) for column in turning.T]
        return np.array(found + [_third_difference(column) for column in velocity.T])


def _known(part: Array) -> Array:
    """Return columns, those without a reading as zeros."""
    return np.where(np.isnan(part).all(axis=0), 0.0, part)


def _third_difference(column: Array) -> float:
    """Return the standard deviation of white noise on a smooth signal; robust against what jumps."""
    changes = np.diff(column[~np.isnan(column)], 3)
    return float(1.4826 * np.median(np.abs(changes)) / np.sqrt(20.0)) if changes.size else 1.0
