"""Flight over a charted seabed: where episodes are on it, what beams tell of it, and lanes that equal singles."""

import copy
import math
import pickle

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.charts import SeabedChart
from dq_marine.envs.core.shared_memory import parameters_of, task_memory
from dq_marine.errors import InvalidInputError
from dq_marine.task.grounds import ChartPlace, grounds_of
from dq_marine.task.things import Relief

TERRAIN, PIPELINE = "dq_marine/TerrainFollowing-v0", "dq_marine/PipelineInspection-v0"
QUIET = {"noise": 0.0, "dropout": 0.0, "current": None}
SPACING, NORTHS, EASTS = 1.5, np.arange(70) * 1.5, np.arange(60) * 1.5
DEPTHS = 40.0 + 1.6 * np.add.outer(np.sin(2.0 * np.pi / 30.0 * NORTHS), np.cos(2.0 * np.pi / 40.0 * EASTS))
SEABED = SeabedChart(DEPTHS, SPACING, "hills")


def made(task, **keywords):
    return gym.make(task, **{"seabed": SEABED, **QUIET, **keywords}).unwrapped


def ground_below(env):
    """The depth of the seabed at places of the episode's NED frame, and where the chart's first sample is."""
    flight, place = parameters_of(env).task.flight, task_memory(env).ground
    grounds = grounds_of(flight, 4)
    return lambda north, east: grounds.depth(grounds.whole(flight, place), north, east), place


@pytest.mark.parametrize("task", [TERRAIN, PIPELINE])
def test_each_episode_is_at_a_place_of_its_own_on_the_chart(task):
    env, places = made(task), []
    for seed in range(20):
        env.reset(seed=seed)
        depth, place = ground_below(env)
        places.append(place)
        for row, column in ((0, 0), (3, 8), (69, 59)):
            at = (place.north + SPACING * row, place.east + SPACING * column)
            assert depth(*at) == pytest.approx(DEPTHS[row, column], abs=1e-9)
        goal = env.definition.goal(parameters_of(env).task, task_memory(env))
        ends = [(0.0, 0.0)] if goal is None else [(0.0, 0.0), goal.position_ned[:2]]
        for end in ends:
            assert -1e-9 <= end[0] - place.north <= NORTHS[-1] + 1e-9
            assert -1e-9 <= end[1] - place.east <= EASTS[-1] + 1e-9
    assert len(set(places)) == 20


def test_the_altimeter_tells_the_altitude_over_the_chart():
    env = made(TERRAIN)
    read = parts_reader(env, ("altimeter_reading", "down_body"))
    for seed in range(20):
        parts = read(env.reset(seed=seed)[0])
        position = env.position_ned
        altitude = ground_below(env)[0](*position[:2]) - position[2]
        assert parts["altimeter_reading"][
            0
        ] * env.task_settings.reach * env.vehicle.dimensions.length == pytest.approx(altitude, rel=1e-5)


@pytest.mark.parametrize("task", [TERRAIN, PIPELINE])
def test_what_is_drawn_is_the_seabed_of_the_chart(task):
    env = made(task)
    env.reset(seed=3)
    depth, _ = ground_below(env)
    (relief,) = [thing.form for thing in env.snapshot().things if isinstance(thing.form, Relief)]
    found = np.reshape(relief.depths, (len(relief.norths), len(relief.easts)))
    assert found[7, 11] == pytest.approx(depth(relief.norths[7], relief.easts[11]))


@pytest.mark.sweep
def test_environments_travel_with_their_chart_and_go_on_bit_for_bit():
    env = made(TERRAIN)
    env.reset(seed=1)
    others = [pickle.loads(pickle.dumps(env)), copy.deepcopy(env)]
    restored = made(TERRAIN)
    restored.set_state(env.get_state())
    action = np.array([0.6, 0.1, -0.1], dtype=np.float32)[: env.action_space.shape[0]]
    for _ in range(3):
        observation, reward, *_ = env.step(action)
        for other in (*others, restored):
            again, same, *_ = other.step(action)
            assert np.array_equal(again, observation)
            assert same == reward
    assert all(other.seabed == SEABED for other in others)


@pytest.mark.parametrize(
    ("task", "keywords", "message"),
    [
        (TERRAIN, {"track": 70.0}, r"hills is 103.5 m long and 88.5 m wide.*93.* m over it.*smaller track"),
        (PIPELINE, {"leg": 17.0}, r"90.* m over it.*smaller leg"),
        (
            TERRAIN,
            {"altitude": 14.0, "reach": 30.0},
            r"hills is 36.8.* m deep.*altitude of 18.6.* m,.*37.3.* m deep",
        ),
        (TERRAIN, {"seabed": "nowhere.tif"}, "no such file"),
    ],
)
def test_a_chart_that_is_too_small_or_too_shallow_is_refused(task, keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        made(task, **keywords)


def test_the_seabed_holds_as_long_as_the_environment_does():
    env = made(TERRAIN)
    for seabed in (None, SEABED):
        with pytest.raises(InvalidInputError, match="make another one with seabed="):
            env.seabed = seabed
    env.altitude = 5.0
    assert (env.altitude, env.seabed) == (5.0, SEABED)


def test_places_are_those_of_the_uniform_numbers_whichever_way_the_track_goes():
    env = made(TERRAIN)
    flight = env.episode_parameters({}).task.flight
    drawn = grounds_of(flight, 4).drawn
    north, east = NORTHS[-1], EASTS[-1]
    course, length = math.atan2(20.0, 50.0), math.hypot(50.0, 20.0)  # 50 m one way, 20 m the other
    assert drawn(flight, course, length, (0.0, 0.0), 0) == ChartPlace(0.0, 0.0)
    there = drawn(flight, math.pi - course, length, (0.0, 1.0), 0)
    assert there == pytest.approx((-50.0, 20.0 - east))
    there = drawn(flight, math.pi + course, length, (1.0, 0.5), 0)
    assert there == pytest.approx((-north, -0.5 * (east + 20.0)))


@pytest.mark.sweep
def test_lanes_over_a_chart_have_the_bits_of_single_environments():
    vector = gym.make_vec(PIPELINE, num_envs=9, seabed=SEABED, max_episode_steps=7)
    singles = [gym.make(PIPELINE, seabed=SEABED, max_episode_steps=7) for _ in range(9)]
    found, _ = vector.reset(seed=5)
    assert np.array_equal(found, [one.reset(seed=5 + i)[0] for i, one in enumerate(singles)])
    rng, over = np.random.default_rng(0), [False] * 9
    for _ in range(20):
        actions = rng.uniform(-1.0, 1.0, vector.action_space.shape).astype(np.float32)
        found = vector.step(actions)[0]
        for i, one in enumerate(singles):
            if over[i]:
                alone, over[i] = one.reset()[0], False
            else:
                alone, _, terminated, truncated, _ = one.step(actions[i])
                over[i] = terminated or truncated
            assert np.array_equal(found[i], alone)


@pytest.mark.sweep
def test_the_controller_follows_the_terrain_of_a_chart():
    env = gym.make(TERRAIN, **{"seabed": SEABED, **QUIET})
    controller = controller_for(env)
    assert all(fly_episode(env, controller, seed=seed).success for seed in range(4))
