"""What an agent is given: the flat numbers that a task's formulas return, or a dictionary of parts of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.definition import PARTS, PRIVILEGED, Observed

Observation = NDArray[np.float32] | dict[str, NDArray[np.float32]]

Places = Mapping[str, NDArray[np.intp]]
"""Where the numbers of each part are among the flat ones."""


def places_of(observations: Sequence[Observed]) -> Places | None:
    """Return where the parts of an observation are; None if it has none, as that of most tasks."""
    part = np.array([one.part for one in observations for _ in range(one.size)])
    if (part == PARTS[0]).all():
        return None
    return {name: np.flatnonzero(part == name) for name in (*PARTS, PRIVILEGED) if (part == name).any()}


def observation_space(bound: NDArray[np.float32], places: Places | None) -> gym.Space[Any]:
    """Return the space of observations whose flat numbers have these bounds."""
    if places is None:
        return gym.spaces.Box(-bound, bound, dtype=np.float32)
    return gym.spaces.Dict(
        {name: gym.spaces.Box(-bound[own], bound[own], dtype=np.float32) for name, own in places.items()}
    )


def as_shown(flat: NDArray[np.float32], places: Places | None) -> Observation:
    """Return a copy of flat observations, shape (..., n), or of their parts."""
    if places is None:
        return flat.copy()
    return {name: flat[..., own] for name, own in places.items()}
