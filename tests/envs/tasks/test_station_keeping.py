"""Station keeping: Gymnasium's contract, determinism, formulas, bad input, refusals."""

import copy
import json
import pickle
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from support.environments import StationKeepingEnv

import dq_marine  # noqa: F401 - registers
from dq_marine.envs.tasks.station_keeping import Weights
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.simulation.scene import Scene

ID = "dq_marine/StationKeeping-v0"


@pytest.fixture
def env():
    made = gym.make(ID)
    made.reset(seed=0)
    yield made
    made.close()


def same(a, b):
    """Whether two nested results of reset or step are bit for bit the same."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    return type(a) is type(b) and a == b


def roll_out(env, actions, **reset):
    return [env.reset(**reset), *(env.step(action) for action in actions)]


def actions_for(env, count, seed=0):
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.0, 1.0, (count, *env.action_space.shape)).astype(np.float32)


# Contract


@pytest.mark.parametrize("keywords", [{}, {"current": 0.0}, {"current": (0.2, 0.1, 0.0), "substeps": 1}])
def test_gymnasium_and_sb3_checkers_pass(keywords):
    from stable_baselines3.common.env_checker import check_env as check_env_sb3

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(ID, **keywords).unwrapped, skip_render_check=True)
        check_env_sb3(gym.make(ID, **keywords))


def test_the_id_works_in_a_process_that_has_not_imported_the_package():
    import subprocess
    import sys

    program = "import gymnasium as g; print(g.make('dq_marine:dq_marine/StationKeeping-v0').spec.id)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == ID


def test_types_are_pythons_and_keywords_json(env):
    _, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert type(reward) is float
    assert type(terminated) is bool
    assert type(truncated) is bool
    assert all(isinstance(value, np.ndarray | np.generic) for value in info.values())
    assert info["is_success"].dtype == info["refused"].dtype == np.bool_
    keywords = json.loads(json.dumps({"current": [0.1, 0.2, 0.0], "reward": {"effort": 0.1}, "substeps": 2}))
    gym.make(ID, **keywords).reset(seed=0)


def test_gym_make_truncates_after_30_s(env):
    for period in range(1, 301):
        *_, terminated, truncated, _ = env.step(np.zeros(6))
        assert not terminated
        assert truncated == (period == 300)
    assert env.unwrapped.time == pytest.approx(30.0)


# Determinism and state


@settings(max_examples=10)
@given(seed=st.integers(0, 2**31))
def test_an_episode_follows_from_its_seed_bit_for_bit(seed):
    one, two = StationKeepingEnv(), StationKeepingEnv()
    actions = actions_for(one, 20, seed)
    two.reset(seed=seed + 1)
    two.step(actions[0])
    assert same(roll_out(one, actions, seed=seed), roll_out(two, actions, seed=seed))
    assert same(one.reset(), two.reset())


@pytest.mark.parametrize("twin", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_alike(twin):
    env = StationKeepingEnv()
    actions = actions_for(env, 30)
    roll_out(env, actions[:10], seed=3)
    other = twin(env)
    assert same([env.step(a) for a in actions[10:]], [other.step(a) for a in actions[10:]])
    assert same(env.reset(), other.reset())


def test_state_round_trip():
    env, other = StationKeepingEnv(), StationKeepingEnv()
    actions = actions_for(env, 30)
    roll_out(env, actions[:10], seed=3)
    saved = env.get_state()
    first = [env.step(a) for a in actions[10:]] + [env.reset()]
    for restored in (env, other):
        restored.set_state(saved)
        assert same([restored.step(a) for a in actions[10:]] + [restored.reset()], first)


def test_a_wrong_state_is_refused_and_changes_nothing(env):
    inner = env.unwrapped
    before = inner.get_state()
    wrong = [{}, before | {"extra": 1}, before | {"state": np.zeros(3)}, before | {"random": {"bit": 1}}, 7]
    wrong.append(before | {"memory": np.full(3, np.nan)})
    for state in wrong:
        with pytest.raises(InvalidInputError):
            inner.set_state(state)
        assert same(inner.get_state(), before)


# Physics and formulas


def test_the_environment_is_the_scene():
    """Physics of an episode is that of a stepper under the same wrench."""
    env = StationKeepingEnv(current=(0.2, -0.1, 0.0))
    env.reset(seed=1)
    body = Scene(current=(0.2, -0.1, 0.0), step=0.025).stepper()
    body.reset(env.position_ned, env.quaternion_body_to_ned, env.velocity_body)
    for action in actions_for(env, 20):
        env.step(action)
        body.step(action.astype(float) * env.vehicle.wrench_limits, 4)
    assert np.allclose(env.position_ned, body.position_ned, atol=1e-13)
    assert np.allclose(env.velocity_body, body.velocity_body, atol=1e-13)


def test_observation_is_what_it_says():
    env = StationKeepingEnv()
    goal_q = np.array([0.8, 0.0, 0.0, 0.6])
    options = {
        "position": (1.0, 2.0, 4.0),
        "quaternion": (0.5, 0.5, 0.5, 0.5),
        "velocity": (0.1, 0.2, 0.3, 0.4, 0.5, 0.6),
        "goal_position": (0.5, 1.0, 5.0),
        "goal_quaternion": goal_q,
        "current": (0.1, 0.0, 0.0),
    }
    observation, info = env.reset(seed=0, options=options)
    body = Rotation.from_quat([0.5, 0.5, 0.5, 0.5])
    goal = Rotation.from_quat(np.roll(goal_q, -1))
    error = np.array([-0.5, -1.0, 1.0])
    assert np.allclose(observation[:3], body.inv().apply(error), atol=1e-6)
    assert np.allclose(observation[3:9], (body.inv() * goal).as_matrix()[:, :2].T.ravel(), atol=1e-6)
    assert np.allclose(observation[9:15], options["velocity"], atol=1e-6)
    assert np.allclose(observation[15:], 0.0)
    assert info["position_error"] == pytest.approx(1.5)
    assert info["attitude_error"] == pytest.approx((body.inv() * goal).magnitude())
    assert np.allclose(info["current_ned"], (0.1, 0.0, 0.0))
    observation, *_ = env.step(np.zeros(6))
    now = Rotation.from_quat(np.roll(env.quaternion_body_to_ned, -1))
    integral = 0.1 * (np.array([0.5, 1.0, 5.0]) - env.position_ned)
    assert np.allclose(observation[15:], now.inv().apply(integral), atol=1e-6)


@settings(max_examples=20)
@given(seed=st.integers(0, 2**31))
def test_a_quaternions_sign_is_not_seen(seed):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=4)
    q /= np.linalg.norm(q)
    one, two = StationKeepingEnv(), StationKeepingEnv()
    start = {"position": (1.0, 0.0, 5.0), "velocity": (0.1,) * 6}
    action = actions_for(one, 1)[0]
    plus = roll_out(one, [action], seed=0, options=start | {"quaternion": q})
    minus = roll_out(two, [action], seed=0, options=start | {"quaternion": -q})
    for a, b in zip(plus, minus, strict=True):
        assert np.array_equal(a[0], b[0])


def test_reward_is_its_formula():
    weights = Weights(position=0.4, precision=0.2, attitude=0.3, effort=0.1, position_width=2.0)
    env = StationKeepingEnv(reward=weights)
    env.reset(seed=5)
    action = actions_for(env, 1)[0]
    _, reward, *_, info = env.step(action)
    d, e = info["position_error"], info["attitude_error"]
    expected = (
        0.4 * np.exp(-((d / 2.0) ** 2))
        + 0.2 * np.exp(-d / 0.1)
        + 0.3 * np.exp(-e / 0.5)
        - 0.1 * np.mean(action.astype(float) ** 2)
    )
    assert reward == pytest.approx(expected, rel=1e-12)
    as_dictionary = {
        "position": 0.4,
        "precision": 0.2,
        "attitude": 0.3,
        "effort": 0.1,
        "position_width": 2.0,
    }
    assert StationKeepingEnv(reward=as_dictionary).reward_weights == weights
    terms = [info[f"reward/{name}"] for name in ("position", "precision", "attitude", "effort")]
    assert reward == terms[0] + terms[1] + terms[2] + terms[3]


def test_a_vehicle_that_the_task_does_not_suit_is_pointed_out():
    with pytest.warns(UnsuitableVehicleWarning, match=r"nothing drives.*sway.*WaypointTracking"):
        StationKeepingEnv("remus100")


def test_starts_are_spread_as_documented():
    env = StationKeepingEnv(start_radius=2.0, current=0.3)
    starts = [env.reset(seed=seed)[1] for seed in range(400)]
    distances = np.array([info["position_error"] for info in starts])
    currents = np.array([info["current_ned"] for info in starts])
    assert distances.max() <= 2.0
    at_goal = distances < 1e-9
    assert 0.06 < at_goal.mean() < 0.15
    # uniform in the ball: the cube of the distance is uniform
    assert np.mean((distances[~at_goal] / 2.0) ** 3) == pytest.approx(0.5, abs=0.06)
    speeds = np.linalg.norm(currents, axis=1)
    assert speeds.max() <= 0.3
    assert speeds.mean() == pytest.approx(0.15, abs=0.02)
    assert not currents[:, 2].any()
    assert np.abs(currents.mean(axis=0)).max() < 0.02


def test_leaving_the_workspace_ends_the_episode():
    env = StationKeepingEnv(workspace_radius=2.5)
    env.reset(
        seed=0,
        options={"position": (2.4, 0.0, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 6},
    )
    terminated = False
    for _ in range(40):
        observation, _, terminated, _, info = env.step(np.array([1.0, 0, 0, 0, 0, 0]))
        assert env.observation_space.contains(observation)
        if terminated:
            break
    assert terminated
    assert info["position_error"] > 2.5
    assert not info["refused"]


def test_a_vehicle_without_some_axes_has_fewer_actions(tmp_path):
    from dq_marine.vehicles import load_vehicle

    vehicle = load_vehicle("bluerov2_heavy")
    limits = vehicle.limits.model_copy(update={"wrench": (100.0, 0.0, 100.0, 0.0, 0.0, 30.0)})
    env = StationKeepingEnv(vehicle.model_copy(update={"limits": limits}))
    assert env.action_space.shape == (3,)
    still = {
        "position": (0.0, 0.0, 5.0),
        "quaternion": (1.0, 0.0, 0.0, 0.0),
        "velocity": (0.0,) * 6,
        "current": (0, 0, 0),
    }
    env.reset(options=still)
    env.step(np.array([0.0, 0.0, 1.0]))
    assert env.velocity_body[5] > 0.1
    assert np.abs(env.velocity_body[[0, 1]]).max() < 1e-12


# Bad input


@pytest.mark.parametrize(
    "action",
    [
        np.full(6, np.nan), np.array([np.inf, 0, 0, 0, 0, 0]), np.zeros(5), np.zeros((6, 1)), 0.0, "ahead", None,
        [1, 2, "x", 4, 5, 6],
    ],
)  # fmt: skip
def test_a_bad_action_is_refused_and_changes_nothing(action):
    env = StationKeepingEnv()
    roll_out(env, actions_for(env, 5), seed=0)
    before = env.get_state()
    with pytest.raises(InvalidInputError, match="action"):
        env.step(action)
    assert same(env.get_state(), before)


def test_actions_saturate():
    one, two = StationKeepingEnv(), StationKeepingEnv()
    one.reset(seed=0)
    two.reset(seed=0)
    large = np.array([3.0, -7.0, 0.5, 1e30, 0.0, -0.2])
    assert same(one.step(large)[0], two.step(np.clip(large, -1, 1))[0])


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"current": -0.1}, "current"),
        ({"current": (1.0, 2.0)}, "shape"),
        ({"current": "strong"}, "current"),
        ({"control_period": 0.0}, "control_period"),
        ({"substeps": 0}, "substeps"),
        ({"substeps": 2.5}, "substeps"),
        ({"substeps": 10**9}, "at most"),
        ({"scheme": "rk4"}, "scheme"),
        ({"reward": {"speed": 1.0}}, r"speed.*precision"),
        ({"reward": {"position_width": 0.0}}, "position_width"),
        ({"reward": {"effort": float("nan")}}, "effort"),
        ({"reward": 3}, "dictionary"),
        ({"start_radios": 1.0}, r"start_radios.*start_radius"),
        ({"start_radius": 9.0}, "start_radius"),
        ({"workspace_radius": -1.0}, "workspace_radius"),
        ({"workspace_radius": 1e300}, "at most"),
        ({"goal_position": (0.0, 0.0)}, "goal_position"),
        ({"render_mode": "ascii"}, "render_mode"),
        ({"vehicle": "my.toml"}, "my.toml"),
        ({"control_period": 10.0, "substeps": 1}, "h omega"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        StationKeepingEnv(**keywords)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"place": (0, 0, 0)}, r"place.*position"),
        ({"position": (0.0, 0.0)}, "shape"),
        ({"velocity": (np.nan,) * 6}, "finite"),
        ({"quaternion": (1.0, 1.0, 0.0, 0.0)}, "length"),
    ],
)
def test_wrong_options_are_refused_and_the_episode_goes_on(env, options, message):
    inner = env.unwrapped
    before = inner.get_state()
    with pytest.raises(InvalidInputError, match=message):
        inner.reset(options=options)
    assert same(inner.get_state(), before)


def test_a_current_option_needs_a_current():
    env = StationKeepingEnv(current=0.0)
    env.reset(options={"current": (0.0, 0.0, 0.0)})
    with pytest.raises(InvalidInputError, match="without a current"):
        env.reset(options={"current": (0.1, 0.0, 0.0)})


def test_nothing_works_before_reset():
    env = StationKeepingEnv()
    for call in (lambda: env.step(np.zeros(6)), env.get_state, lambda: env.time, env.render):
        with pytest.raises(ResetNeeded, match="reset"):
            call()
