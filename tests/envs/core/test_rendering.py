"""What an environment shows: pictures, a live page, a replay; and that nothing of it outlives `close`."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from support.environments import StationKeepingEnv

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"
AWAY = {"position": (1.5, 0.5, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 6}


@pytest.mark.browser
def test_gymnasiums_checker_passes_with_its_render_modes():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gym.make(ID, render_mode="rgb_array")
        check_env(env.unwrapped)
        env.close()


@pytest.mark.browser
def test_pictures_follow_the_vehicle():
    env = StationKeepingEnv(render_mode="rgb_array", current=0.0)
    env.reset(seed=0, options=AWAY)
    first = env.render()
    assert first.dtype == np.uint8
    assert first.ndim == 3
    assert first.shape[2] == 3
    assert (env.render() != first).any(axis=2).sum() <= 5  # pixels where faces of one depth meet take turns
    for _ in range(10):
        env.step(np.array([-1.0, 0.0, 0.0, 0.0, 0.0, 0.3]))
    moved = env.render()
    assert (np.abs(moved.astype(int) - first.astype(int)).max(axis=2) > 30).mean() > 0.002
    env.close()
    assert np.array_equal(env.render().shape, first.shape)  # opens again
    env.close()


def test_the_live_page_follows_step_and_reset_and_ends_with_close(capfd):
    env = StationKeepingEnv(render_mode="human", control_period=0.05, substeps=2)
    env.reset(seed=0)
    live = env._view._live
    assert live.url.startswith("http://127.0.0.1:")
    assert live.url in capfd.readouterr().err
    server = live._server._process
    assert server.poll() is None
    for _ in range(3):
        env.step(np.zeros(6))
    env.reset()
    assert env.render() is None
    env.close()
    assert server.poll() is not None
    env.close()


def test_the_live_page_keeps_real_time():
    import time

    env = StationKeepingEnv(render_mode="human", control_period=0.1)
    start = time.monotonic()
    env.reset(seed=0)
    for _ in range(8):
        env.step(np.zeros(6))
    elapsed = time.monotonic() - start
    env.close()
    assert elapsed >= 0.8  # as much simulated time is not shown faster than it passes


def test_a_recorded_episode_is_saved(tmp_path):
    env = StationKeepingEnv(record=True)
    env.reset(seed=0)
    env.step(np.zeros(6))
    env.reset(seed=1)  # the replay is that of the episode in progress
    for _ in range(20):
        env.step(np.zeros(6))
    assert len(env._view._snapshots) == 21
    assert env._view._snapshots[-1].time == pytest.approx(2.0)
    path = tmp_path / "replay.html"
    env.save_html(path)
    assert "BlueROV2 Heavy" in path.read_text()
    with pytest.raises(InvalidInputError, match=r"folder|directory"):
        env.save_html(tmp_path / "nowhere" / "replay.html")


def test_saving_what_was_not_recorded_is_refused(tmp_path):
    env = StationKeepingEnv()
    env.reset(seed=0)
    with pytest.raises(InvalidInputError, match="record=True"):
        env.save_html(tmp_path / "replay.html")


def test_the_snapshot_tells_what_happens():
    env = StationKeepingEnv(current=(0.2, 0.1, 0.0))
    env.reset(seed=0, options=AWAY)
    env.step(np.array([0.5, 2.0, 0.0, 0.0, 0.0, -0.25]))
    snapshot = env.snapshot()
    assert snapshot.time == pytest.approx(0.1)
    assert np.allclose(snapshot.position_ned, env.position_ned)
    expected = np.array([0.5, 1.0, 0.0, 0.0, 0.0, -0.25]) * env.vehicle.wrench_limits
    assert np.allclose(snapshot.wrench_body, expected)
    assert np.allclose(snapshot.current_ned, (0.2, 0.1, 0.0))
    assert np.allclose(snapshot.goal_position_ned, (0.0, 0.0, 5.0))
