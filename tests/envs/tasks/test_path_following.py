"""Path following: where episodes begin, what is measured and shown, and what counts as success."""

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader, shown_names
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle

PATH_FOLLOWING = "dq_marine/PathFollowing-v0"


def env_of(**keywords):
    return gym.make(PATH_FOLLOWING, **keywords).unwrapped


def flown(env, seed):
    """The infos of an episode that the baseline flies, and whether it was terminated."""
    controller = controller_for(env)
    observation, info = env.reset(seed=seed)
    controller.reset(env)
    infos, terminated = [info], False
    while not terminated and len(infos) < 3000:
        observation, _, terminated, _, info = env.step(controller.act(observation))
        infos.append(info)
    return infos, terminated


def test_episodes_begin_beside_the_path_under_way_about_along_it():
    env = env_of()
    length, speed = env.vehicle.dimensions.length, cruising_speed(env.vehicle)
    read = parts_reader(env, shown_names(env))
    for seed in range(20):
        observation, info = env.reset(seed=seed)
        parts = read(observation)
        assert abs(parts["starboard_of_path"][0]) == pytest.approx(info["cross_track_error"], abs=1e-5)
        assert info["cross_track_error"] <= 0.5 * length
        assert 0.5 * speed <= parts["linear_velocity_body"][0] <= speed
        assert parts["path_ahead_body"][0] >= np.cos(np.radians(20.0)) - 1e-6
        assert parts["commanded_speed"][0] == pytest.approx(speed)


def test_success_is_the_end_of_the_path_reached_within_the_corridor_at_the_speed():
    infos, terminated = flown(env_of(), 1)
    assert terminated
    assert infos[-1]["is_success"]
    assert infos[-1]["share_done"] == 1.0
    assert not any(info["is_success"] for info in infos[:-1])
    done = [float(info["share_done"]) for info in infos]
    assert min(np.diff(done)) > -1e-3
    counted = [info for info in infos if info["share_done"] >= 0.25]
    largest = max(info["cross_track_error"] for info in counted)
    assert infos[-1]["worst_error"] == pytest.approx(largest)
    assert largest < 0.5
    assert infos[-1]["reward/finish"] == 10.0


def test_a_path_that_is_left_ends_the_episode_without_success():
    env = env_of()
    env.reset(seed=0)
    terminated = False
    for _ in range(1500):
        *_, terminated, _, info = env.step(np.array([0.5, 0.0, 1.0], np.float32))
        if terminated:
            break
    assert terminated
    assert info["cross_track_error"] > 5.0 * env.vehicle.dimensions.length
    assert not info["is_success"]


def test_the_end_at_a_wrong_speed_is_no_success():
    """The same flight, measured by another commanded speed."""
    env = env_of()
    controller = controller_for(env)
    observation, _ = env.reset(seed=1)
    controller.reset(env)
    place = int(np.flatnonzero(np.cumsum([one.size for one in env.observations]) > 0)[0])
    assert place == 0
    names, sizes = shown_names(env), [one.size for one in env.observations]
    at = sum(sizes[: names.index("commanded_speed")])
    terminated = False
    while not terminated:
        observation = observation.copy()
        observation[at] *= 0.7
        observation, _, terminated, _, info = env.step(controller.act(observation))
    assert info["share_done"] == 1.0
    assert info["mean_speed_error"] == pytest.approx(0.3 * cruising_speed(env.vehicle), rel=0.1)
    assert not info["is_success"]


def test_paths_of_what_floats_are_level_and_scale_with_the_vehicle():
    for name in ("otter", "remus100"):
        vehicle = load_vehicle(name)
        env = env_of(vehicle=name)
        numbers = env.episode_parameters({}).task
        assert numbers.leg == max(8.0 * vehicle.dimensions.length, 10.0 * cruising_speed(vehicle))
        assert (numbers.climb == 0.0) == (name == "otter")


@pytest.mark.parametrize("name", ["speed", "leg", "turn", "climb"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far"])
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        env_of(**{name: value})


@pytest.mark.sweep
@pytest.mark.parametrize("vehicle", ["otter", "supply_vessel"])
def test_the_baseline_follows_the_path_in_waves(vehicle):
    env = env_of(vehicle=vehicle, level="waves")
    assert env.time_varying
    infos, terminated = flown(env, seed=1)
    assert terminated
    assert infos[-1]["is_success"]
