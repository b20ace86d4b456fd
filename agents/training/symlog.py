"""Observations by the logarithm of their size, before they are normalised: near and far are told apart alike.

A vessel that comes alongside from a thousand metres must tell one metre from two, which running means and deviations
of metres make the same number. symlog(x) = sign(x) ln(1 + |x|), in SI units (Hafner et al. 2025, Nature 640, 647, as
DreamerV3 has it), leaves numbers below 1 nearly as they are, and gives each tenfold of the rest the same room.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.running_mean_std import RunningMeanStd
    from stable_baselines3.common.vec_env import VecEnv, VecNormalize


def symlog(x: NDArray[Any]) -> NDArray[Any]:
    """Return sign(x) ln(1 + |x|), entry by entry."""
    told: NDArray[Any] = np.sign(x) * np.log1p(np.abs(x))
    return told


def symexp(y: NDArray[Any]) -> NDArray[Any]:
    """Return what `symlog` makes y of."""
    meant: NDArray[Any] = np.sign(y) * np.expm1(np.abs(y))
    return meant


class SymlogMeanStd(RunningMeanStd):
    """Running mean and variance of symlog."""

    def update(self, arr: NDArray[Any]) -> None:
        """Take in a batch of what symlog is taken of."""
        super().update(symlog(arr))


class SymlogNormalize(VecNormalize):
    """`VecNormalize` whose observations are normalised after their symlog was taken."""

    def __init__(self, venv: VecEnv, **options: Any) -> None:
        """Take the environments, and the options of `VecNormalize`."""
        super().__init__(venv, **options)
        if self.norm_obs:
            of_numbers: Any = self.obs_rms
            running: Any = (
                {name: SymlogMeanStd(shape=one.mean.shape) for name, one in of_numbers.items()}
                if isinstance(of_numbers, dict)
                else SymlogMeanStd(shape=of_numbers.mean.shape)
            )
            self.obs_rms = running

    def _normalize_obs(self, obs: NDArray[Any], obs_rms: RunningMeanStd) -> NDArray[Any]:
        normalised: NDArray[Any] = super()._normalize_obs(symlog(obs), obs_rms)
        return normalised

    def _unnormalize_obs(self, obs: NDArray[Any], obs_rms: RunningMeanStd) -> NDArray[Any]:
        return symexp(super()._unnormalize_obs(obs, obs_rms))
