"""One run of a setup: it is placed, steered sample by sample, and recorded."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.attitude import attitude_angles
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.manoeuvres.keepers import helmsman_of, planesman_of
from dq_marine.manoeuvres.recorder import Recorder, sample_of
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.setup import Setup
from dq_marine.manoeuvres.steering import Order

Watch = Callable[[str, float], None]
"""Told now and then what is being run, and the simulated time [s]."""

SETTLED = 5e-4
"""A quantity is steady when its mean over the time of one length changes by less than this share of its scale."""

LONGEST_SETTLING = 600
"""Times of one length."""

BODY = slice(1, 15)
"""Pose and momentum in a body's state; actuators stand behind."""

WATCH_EVERY = 100
"""Samples."""


def unwatched(phase: str, time: float) -> None:
    """Watch nothing."""


class Steady(NamedTuple):
    """The value at which a quantity settled.

    Attributes:
        value: mean over the last time of one length.
        settled: whether it had stopped changing, in the time that was given to it.
    """

    value: float
    settled: bool


class Run:
    """A setup under way, its depth held; it starts at a speed ahead, heading north.

    Attributes:
        setup: the setup.
        body: its state.
        heading: since the manoeuvre began, continuous [rad].
        sample: the latest.
    """

    def __init__(self, setup: Setup, phase: str, speed: float, watch: Watch = unwatched) -> None:
        self.setup = setup
        self.body = setup.scene.stepper()
        self.body.reset((0.0, 0.0, setup.depth), velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
        self.heading = 0.0
        self.sample = sample_of(self.body)
        moment = setup.steering.full_moment(setup.full_speed)
        self._helmsman = helmsman_of(setup.vehicle, setup.full_speed, moment)
        self._planesman = planesman_of(setup.vehicle, setup.full_speed)
        self._recorder = Recorder()
        self._phase, self._watch, self._samples = phase, watch, 0
        self._begin = 0.0

    @property
    def time(self) -> float:
        """Since the manoeuvre began [s]."""
        return self.sample.time - self._begin

    @property
    def speed(self) -> float:
        """Ahead [m/s]."""
        return float(self.sample.velocity_body[0])

    @property
    def yaw_rate(self) -> float:
        """About the body's z axis [rad/s]."""
        return float(self.sample.velocity_body[5])

    def displace(
        self, other: Run, quaternion_body_to_ned: Quaternion, velocity_body: NDArray[np.float64]
    ) -> None:
        """Take over the place and the actuators of another run of the setup, at another attitude and velocity."""
        self.body.reset(other.body.position_ned, quaternion_body_to_ned, velocity_body)
        state = other.body.get_state()
        state[BODY] = self.body.get_state()[BODY]
        self.body.set_state(state)
        self.sample = sample_of(self.body)

    def begin(self, lead: float) -> None:
        """Let the manoeuvre begin: time and heading count from here; `lead` of what came before is kept [s]."""
        self._begin = self.sample.time
        self._recorder.begin(self._begin, lead)
        self.heading = 0.0

    def steer(self, throttle: float, helm: float) -> None:
        """Advance by one sample under throttle and helm."""
        setup, before = self.setup, self.sample
        _, pitch, heading = attitude_angles(before.quaternion_body_to_ned)
        depth_error = float(before.position_ned[2]) - setup.depth
        heave, moment = self._planesman.heave_and_pitch(depth_error, pitch, before.velocity_body)
        self._recorder.add(before, throttle, helm)
        order = Order(throttle, helm, heave, moment)
        setup.steering.advance(self.body, order, float(before.velocity_body[0]), setup.sample_steps)
        self.sample = sample_of(self.body)
        turned = attitude_angles(self.sample.quaternion_body_to_ned)[2] - heading
        self.heading += math.remainder(turned, 2.0 * math.pi)
        self._samples += 1
        if self._samples % WATCH_EVERY == 0:
            self._watch(self._phase, self.time)

    def keep_heading(self, throttle: float) -> None:
        """Advance by one sample, the helm holding the heading at 0."""
        self.steer(throttle, self._helmsman.helm(self.heading, self.yaw_rate))

    def settle(
        self,
        advance: Callable[[], None],
        quantity: Callable[[], float],
        scale: float,
        longest: int = LONGEST_SETTLING,
    ) -> Steady:
        """Advance until the mean of a quantity over the time of one length is steady, as measured by its scale."""
        samples = max(1, round(self.setup.time_scale / self.setup.sample_period))
        mean, change = math.inf, math.inf
        for _ in range(longest):
            total = 0.0
            for _ in range(samples):
                advance()
                total += quantity()
            last_mean, last_change = mean, change
            mean = total / samples
            change = abs(mean - last_mean)
            if still_to_come(change, last_change) <= SETTLED * scale:
                return Steady(mean, True)
        return Steady(mean, False)

    def series(self) -> Series:
        """Return what was recorded, up to now."""
        return self._recorder.series(self.sample)


def still_to_come(change: float, last_change: float) -> float:
    """Return how far a quantity is from where it goes, if its changes go on shrinking as they did."""
    if change < last_change < math.inf:
        return change * change / (last_change - change)
    return 0.0 if change == 0.0 else math.inf
