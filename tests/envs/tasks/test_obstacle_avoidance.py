"""Obstacle avoidance: what beams tell, what a collision is, and a controller that arrives where a blind one fails."""

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.avoidance import AvoidanceController
from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.backend.packing import unpack
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.envs.tasks.obstacle_avoidance import ROWS
from dq_marine.errors import InvalidInputError
from dq_marine.task.world.rangefinders import RANGE_FINDERS

ID = "dq_marine/ObstacleAvoidance-v0"
SEEDS = range(6)
BEAMS = RANGE_FINDERS["multibeam"].beams


def made(**keywords):
    return gym.make(ID, **keywords).unwrapped


def pillars_of(env):
    return unpack(env.blank_memory, env.get_state()["memory"]).passage.pillars


def flown(env, seed, blind=False):
    """The infos of an episode that the baseline flies, with its beams or without."""
    controller = controller_for(env)
    observation, info = env.reset(seed=seed)
    controller.reset(env)
    infos, terminated = [info], False
    while not terminated and len(infos) < 2000:
        if blind:
            observation = np.concatenate([np.ones(BEAMS, np.float32), observation[BEAMS:]])
        observation, _, terminated, _, info = env.step(controller.act(observation))
        infos.append(info)
    return infos


@pytest.fixture(scope="module")
def flights():
    """By seed, the episodes of the controller that sees and of the one that does not."""
    env = made(level="medium")
    return {seed: (flown(env, seed), flown(env, seed, blind=True)) for seed in SEEDS}


@pytest.mark.sweep  # whole episodes: the controller and beams by themselves are met in a plain run
def test_the_controller_arrives_where_a_blind_one_collides(flights):
    seeing = [one[-1]["is_success"] for one, _ in flights.values()]
    blind = [one[-1]["is_success"] for _, one in flights.values()]
    assert sum(seeing) >= len(SEEDS) - 1
    assert sum(blind) <= len(SEEDS) // 2


@pytest.mark.sweep
def test_a_collision_ends_the_episode_at_the_speed_of_the_impact(flights):
    ends = [one[-1] for pair in flights.values() for one in pair if one[-1]["clearance"] < 0.0]
    assert ends
    for end in ends:
        assert end["impact_speed"] > 0.0
        assert end["reward/collision"] == -10.0
        assert not end["is_success"]


@pytest.mark.sweep
def test_success_is_the_goal_reached_with_room_to_spare_all_the_way(flights):
    length = made().vehicle.dimensions.length
    for infos, _ in flights.values():
        if infos[-1]["is_success"]:
            assert infos[-1]["goal_distance"] < length
            assert min(float(info["clearance"]) for info in infos) >= 0.0
            assert all(info["impact_speed"] == 0.0 for info in infos)
            assert not any(info["is_success"] for info in infos[:-1])


def test_episodes_begin_under_way_about_towards_a_goal_beyond_the_field():
    env = made()
    length, speed = env.vehicle.dimensions.length, cruising_speed(env.vehicle)
    read = parts_reader(env, AvoidanceController.READS)
    for seed in range(20):
        observation, info = env.reset(seed=seed)
        parts = read(observation)
        assert info["goal_distance"] == pytest.approx((ROWS + 1.0) * 6.0 * length)
        assert parts["goal_distance"][0] == pytest.approx(info["goal_distance"], rel=1e-6)
        assert parts["goal_direction_body"][0] >= np.cos(np.radians(30.0)) - 1e-6
        assert 0.5 * speed <= parts["linear_velocity_body"][0] <= speed
        assert info["clearance"] > 2.0 * length


def test_readings_without_errors_are_exact_and_with_dropout_some_are_lost():
    quiet, noisy, lossy = (
        made(noise=noise, dropout=dropout) for noise, dropout in ((0.0, 0.0), (0.02, 0.0), (0.0, 0.5))
    )
    off, lost, met = [], 0, 0
    for seed in range(40):
        exact, told, holed = (env.reset(seed=seed)[0][:BEAMS] for env in (quiet, noisy, lossy))
        echo = exact < 0.9
        off += (told - exact)[echo].tolist()
        met += int(echo.sum())
        lost += int((holed[echo] == 1.0).sum())
        assert np.array_equal(holed[holed < 1.0], exact[holed < 1.0])
    assert np.std(off) == pytest.approx(0.02, rel=0.15)
    assert lost / met == pytest.approx(0.5, abs=0.1)


def test_errors_are_drawn_anew_in_every_period():
    env = made(noise=0.05)
    first, _ = env.reset(seed=3)
    adrift = np.zeros(env.action_space.shape, np.float32)
    seen = [first[:BEAMS], *(env.step(adrift)[0][:BEAMS] for _ in range(4))]
    echoes = np.array(seen)[:, np.max(seen, axis=0) < 1.0]
    assert echoes.shape[1] > 2
    assert (np.abs(np.diff(echoes, axis=0)) > 1e-4).all(axis=0).any()


def test_pillars_move_at_the_speed_that_is_told():
    still, moving = made(), made(pillar_speed=1.0)
    changed = []
    for env in (still, moving):
        env.reset(seed=1)
        before = pillars_of(env)
        env.step(np.zeros(env.action_space.shape, np.float32))
        after = pillars_of(env)
        changed.append(
            [np.hypot(b.north - a.north, b.east - a.east) for a, b in zip(before, after, strict=True)]
        )
    assert max(changed[0]) == 0.0
    largest = cruising_speed(moving.vehicle) * moving.control_period
    assert 0.0 < max(changed[1]) <= largest
    assert sum(way > 0.0 for way in changed[1]) == len(changed[1]) // 2


@pytest.mark.parametrize("name", ["spacing", "pillar_speed", "reach", "noise", "dropout", "arrival_radius"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far"])
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        made(**{name: value})
