"""The hand that pulls the vehicle: a spring with a strongest force, which lets go when the person does."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from numpy.testing import assert_allclose

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.evaluation.flight import Outputs
from dq_marine.agents.interactive.controls import PULL, RESET
from dq_marine.agents.interactive.hand import STRONGEST, Hold, mass_felt, spring_force
from dq_marine.viewer.controls import LEFT, Event

STILL = with_keywords(DEFAULT_ENVIRONMENT, current=0.0)
NORTH = Event(PULL, ((0.0, 0.0, 0.0), (50.0, 0.0, 5.0)))


@pytest.fixture(scope="module")
def env():
    made = gym.make("dq_marine/StationKeeping-v0", disable_env_checker=True, current=0.0).unwrapped
    made.reset(
        seed=1,
        options={"position": [0.0, 0.0, 5.0], "quaternion": [1.0, 0.0, 0.0, 0.0], "velocity": [0.0] * 6},
    )
    return made


def test_the_mass_felt_is_the_least_of_the_point(env) -> None:
    """By NumPy: the velocity of the point is J v, and of all unit impulses there none moves it more."""
    point = np.array([0.2, 0.1, -0.05])
    x, y, z = point
    jacobian = np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])
    gives_way = jacobian @ np.linalg.inv(env.vehicle.mass_matrix) @ jacobian.T
    felt = mass_felt(env.base_parameters.inertia, point)
    assert felt == pytest.approx(1.0 / np.linalg.norm(gives_way, 2), rel=1e-9)
    assert 0.0 < felt < env.vehicle.mass_matrix[:3, :3].diagonal().min()


def test_the_spring_pulls_towards_the_hand_in_proportion_up_to_its_limit(env) -> None:
    point = (0.1, 0.0, 0.0)
    near, twice, far = (spring_force(env, Hold(point, (0.1 + way, 0.0, 5.0))) for way in (0.05, 0.1, 1e5))
    assert_allclose(near / np.linalg.norm(near), [1.0, 0.0, 0.0], atol=1e-9)
    assert_allclose(twice, 2.0 * near, rtol=1e-6)
    strongest = STRONGEST * mass_felt(env.base_parameters.inertia, np.array(point))
    assert np.linalg.norm(far) == pytest.approx(strongest, rel=1e-9)
    assert_allclose(spring_force(env, Hold(point, (0.1, 0.0, 5.0))), 0.0, atol=1e-9)


def norths(page) -> np.ndarray:
    return np.array([place[0] for place in page.places])


def test_the_vehicle_follows_the_hand_until_it_is_let_go(flight, tmp_path) -> None:
    """Let go, each period is that of a flight of a vehicle that nothing pulls: it only slows down."""
    for end in (Event(PULL, None), Event(LEFT)):
        outputs = Outputs(trajectory=tmp_path / "flight.csv")
        script = [[], [NORTH], *[[]] * 9, [end], *[[]] * 20]
        episode, _ = flight(script, seconds=10.0, environment=STILL, outputs=outputs)
        assert episode.pushed.tolist() == [False] + [True] * 10 + [False] * 21
        assert episode.notes == ("The vehicle was pulled by hand in 10 of 32 control periods.",)
        columns = episode.columns()
        north = columns["north_m"]
        assert north[11] - north[1] > 0.3
        speed = np.diff(north)
        assert np.all(np.diff(speed[11:]) < 0.0)
        assert columns["pushed"][:-1].tolist() == episode.pushed.tolist()


def test_it_settles_where_the_hand_is_without_ringing(flight, tmp_path) -> None:
    there = Event(PULL, ((0.0, 0.0, 0.0), (1.0, 0.0, 5.0)))
    episode, _ = flight(
        [[there], *[[]] * 119],
        seconds=13.0,
        environment=with_keywords(STILL, start_radius=0.0),
        outputs=Outputs(trajectory=tmp_path / "flight.csv"),
    )
    north = episode.columns()["north_m"]
    assert north[-1] == pytest.approx(1.0, abs=0.05)
    assert north.max() < 1.1


def test_another_episode_is_not_pulled(flight) -> None:
    episode, _ = flight([[NORTH], [], [Event(RESET)], [], [], []], environment=STILL)
    assert episode.pushed is None
    assert "pushed" not in episode.columns()


def test_a_paused_flight_is_not_moved_by_the_hand(flight) -> None:
    from dq_marine.viewer.playback import PLAYING

    _, page = flight([[Event(PLAYING, False), NORTH], [], [], []], environment=STILL)
    assert np.ptp(norths(page)) == 0.0
