"""Where a partner is, by a Gaussian sum filter on what an acoustic modem hears of it.

The state is the place r of the partner, seen from the vehicle, and its velocity v, in north and east:

    dr/dt = v - u,    dv/dt = noise,                                                                     (1)

with one's own velocity u over ground. A range alone leaves the bearing open: what is known is a sum of Gaussians, one
for each bearing and, as long as nobody tells of it, for each course; each is an extended Kalman filter with a weight
(Alspach & Sorenson 1972, IEEE Trans. Automatic Control 17(4), 439). Packets move the weights, above all after one's own
turns, and Gaussians that have become alike are one from then on. A packet tells of the time at which it was sent: what
is expected of it follows from the state of now, moved back by its age.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RANGE_ERROR, SPEED_ERROR = 0.3, 0.04
"""Standard deviations of what packets give: range [m], each component of the velocity [m/s]."""

POSITION_ERROR = 10.0
"""Of a place that two navigations tell [m]. Their errors last from packet to packet, so each counts for little."""

OWN_VELOCITY_ERROR = 0.03
"""Of one's own velocity, as a random walk [m/sqrt(s)]."""

PLAN_ERROR = 0.1
"""Of the speed that was planned, over it, where packets tell no other."""

CHANGE = 0.3
"""Of each component of the partner's velocity, in the time in which it goes `BEND` [its speed]."""

BEND = 30.0
"""Way in which a partner turns by as much as `CHANGE` says [m]."""

WIDEST, BEARINGS, COURSES = math.radians(100.0), 21, 16
"""Bearings from the bow that the first packet leaves open: within [rad], how many; and courses."""

SURPRISE, SURPRISES = 9.0, 3
"""A range is farther off than this for all Gaussians, squared, over its variance; so often in a row: none is right."""

SPREAD = 0.6
"""Standard deviation of the first Gaussians, over how far they are apart."""

LEAST_WEIGHT, ALIKE = 1e-3, 1.0
"""Gaussians with less weight, over the largest, are left out; those within this of the other, squared, are one."""


class Told(NamedTuple):
    """A packet as it is understood.

    Attributes:
        age: time since it was sent [s].
        range: [m].
        below: how much deeper the partner was than the vehicle [m].
        velocity: of the partner in north and east [m/s]; None where packets do not tell.
        offset: where it was, seen from the vehicle now [m]; None likewise.
    """

    age: float
    range: float
    below: float
    velocity: tuple[float, float] | None
    offset: tuple[float, float] | None


