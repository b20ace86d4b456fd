"""Keeping simulated time in step with the clock on the wall."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from dq_marine.errors import InvalidInputError


class RealTimePacer:
    """Slows a simulation down to real time, or to a multiple of it.

    A simulation that cannot keep up is not asked to catch up later: the pacer forgives the delay, so
    that motion stays even instead of coming in bursts.
    """

    def __init__(
        self,
        speed: float = 1.0,
        *,
        forgiven_delay: float = 0.1,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Start with the first `wait_until`.

        Args:
            speed: simulated seconds per second on the wall.
            forgiven_delay: a simulation later than this [s, wall] starts its count anew.
            clock: the time on the wall [s].
            sleep: waits for so many seconds.

        Raises:
            InvalidInputError: `speed` is not a finite number above 0.
        """
        if not (math.isfinite(speed) and speed > 0.0):
            raise InvalidInputError(f"speed is {speed}; give a finite number above 0, 1 for real time")
        self._speed = speed
        self._forgiven_delay = forgiven_delay
        self._clock = clock
        self._sleep = sleep
        self._started: tuple[float, float] | None = None

    def wait_until(self, sim_time: float) -> None:
        """Return when the wall clock has reached a simulated time [s].

        Simulated time that goes backwards, as at the start of a new episode, starts the count anew.
        """
        now = self._clock()
        if self._started is None or sim_time < self._started[1]:
            self._started = (now, sim_time)
            return
        wall_start, sim_start = self._started
        ahead = wall_start + (sim_time - sim_start) / self._speed - now
        if ahead > 0.0:
            self._sleep(ahead)
        elif ahead < -self._forgiven_delay:
            self._started = (now, sim_time)
