"""What an actor sees of observations that have a privileged part: all the rest, which is what is observed in flight."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym

from dq_marine.envs.core.definition import PARTS, PRIVILEGED
from dq_marine.envs.core.observation import Observation
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.vec_env import VecNormalize


def public_space(space: gym.Space[Any]) -> gym.Space[Any]:
    """Return the space of what is observed in flight: as it is, of observations without a privileged part."""
    if not isinstance(space, gym.spaces.Dict) or PRIVILEGED not in space.spaces:
        return space
    parts = public_parts(space)
    return parts[PARTS[0]] if set(parts.spaces) == {PARTS[0]} else parts


def public_parts(space: gym.spaces.Dict) -> gym.spaces.Dict:
    """Return a space of parts without the privileged one."""
    return gym.spaces.Dict({name: part for name, part in space.items() if name != PRIVILEGED})


def as_seen_by_actor(space: gym.Space[Any], observation: Observation) -> Observation:
    """Return an observation as the actor of a policy takes it, of an environment with a privileged part or without.

    Args:
        space: of the observations that the policy was trained with.
        observation: in flight.
    """
    seen = observation
    if isinstance(seen, Mapping):
        public = {name: part for name, part in seen.items() if name != PRIVILEGED}
        seen = public[PARTS[0]] if set(public) == {PARTS[0]} else public
    trained_in_parts = isinstance(space, gym.spaces.Dict)
    return {PARTS[0]: seen} if trained_in_parts and not isinstance(seen, Mapping) else seen


def normalise_public_alone(normalisation: VecNormalize) -> None:
    """Let a normalisation expect no privileged part from now on."""
    keys = normalisation.norm_obs_keys
    if keys is not None:
        normalisation.norm_obs_keys = [name for name in keys if name != PRIVILEGED]
