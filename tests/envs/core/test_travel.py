"""Environments travel, in the middle of an episode and to other processes, and go on bit for bit."""

import copy
import multiprocessing
import os
import pickle
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from support import fleet
from support.environments import STATION_KEEPING, WAYPOINT_TRACKING
from support.travellers import actions_of, begun, driven_by_wrenches, everything, flown

from dq_marine.simulation.scene import Scene

LENGTH = 6
KEYWORDS = {
    "wrenches": driven_by_wrenches(),
    "actuators": {"actuation": "thrusters", "vehicle": fleet.everything(), "current": 0.0},
    "everything": everything(),
}


def carried(env):
    return pickle.loads(pickle.dumps(env))


def maker(task, keywords, count):
    given = KEYWORDS[keywords] | {"max_episode_steps": LENGTH}
    return lambda: gym.make_vec(task, num_envs=count, **given) if count else gym.make(task, **given)


# What takes longest to compile goes with one task, and is compiled for other tests, too.
CASES = [
    *((task, "wrenches", count) for task in (STATION_KEEPING, WAYPOINT_TRACKING) for count in (0, 3)),
    (STATION_KEEPING, "actuators", 3),
    (STATION_KEEPING, "everything", 0),
]


@pytest.mark.slow
@pytest.mark.sweep  # `test_delays.py` carries an environment in a plain run
@pytest.mark.parametrize(("task", "keywords", "count"), CASES)
def test_an_environment_that_travelled_goes_on_bit_for_bit(task, keywords, count):
    make = maker(task, keywords, count)
    env = make()
    actions = actions_of(env.action_space, 2 * LENGTH)
    env = begun(lambda: env, actions[: LENGTH + 3])
    twins = [carried(env), copy.deepcopy(env), carried(copy.deepcopy(env))]
    own = flown(env, actions)
    for twin in twins:
        assert data_equivalence(own, flown(twin, actions), exact=True)
    env.close()


def test_a_scene_with_weather_and_forces_travels():
    given = everything()
    scene = Scene(**{name: given[name] for name in ("vehicle", "weather", "forces", "gravity", "current")})
    for twin in (carried(scene), copy.deepcopy(scene)):
        assert twin.composition == scene.composition
        assert twin.settings == scene.settings
        assert repr(twin.parameters_at(0.02)) == repr(scene.parameters_at(0.02))


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("context", "keywords"),
    [(c, k) for c in ("fork", "spawn") for k in ("wrenches", "everything")],
)
def test_workers_of_gymnasium_give_the_same_bits(context, keywords):
    make = maker(STATION_KEEPING, keywords, 0)
    here = gym.vector.SyncVectorEnv([make] * 2)
    there = gym.vector.AsyncVectorEnv([make] * 2, context=context)
    try:
        actions = actions_of(here.action_space, 2 * LENGTH)
        assert data_equivalence(here.reset(seed=4), there.reset(seed=4), exact=True)
        assert data_equivalence(flown(here, actions), flown(there, actions), exact=True)
    finally:
        there.close()


@pytest.mark.sweep  # those of Gymnasium do in a plain run
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_workers_of_stable_baselines3_give_the_same_bits(method):
    vec_env = pytest.importorskip("stable_baselines3.common.vec_env")
    make = maker(STATION_KEEPING, "wrenches", 0)
    here = vec_env.DummyVecEnv([make] * 2)
    there = vec_env.SubprocVecEnv([make] * 2, start_method=method)
    try:
        for envs in (here, there):
            envs.seed(4)
        assert np.array_equal(here.reset(), there.reset())
        for action in actions_of(here.action_space, 2 * LENGTH):
            both = np.stack([action, -action])
            for one, other in zip(here.step(both)[:3], there.step(both)[:3], strict=True):
                assert np.array_equal(
                    one, other.astype(one.dtype)
                )  # rewards in one are float32, in the other not
    finally:
        there.close()


OWN_TASK = """
from dq_marine.envs import kit
import dq_marine.envs.tasks.station_keeping as known

names = {name: value for name, value in vars(known).items() if not name.startswith("__")}
names["__name__"] = __name__
kit.define_task(
    names, id="outside/Hold-v0", summary="A task from outside.", draws=known.SLOW_START_DRAWS + 1,
    options={"goal_position": 3, "goal_quaternion": 4}, episode_fields=("position_ned", "attitude"),
)
"""


@pytest.mark.sweep
def test_a_task_from_outside_travels_to_workers(tmp_path, monkeypatch):
    """Its module is imported in a process that is started afresh, by the name before the colon."""
    (tmp_path / "own_task.py").write_text(OWN_TASK)
    monkeypatch.syspath_prepend(str(tmp_path))
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    monkeypatch.setenv("PYTHONPATH", path)
    make = OutsideTask("own_task:outside/Hold-v0")
    here = make()
    there = gym.vector.AsyncVectorEnv([make], context="spawn")
    try:
        assert np.array_equal(here.reset(seed=2)[0], there.reset(seed=2)[0][0])
        for action in actions_of(here.action_space, 5):
            assert np.array_equal(here.step(action)[0], there.step(action[None])[0][0])
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            assert np.array_equal(here.unwrapped.observation, pool.apply(observed, (pickle.dumps(here),)))
    finally:
        there.close()
        sys.modules.pop("own_task", None)


class OutsideTask:
    """Makes an environment, in whatever process."""

    def __init__(self, task):
        self.task = task

    def __call__(self):
        return gym.make(self.task)


def observed(carried_env):
    """What an environment observed, told by another process that knows no more than its pickle."""
    return pickle.loads(carried_env).unwrapped.observation
