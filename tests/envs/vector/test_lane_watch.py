"""A page that follows one environment of a running batch, and does not hold the others up."""

import threading
import time

import gymnasium as gym
import numpy as np
import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.envs.vector.lane_watch import FRAMES_PER_SECOND, LaneWatch
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.pacing import RealTimePacer

ID = "dq_marine/StationKeeping-v0"
PATIENCE = 120.0
"""Seconds after which something will not happen any more, on a machine that is busy."""


class SlowPage:
    """Stands in for a page whose pictures take long."""

    url = "http://127.0.0.1:1/"

    def __init__(self):
        self.snapshots, self.closed, self.go_on = [], 0, threading.Event()

    def draw(self, snapshot):
        assert self.go_on.wait(PATIENCE)
        self.snapshots.append(snapshot)

    def close(self):
        self.closed += 1


@pytest.fixture
def page(monkeypatch):
    slow = SlowPage()
    monkeypatch.setattr("dq_marine.envs.vector.vector_env.open_page", lambda shape, title: slow)
    return slow


def wait_for(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_a_slow_page_does_not_hold_the_batch_up(page):
    envs = gym.make_vec(ID, num_envs=3)
    envs.reset(seed=0)
    assert envs.unwrapped.watch(2) == page.url
    actions = np.full((3, 6), 0.5)
    for _ in range(20):  # the first picture is not done before all of them have been taken
        envs.step(actions)
    assert page.snapshots == []
    page.go_on.set()
    wait_for(lambda: page.snapshots)
    time.sleep(2.0 / FRAMES_PER_SECOND)
    envs.step(actions)
    position = envs.get_attr("position_ned")[2]
    wait_for(lambda: len(page.snapshots) >= 2 and page.snapshots[-1].time == pytest.approx(2.1))
    assert np.array_equal(page.snapshots[-1].position_ned, position)
    envs.close()
    assert page.closed == 1


def test_watching_changes_nothing(page):
    page.go_on.set()
    watched, alone = gym.make_vec(ID, num_envs=3), gym.make_vec(ID, num_envs=3)
    actions = np.random.default_rng(0).uniform(-1, 1, (60, 3, 6))
    for envs in (watched, alone):
        envs.reset(seed=0)
    watched.unwrapped.watch(1)
    for action in actions:
        observations, expected = watched.step(action)[0], alone.step(action)[0]
        assert np.array_equal(observations, expected)
        time.sleep(0.005)
    wait_for(lambda: watched.step(actions[0]) and len(page.snapshots) > 2)
    watched.close()


def test_pictures_are_taken_no_faster_than_they_are_shown():
    now = [0.0]
    page = SlowPage()
    page.go_on.set()
    watch = LaneWatch(0, lambda: page, clock=lambda: now[0])
    taken = 0

    def take():
        nonlocal taken
        taken += 1
        return f"picture {taken}"

    for _ in range(100):
        watch.offer(take)
        now[0] += 0.1 / FRAMES_PER_SECOND
        wait_for(lambda: watch.drawn == taken)
    assert 8 <= taken <= 11
    watch.close()
    watch.close()


def test_a_page_that_fails_does_not_end_the_run(page):
    page.draw = None  # calling it raises
    envs = gym.make_vec(ID, num_envs=2)
    envs.reset(seed=0)
    envs.unwrapped.watch(0)
    for _ in range(5):
        envs.step(np.zeros((2, 6)))
        time.sleep(1.1 / FRAMES_PER_SECOND)
    envs.close()


def test_an_environment_that_is_not_there_cannot_be_watched(page):
    envs = gym.make_vec(ID, num_envs=2)
    envs.reset(seed=0)
    with pytest.raises(InvalidInputError, match=r"index = 2.*0 to 1"):
        envs.unwrapped.watch(2)
    assert envs.unwrapped.watch(None) is None


def test_human_mode_follows_the_first_environment_and_does_not_wait_for_the_wall_clock(capfd, monkeypatch):
    waited = []
    monkeypatch.setattr(RealTimePacer, "wait_until", lambda pacer, time: waited.append(time))
    envs = gym.make_vec(ID, num_envs=2, render_mode="human")
    envs.reset(seed=0)
    assert "http://127.0.0.1:" in capfd.readouterr().err
    for _ in range(30):
        envs.step(np.zeros((2, 6)))
    assert waited == []
    assert envs.render() is None
    envs.close()
