"""Which of a range sensor's readings are new, and how long ago they were taken."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.observed import RANGE_AGES


class Fresh(NamedTuple):
    """What is new since the last observation.

    Attributes:
        beams: whether a beam's reading is, shape (n,).
        age: of those that are [s].
    """

    beams: NDArray[np.bool_]
    age: float


class FreshReadings:
    """Tells by the ages that an environment shows which readings are new; all are where it shows none."""

    def __init__(self, env: MarineEnv, beams: int) -> None:
        """Take an environment with a range sensor of so many beams."""
        schedule = env.ping_schedule
        self.reads = () if schedule is None else (RANGE_AGES,)
        self._all = Fresh(np.ones(beams, np.bool_), 0.0)
        self._beams_of_turn = 1 if schedule is None else beams // schedule.turns
        self._aged = 0.5 * env.control_period
        self.reset()

    def reset(self) -> None:
        """Forget the episode before."""
        self._ages: NDArray[np.float64] | None = None

    def of(self, parts: dict[str, Any]) -> Fresh:
        """Return what is new in an observation, whose parts `reads` are given by name."""
        if not self.reads:
            return self._all
        ages, before = parts[RANGE_AGES], self._ages
        self._ages = ages
        if before is None:
            return self._all._replace(age=float(ages[0]))
        # What is not new has aged by a control period.
        new = ages < before + self._aged
        age = float(ages[new].min()) if new.any() else 0.0
        return Fresh(np.repeat(new, self._beams_of_turn), age)