class PartnerFilter:
    """The filter, with what is known of the partner now: weights (n,), means (n, 4) and covariances (n, 4, 4)."""

    def __init__(self, told: Told, bow: float, speed: float, widest: float = WIDEST) -> None:
        """Begin with a packet.

        Args:
            told: by it.
            bow: one's own heading at the start, which is about towards the partner [rad].
            speed: of the partner, as planned [m/s].
            widest: bearings within this of the bow are open [rad].
        """
        level = math.sqrt(max(0.0, told.range**2 - told.below**2))
        bearings = bow + np.linspace(-widest, widest, BEARINGS)
        if told.velocity is None:
            courses, apart = np.arange(COURSES) * math.tau / COURSES, speed * math.tau / COURSES
        else:
            courses, apart = np.array([math.atan2(told.velocity[1], told.velocity[0])]), SPEED_ERROR
            speed = math.hypot(*told.velocity)
        bearing, course = (grid.ravel() for grid in np.meshgrid(bearings, courses))
        along = np.stack([np.cos(bearing), np.sin(bearing)], axis=-1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        aside = SPREAD * level * 2.0 * widest / (BEARINGS - 1)
        velocity = speed * np.stack([np.cos(course), np.sin(course)], axis=-1)
        self.means = np.concatenate([level * along + told.age * velocity, velocity], axis=1)
        self.covariances = np.zeros((len(bearing), 4, 4))
        self.covariances[:, :2, :2] = RANGE_ERROR**2 * _outer(along) + aside**2 * _outer(across)
        self.covariances[:, 2:, 2:] = (SPREAD * apart) ** 2 * np.eye(2)
        self.weights = np.full(len(bearing), 1.0 / len(bearing))
        self._speed, self._surprises = speed, 0
        self._change = (CHANGE * speed) ** 2 * speed / BEND
        if told.offset is not None:
            self._take(told, told.offset, slice(0, 2), POSITION_ERROR)

    @property
    def likeliest(self) -> Array:
        """The mean of the Gaussian with the most weight, shape (4,)."""
        return np.asarray(self.means[int(np.argmax(self.weights))])

    @property
    def lost(self) -> bool:
        """Whether the last ranges were none that was expected: begin anew, with all bearings."""
        return self._surprises >= SURPRISES

    def predict(self, velocity: tuple[float, float], period: float) -> None:
        """Go on for a while [s], with one's own velocity in north and east [m/s]."""
        move = np.eye(4)
        move[0, 2] = move[1, 3] = period
        self.means = self.means @ move.T
        self.means[:, 0] -= period * velocity[0]
        self.means[:, 1] -= period * velocity[1]
        noise = period * np.array([OWN_VELOCITY_ERROR**2] * 2 + [self._change] * 2)
        self.covariances = move @ self.covariances @ move.T + np.diag(noise)

    def update(self, told: Told, velocity: tuple[float, float]) -> None:
        """Take a packet into account, with one's own velocity in north and east [m/s]."""
        if told.velocity is not None:
            self._take(told, told.velocity, slice(2, 4), SPEED_ERROR)
        else:
            self._keep_speed()
        if told.offset is not None:
            self._take(told, told.offset, slice(0, 2), POSITION_ERROR)
        then = self.means[:, :2] - told.age * (self.means[:, 2:] - np.array(velocity))
        level = np.maximum(np.hypot(then[:, 0], then[:, 1]), 1e-6)
        slope = np.empty((len(level), 1, 4))
        expected = np.hypot(level, told.below)
        slope[:, 0, :2] = then / expected[:, None]
        slope[:, 0, 2:] = -told.age * slope[:, 0, :2]
        # A range is curved where a Gaussian is wide: that counts as noise.
        across = np.stack([-then[:, 1], then[:, 0]], axis=-1) / level[:, None]
        wide = np.einsum("ni,nij,nj->n", across, self.covariances[:, :2, :2], across) / (2.0 * level)
        noise = (RANGE_ERROR**2 + wide**2)[:, None, None]
        off = self._correct(told.range - expected[:, None], slope, noise)
        self._surprises = self._surprises + 1 if off > SURPRISE else 0
        self._merge()

    def _keep_speed(self) -> None:
        """Take into account that the partner goes about as fast as planned, wherever it turns."""
        speed = np.maximum(np.hypot(self.means[:, 2], self.means[:, 3]), 1e-6)
        slope = np.zeros((len(speed), 1, 4))
        slope[:, 0, 2:] = self.means[:, 2:] / speed[:, None]
        self._correct(
            self._speed - speed[:, None], slope, np.full((1, 1, 1), (PLAN_ERROR * self._speed) ** 2)
        )

    def _take(self, told: Told, given: tuple[float, float], part: slice, error: float) -> None:
        """Take two numbers of a packet into account that are a part of the state, or that moved back by its age."""
        slope = np.zeros((1, 2, 4))
        slope[0, :, part] = np.eye(2)
        if part.start == 0:
            slope[0, :, 2:] = -told.age * np.eye(2)
        expected = self.means @ slope[0].T
        self._correct(np.array(given) - expected, slope, error**2 * np.eye(2)[None])

    def _correct(self, off: Array, slope: Array, noise: Array) -> float:
        """Correct all Gaussians by how far off a measurement is, and weigh them by how likely it was.

        How far it is off the nearest is returned, squared and over its variance.
        """
        across = self.covariances @ np.swapaxes(slope, 1, 2)
        spread = slope @ across + noise
        gain = np.swapaxes(np.linalg.solve(spread, np.swapaxes(across, 1, 2)), 1, 2)
        self.means = self.means + (gain @ off[:, :, None])[:, :, 0]
        kept = np.eye(4) - gain @ slope
        # Joseph's form stays positive definite under rounding.
        self.covariances = kept @ self.covariances @ np.swapaxes(kept, 1, 2) + gain @ (
            noise @ np.swapaxes(gain, 1, 2)
        )
        squares = np.einsum("ni,ni->n", off, np.linalg.solve(spread, off[:, :, None])[:, :, 0])
        likely = np.log(self.weights) - 0.5 * (squares + np.linalg.slogdet(spread)[1])
        weights = np.exp(likely - likely.max())
        keep = weights > LEAST_WEIGHT
        self.weights = weights[keep] / weights[keep].sum()
        self.means, self.covariances = self.means[keep], self.covariances[keep]
        return float(squares.min())

    def _merge(self) -> None:
        """Make Gaussians that are alike one, with the mean and the covariance of their sum, the heaviest first."""
        left = np.argsort(-self.weights)
        if len(left) == 1:
            return
        merged = []
        while len(left):
            off = self.means[left] - self.means[left[0]]
            near = np.einsum("ni,ni->n", off, np.linalg.solve(self.covariances[left[0]], off.T).T) < ALIKE
            group, left = left[near], left[~near]
            weight = self.weights[group].sum()
            share = self.weights[group] / weight
            mean = share @ self.means[group]
            spread = self.covariances[group] + _outer(self.means[group] - mean)
            merged.append((weight, mean, np.einsum("n,nij->ij", share, spread)))
        self.weights, self.means, self.covariances = (np.array(part) for part in zip(*merged, strict=True))


def _outer(vectors: Array) -> Array:
    """Return the products of vectors with themselves, shape (n, k, k)."""
    return np.asarray(vectors[:, :, None] * vectors[:, None, :])
