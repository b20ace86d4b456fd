"""Station keeping of vessels that float, and of long ones: goals, starts and workspaces that suit them."""

import numpy as np
import pytest
from support.environments import StationKeepingEnv, StationKeepingVectorEnv

from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import Vehicle, load_vehicle


def radii(env):
    return env.start_radius, env.workspace_radius


@pytest.mark.parametrize("name", ["bluerov2", "bluerov2_heavy", "remus100"])
def test_short_vehicles_have_the_radii_and_the_goal_they_had(name):
    env = StationKeepingEnv(name)
    assert radii(env) == (2.0, 6.0)
    assert env.goal_position == (0.0, 0.0, 5.0)


def test_radii_grow_with_the_length():
    env = StationKeepingEnv("npsauv")
    assert radii(env) == pytest.approx((2.0 * 5.3 / 1.5, 6.0 * 5.3 / 1.5))
    assert radii(StationKeepingEnv("npsauv", workspace_radius=3.0)) == (2.0, 3.0)
    assert radii(StationKeepingEnv("npsauv", start_radius=1.0)) == (1.0, pytest.approx(21.2))


def test_a_vessel_starts_level_with_a_goal_where_it_is_at_rest():
    env = StationKeepingEnv("otter")
    assert env.goal_position == (0.0, 0.0, 0.0)
    places = []
    for seed in range(40):
        env.reset(seed=seed)
        places.append(env.position_ned)
    distances = np.linalg.norm(places, axis=1)
    assert np.abs(np.array(places)[:, 2]).max() < 1e-12
    assert 0.5 * env.start_radius < distances.max() <= env.start_radius
    env.reset(seed=0, options={"goal_position": (1.0, 2.0, 0.1), "position": (1.0, 2.0, -0.1)})
    assert env.position_ned == pytest.approx((1.0, 2.0, -0.1))


def test_a_vessel_that_drifts_stays_afloat_to_the_end_of_an_episode():
    env = StationKeepingEnv("otter", current=(0.1, 0.0, 0.0))
    env.reset(seed=3, options={"position": (0.0, 0.0, 0.0), "velocity": np.zeros(6)})
    for _ in range(100):
        _, _, terminated, _, info = env.step(np.zeros(2, np.float32))
        assert not terminated
        assert not info["refused"]
    # The load's static sinkage, and what is left of the transient.
    assert env.position_ned[2] == pytest.approx(0.04, abs=0.01)


@pytest.mark.sweep  # boxes and scenes capsize in tests/physics/hydrostatics
def test_a_vessel_may_capsize_in_an_environment():
    """By its two hulls it floats upside down as well."""
    env = StationKeepingEnv("otter", hydrostatics="hull", current=(0.0, 0.0, 0.0))
    assert any("hull" in term for term in env.scene.terms)
    env.reset(seed=0, options={"quaternion": (0.0, 1.0, 0.0, 0.0), "velocity": np.zeros(6)})
    for _ in range(200):
        env.step(np.zeros(2, np.float32))
    assert env.quaternion_body_to_ned[1] ** 2 > 0.9  # upside down still


@pytest.mark.sweep
def test_a_vector_of_vessels_is_the_single_one():
    single, envs = StationKeepingEnv("otter"), StationKeepingVectorEnv(3, vehicle="otter")
    observations, _ = envs.reset(seed=7)
    observation, _ = single.reset(seed=8)
    assert np.array_equal(observations[1], observation)
    rng = np.random.default_rng(0)
    for _ in range(20):
        actions = rng.uniform(-1.0, 1.0, (3, 2)).astype(np.float32)
        observations, rewards, *_ = envs.step(actions)
        observation, reward, *_ = single.step(actions[1])
        assert np.array_equal(observations[1], observation)
        assert rewards[1] == reward


def test_vehicles_of_different_length_need_a_common_workspace():
    supply = load_vehicle("supply_vessel")
    longer = supply.model_dump()
    longer["dimensions"]["length"] = 140.0
    vessels = [supply, Vehicle.model_validate(longer)]
    with pytest.raises(InvalidInputError, match=r"vehicle\[1\].*radii"):
        StationKeepingVectorEnv(2, vehicle=vessels)
    envs = StationKeepingVectorEnv(2, vehicle=vessels, workspace_radius=500.0)
    assert envs.get_attr("start_radius") == (pytest.approx(110.4), pytest.approx(500.0 / 3.0))
