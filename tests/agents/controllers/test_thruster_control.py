"""The DP controller through thrust allocation: it holds station by thrusters as it does by wrenches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.fleet import vehicle_with

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, marine, with_keywords
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import Vehicle, load_vehicle

FAR = {"position": (2.0, -1.0, 5.5), "quaternion": (0.8, 0.0, 0.0, 0.6), "velocity": np.zeros(6)}


def heavy(**thruster: Any) -> Vehicle:
    """The BlueROV2 Heavy with some numbers of all its thrusters changed."""
    own = load_vehicle("bluerov2_heavy").model_dump()["thrusters"]
    return vehicle_with(thrusters=[one | thruster for one in own])


def fly(**keywords: Any) -> Episode:
    env = make_environment(with_keywords(DEFAULT_ENVIRONMENT, **keywords))
    return fly_episode(env, make_baseline("controller", env), seed=0, options=FAR)


@pytest.mark.sweep
@pytest.mark.parametrize("time_constant", [0.0, 0.1])
def test_it_holds_station_by_thrusters(time_constant: float) -> None:
    vehicle = heavy(time_constant=time_constant)
    episode = fly(vehicle=vehicle, actuation="thrusters", current=(0.2, -0.2, 0.0))
    assert episode.measured["position_error"][episode.last_third].max() < 0.02
    assert np.degrees(episode.measured["attitude_error"][episode.last_third]).max() < 1.0
    assert not episode.ended_early


@pytest.mark.sweep
def test_without_lags_both_ways_are_the_same_flight() -> None:
    """Where nothing saturates, allocated thrusters do what the wrench would."""
    near = {"position": (0.05, 0.0, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity": np.zeros(6)}
    errors = []
    for actuation in ("wrench", "thrusters"):
        env = make_environment(
            with_keywords(DEFAULT_ENVIRONMENT, actuation=actuation, current=(0.1, 0.0, 0.0))
        )
        episode = fly_episode(env, make_baseline("controller", env), seed=0, options=near)
        errors.append(episode.measured["position_error"])
    assert errors[0] == pytest.approx(errors[1], abs=1e-5)


def test_it_asks_for_what_the_environment_takes() -> None:
    env = make_environment(with_keywords(DEFAULT_ENVIRONMENT, actuation="thrusters"))
    observation, _ = env.reset(seed=0)
    controller = DPController.for_env(env)
    controller.reset(env)
    action = controller.act(observation)
    assert env.action_space.contains(action)
    assert marine(env).action_names == tuple(channel.name for channel in marine(env).vehicle.channels)


def test_unknown_drives_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="'sails' is unknown"):
        DPController(load_vehicle("bluerov2_heavy"), 0.1, actuation="sails")
    with pytest.raises(InvalidInputError, match="no actuators whose force is known"):
        DPController(vehicle_with(), 0.1, actuation="thrusters")
