"""Radiation memory in environments: saved with the episode, alone and in lanes, with vehicles that are drawn."""

import numpy as np
import pytest
from support.environments import StationKeepingEnv, StationKeepingVectorEnv

from dq_marine.envs.core.vehicle_pool import prepared_pool
from dq_marine.simulation.settings import Settings

KEYWORDS = {"vehicle": "supply_vessel", "radiation": "memory", "current": 0.2}


def actions(env, periods, seed=1):
    """Random actions for an environment."""
    size = env.single_action_space.shape if hasattr(env, "single_action_space") else env.action_space.shape
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (periods, *size)).astype(np.float32)


@pytest.mark.sweep
def test_an_episode_goes_on_where_it_was_saved():
    env = StationKeepingEnv(**KEYWORDS)
    env.reset(seed=3)
    given = actions(env, 40)
    for action in given[:20]:
        env.step(action)
    saved = env.get_state()
    assert saved["state"].shape == (14 + 24,)
    assert np.abs(saved["state"][14:]).max() > 1.0
    first = [env.step(action)[0] for action in given[20:]]
    env.reset(seed=8)
    assert not env.get_state()["state"][14:].any()
    env.set_state(saved)
    again = [env.step(action)[0] for action in given[20:]]
    assert np.array_equal(first, again)
    assert StationKeepingEnv(settings=Settings.from_json(env.settings.to_json())).scene.radiation == "memory"


@pytest.mark.sweep  # tests/physics/radiation has bodies in lanes
@pytest.mark.slow
def test_environments_in_lanes_have_the_bits_of_single_ones():
    many = StationKeepingVectorEnv(3, **KEYWORDS)
    together, _ = many.reset(seed=5)
    given = actions(many, 30)
    seen = [together]
    seen += [many.step(np.tile(action, (3, 1)))[0] for action in given]
    for index in range(3):
        env = StationKeepingEnv(**KEYWORDS)
        alone, _ = env.reset(seed=5 + index)
        assert np.array_equal(alone, seen[0][index])
        for action, observed in zip(given, seen[1:], strict=True):
            assert np.array_equal(env.step(action)[0], observed[index])


def test_drawn_vehicles_share_one_model():
    pool = prepared_pool(
        Settings(vehicle="supply_vessel", radiation="memory", randomise="default", vehicle_pool=4)
    )
    masses = {parameters.timing.memory.velocity for parameters in pool.parameters}
    assert len(masses) == 4
    assert len({parameters.timing.memory.sections for parameters in pool.parameters}) == 1
