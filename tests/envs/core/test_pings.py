"""Range sensors that ping now and then, beam by beam, and tell late: as a prompt one, held, and with ages."""

import copy
import math
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from support.separate import Separate, assert_flights_agree
from support.sweeps import sweep

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.dead_reckoning import carried
from dq_marine.agents.controllers.fresh_readings import FreshReadings
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.envs.core.observed import RANGE_AGES
from dq_marine.envs.core.range_settings import ping_schedule
from dq_marine.errors import InvalidInputError
from dq_marine.task.world.rangefinders import RANGE_FINDERS

OBSTACLES = "ObstacleAvoidance"
PERIODS = 60
CASES = {
    "slow": {"rate": 2.0},
    "late": {"latency": 0.1},
    "slow and late": {"rate": 2.0, "latency": 0.3},
    "as late as slow": {"rate": 2.5, "latency": 0.4},
    "scanning": {"range_finder": "scanning"},
    "scanning slowly": {"range_finder": "scanning", "rate": 5.0, "latency": 0.1},
}
PLAIN = ["slow and late"]
READINGS = {OBSTACLES: ("beam_readings",), "PipelineInspection": ("sonar_readings",)}
READINGS["TerrainFollowing"] = ("ground_ahead_readings", "altimeter_reading")


def made(task=OBSTACLES, **keywords):
    return gym.make(f"dq_marine/{task}-v0", control_period=0.1, **keywords).unwrapped


def watched(env, task=OBSTACLES, periods=PERIODS, seed=4):
    """What is read of each observation, from the start on: readings, ages, and all else that is shown."""
    aged = env.ping_schedule is not None
    names = [one.name for one in env.observations]
    read = parts_reader(env, names)
    env.action_space.seed(seed)
    shown = [env.reset(seed=seed)[0]]
    shown += [env.step(0.3 * env.action_space.sample())[0] for _ in range(periods)]
    parts = [read(one) for one in shown]
    readings = np.array([np.concatenate([one[name] for name in READINGS[task]]) for one in parts])
    others = [name for name in names if name not in (*READINGS[task], RANGE_AGES)]
    return (
        readings,
        np.array([one[RANGE_AGES] for one in parts]) if aged else None,
        np.array([np.concatenate([one[name] for name in others]) for one in parts]),
    )


def expected(readings, schedule):
    """The readings and ages that a schedule makes of those of every period: by ping, from its definition."""
    told, pinged = readings[0].copy(), np.zeros(schedule.turns)
    own, held, ages = schedule.beams // schedule.turns, [told.copy()], [pinged.copy()]
    for period in range(1, len(readings)):
        number, rest = divmod(period - schedule.latency, schedule.interval)
        if rest == 0 and number >= 1:
            turn = (number - 1) % schedule.turns
            ping = number * schedule.interval
            told[turn * own : (turn + 1) * own] = readings[ping, turn * own : (turn + 1) * own]
            pinged[turn] = ping
        held.append(told.copy())
        ages.append(schedule.period * (period - pinged))
    return np.array(held), np.array(ages)


@pytest.mark.parametrize("case", sweep(CASES, plain=PLAIN))
def test_what_is_told_is_what_a_prompt_sensor_read_at_the_last_ping(case):
    scheduled = made(**CASES[case])
    readings, _, others = watched(made())
    told, ages, same = watched(scheduled)
    held, old = expected(readings, scheduled.ping_schedule)
    assert np.array_equal(told, held)
    np.testing.assert_allclose(ages, old, atol=1e-5)
    assert np.array_equal(same, others)
    assert len(np.unique(told, axis=0)) > 3


@pytest.mark.sweep  # each is a compilation of its own
@pytest.mark.parametrize("task", list(READINGS)[1:])
def test_sonars_over_ground_ping_now_and_then_too(task):
    keywords = {"rate": 2.0, "latency": 0.2}
    scheduled = made(task, **keywords)
    readings, _, others = watched(made(task), task)
    told, _, same = watched(scheduled, task)
    assert np.array_equal(told, expected(readings, scheduled.ping_schedule)[0])
    assert np.array_equal(same, others)


@pytest.mark.sweep  # lanes take longest to compile
@pytest.mark.parametrize("case", CASES)
def test_lanes_ping_as_single_environments_do(case):
    keywords = {**CASES[case], "control_period": 0.1, "max_episode_steps": 25, "sensors": "auv"}
    name = f"dq_marine/{OBSTACLES}-v0"
    envs = gym.make_vec(name, num_envs=3, **keywords)
    assert_flights_agree(envs, Separate(3, name, **keywords), 60, seed=2)


