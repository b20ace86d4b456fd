"""Whether a vehicle holds a straight course by itself, helm amidships."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.attitude import attitude_angles
from dq_marine.algebra.quaternion import quaternion_multiply
from dq_marine.manoeuvres.run import Run

Array = NDArray[np.float64]

PERTURBATION = 1e-5
"""Size of the differences in sway, roll rate and yaw rate, in units of speed and length, and in roll [rad]."""

PROBED = 0.5
"""Times of one length over which a deviation is followed."""

NEUTRAL = 1e-3
"""Growth or decay in the time of one length that is taken for none."""


def course_growth_rate(run: Run) -> float:
    """Return the growth rate of small deviations from the steady straight run that a run is on, helm amidships [1/s].

    That of the linear map that takes deviations of sway, roll rate, yaw rate and roll over a short time, measured on
    the whole model by central differences: all its forces count, whatever they are. Heading and place do not: a
    vehicle on a straight course does not know them. Negative where the vehicle comes to rest on a new straight course.
    """
    duration = PROBED * run.setup.time_scale
    samples = max(1, round(duration / run.setup.sample_period))
    scales = _scales(run)
    columns = [
        (_carried(run, axis, PERTURBATION, samples) - _carried(run, axis, -PERTURBATION, samples))
        / (2.0 * PERTURBATION)
        / scales
        for axis in range(4)
    ]
    largest = float(np.abs(np.linalg.eigvals(np.column_stack(columns))).max())
    rate = math.log(max(largest, 1e-300)) / (samples * run.setup.sample_period)
    return 0.0 if abs(rate) * run.setup.time_scale < NEUTRAL else rate


def _scales(run: Run) -> Array:
    speed, length = run.setup.full_speed, run.setup.length
    return np.array([speed, speed / length, speed / length, 1.0])


def _carried(run: Run, axis: int, size: float, samples: int) -> Array:
    """Return sway, roll rate, yaw rate and roll some samples after a state that is off by `size` in one of them."""
    setup = run.setup
    probe = Run(setup, "course stability", 0.0)
    deviation = np.zeros(4)
    deviation[axis] = size * _scales(run)[axis]
    half_roll = 0.5 * float(deviation[3])
    attitude = quaternion_multiply(
        tuple(run.body.quaternion_body_to_ned.tolist()), (math.cos(half_roll), math.sin(half_roll), 0.0, 0.0)
    )
    velocity = run.body.velocity_body + np.array([0.0, *deviation[:1], 0.0, deviation[1], 0.0, deviation[2]])
    probe.displace(run, attitude, velocity)
    for _ in range(samples):
        probe.steer(setup.conditions.throttle, 0.0)
    _, sway, _, roll_rate, _, yaw_rate = probe.body.velocity_body
    roll, _, _ = attitude_angles(probe.body.quaternion_body_to_ned)
    return np.array([sway, roll_rate, yaw_rate, roll])
