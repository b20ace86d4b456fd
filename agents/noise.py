"""Noise in actions: what is flown with it tells what actions other than an agent's own lead to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.marine_env import Action


def with_noise(action: NDArray[np.floating], noise: float, random: np.random.Generator) -> Action:
    """Return an action with normal noise of a standard deviation, cut at -1 and 1."""
    drawn = noise * random.standard_normal(action.shape)
    return np.clip(action + drawn, -1.0, 1.0).astype(np.float32)