def test_an_episode_is_saved_copied_and_carried_with_what_is_under_way():
    keywords = CASES["slow and late"]
    env = made(**keywords)
    watched(env, periods=7)
    twins = [copy.deepcopy(env), pickle.loads(pickle.dumps(env)), made(**keywords)]
    twins[2].set_state(env.get_state())
    for _ in range(6):
        action = env.action_space.sample()
        own = env.step(action)[0]
        assert all(np.array_equal(twin.step(action)[0], own) for twin in twins)


def test_gymnasiums_checker_passes():
    check_env(made(**CASES["slow and late"]), skip_render_check=True)


def test_what_is_drawn_is_what_was_told():
    env = made(**CASES["slow and late"], observation_delay=0)
    told, _, _ = watched(env, periods=8)
    beams = env.snapshot().beams
    np.testing.assert_allclose([one.distance / one.reach for one in beams], told[-1], rtol=1e-6)


def test_a_lidar_sees_all_round_and_only_above_the_water():
    env = made(range_finder="lidar", vehicle="otter", reach=40.0, noise=0.0, dropout=0.0)
    finder = RANGE_FINDERS["lidar"]
    env.reset(seed=0)
    beams = env.snapshot().beams
    assert len(beams) == finder.beams == 48
    angles = np.sort([math.atan2(one.direction_body[1], one.direction_body[0]) for one in beams])
    np.testing.assert_allclose(np.diff(angles), math.tau / finder.beams, atol=1e-12)
    with pytest.raises(InvalidInputError, match=r"lidar.*above the water.*multibeam"):
        made(range_finder="lidar")


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"rate": 0.0}, "rate"),
        ({"rate": math.nan}, "rate"),
        ({"latency": -0.1}, "latency"),
        ({"latency": 0.2}, r"latency = 0\.2 s, but the next ping follows after 0\.1 s.*at most that$"),
        ({"rate": 2.0, "latency": 0.6}, r"after 0\.5 s.*or a lower rate$"),
        ({"range_finder": "radar"}, "range_finder.*multibeam"),
        ({"beams": 7}, "beams = 7 is odd.*even"),
        ({"beams": 1000}, "beams"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        made(**keywords)


@pytest.mark.parametrize("name", ["rate", "latency", "range_finder", "beams"])
def test_what_pings_holds_as_long_as_the_environment(name):
    env = made()
    with pytest.raises(InvalidInputError, match="make another one"):
        setattr(env, name, getattr(env, name))


def test_a_sensor_that_always_tells_at_once_has_no_schedule():
    settings = made(rate=10.0).task_settings
    assert ping_schedule(settings, 24, 1, 0.1) is None
    assert ping_schedule(settings, 24, 24, 0.1).turns == 24
    assert ping_schedule(made(rate=3.0).task_settings, 24, 1, 0.1).interval == 4


def test_controllers_take_each_reading_once_and_where_it_was():
    env = made(**CASES["slow and late"])
    fresh = FreshReadings(env, 24)
    read = parts_reader(env, (RANGE_AGES,))
    env.reset(seed=0)
    seen = [fresh.of(read(env.observation))]
    adrift = np.zeros(env.action_space.shape, np.float32)
    seen += [fresh.of(read(env.step(adrift)[0])) for _ in range(20)]
    assert [bool(one.beams.any()) for one in seen] == [k == 0 or (k > 5 and k % 5 == 3) for k in range(21)]
    assert all(one.age == pytest.approx(0.3, abs=1e-5) for one in seen[1:] if one.beams.any())
    # 2 m ahead of where the vehicle was: it has gone 1 m on, and turned to starboard by a right angle.
    np.testing.assert_allclose(
        carried(np.array([[2.0, 0.0]]), (1.0, 0.0), math.pi / 2), [[0.0, -1.0]], atol=1e-12
    )


@pytest.mark.sweep  # whole episodes
@pytest.mark.parametrize("case", ["slow and late", "scanning"])
def test_the_baseline_arrives_by_what_it_is_told_now_and_then(case):
    env = made(level="medium", **CASES[case])
    controller, arrived = controller_for(env), 0
    for seed in range(6):
        observation, info = env.reset(seed=seed)
        controller.reset(env)
        ended = False
        while not ended:
            observation, _, terminated, truncated, info = env.step(controller.act(observation))
            ended = terminated or truncated or env.time > 300.0
        arrived += bool(info["is_success"])
    assert arrived >= 5
