"""Takes and keeps the samples of a run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.manoeuvres.series import Series
from dq_marine.simulation.one_body import OneBody

Array = NDArray[np.float64]


class Sample(NamedTuple):
    """A body at one time.

    Attributes:
        time: of the body [s].
        position_ned: [m], shape (3,).
        quaternion_body_to_ned: scalar first, shape (4,).
        velocity_body: Fossen's order [m/s, rad/s], shape (6,).
    """

    time: float
    position_ned: Array
    quaternion_body_to_ned: Array
    velocity_body: Array


def sample_of(body: OneBody) -> Sample:
    """Return a body as it is now."""
    return Sample(body.time, body.position_ned, body.quaternion_body_to_ned, body.velocity_body)


class Recorder:
    """Samples of a body, one after the other, each with the commands from it on."""

    def __init__(self) -> None:
        self._rows: list[tuple[Sample, float, float]] = []
        self._begin = 0.0

    def add(self, sample: Sample, throttle: float, helm: float) -> None:
        """Keep a sample."""
        self._rows.append((sample, throttle, helm))

    def begin(self, time: float, lead: float) -> None:
        """Make `time` the 0 of the series, and keep what is no more than `lead` before it [s]."""
        self._begin = time
        self._rows = [row for row in self._rows if row[0].time >= time - lead * (1.0 + 1e-9)]

    def series(self, last: Sample) -> Series:
        """Return the samples, and one more that ends them, under the last commands."""
        throttle, helm = self._rows[-1][1:] if self._rows else (0.0, 0.0)
        samples, throttles, helms = zip(*self._rows, (last, throttle, helm), strict=True)
        times, positions, quaternions, velocities = zip(*samples, strict=True)
        return Series(
            time=np.array(times) - self._begin,
            position_ned=np.array(positions),
            quaternion_body_to_ned=np.array(quaternions),
            velocity_body=np.array(velocities),
            throttle=np.array(throttles),
            helm=np.array(helms),
        )
