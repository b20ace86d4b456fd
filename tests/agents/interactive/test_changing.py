"""Another vehicle, task or weather from one episode to the next; what cannot be made is said, and changes nothing."""

from __future__ import annotations

import threading
import time
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.controllers.baselines import Agent, ZeroAgent
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.evaluation.flight import Outputs
from dq_marine.agents.interactive.controls import AGENT, POWER, RESET, STICK
from dq_marine.agents.interactive.flights import HELM
from dq_marine.agents.interactive.flying import MAKING
from dq_marine.agents.interactive.next_episode import LEVEL, TASK, VEHICLE
from dq_marine.agents.interactive.weather import WIND
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.controls import Event

STILL = with_keywords(DEFAULT_ENVIRONMENT, current=0.0)


@pytest.fixture
def slow_making(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, bool]]:
    """Making an environment takes a while; the vehicles of those that are made, and whether in the main thread."""
    made: list[tuple[str, bool]] = []
    foreseen = MarineEnv.foreseen

    def slowly(env: MarineEnv, action: Any) -> Any:
        made.append((env.vehicle.name, threading.current_thread() is threading.main_thread()))
        time.sleep(0.5)
        return foreseen(env, action)

    monkeypatch.setattr(MarineEnv, "foreseen", slowly)
    return made


def test_another_vehicle_flies_from_the_next_episode_on(flight, slow_making, tmp_path) -> None:
    flown: list[Any] = []

    def offer(env: gym.Env[Any, Any]) -> dict[str, Agent]:
        flown.append(env.unwrapped)
        return {"zero": ZeroAgent(env.action_space.shape[0])}

    script = [[], [Event(VEHICLE, "bluerov2")], [], [], [Event(RESET)], [], []]
    replay = tmp_path / "last.html"
    episode, page = flight(script, offer=offer, environment=STILL, outputs=Outputs(html=replay))
    assert [env.vehicle.name for env in flown] == ["BlueROV2 Heavy", "BlueROV2"]
    assert flown[0].episode.periods == 4  # it was flown on until the person wanted another
    assert not flown[1].episode.current_ned.any()  # as was asked for at first
    assert page.vehicles == ["BlueROV2"]
    assert len(episode.actions) == 2
    assert "pitch" not in episode.action_names
    assert any(notice.startswith(MAKING) for notice in page.notices)
    assert page.notices[-1] == ""
    assert "<title>BlueROV2</title>" in replay.read_text(encoding="utf-8")


def test_what_is_compiled_is_so_aside_and_the_page_says_so(flight, slow_making) -> None:
    """Of the first environment, too, whose start is shown meanwhile."""
    _, page = flight([[], [Event(VEHICLE, "bluerov2"), Event(RESET)], []], environment=STILL)
    assert slow_making == [("BlueROV2 Heavy", False), ("BlueROV2", False)]
    said = [notice.startswith(MAKING) for notice in page.notices]
    assert sum(said) >= 4  # looked at again and again
    assert said[0]
    assert not said[-1]


def test_who_flies_and_what_the_helm_was_set_to_stay(flight) -> None:
    ahead = Event(STICK, (1.0,) + (0.0,) * 4)
    script = [[Event(AGENT, HELM), Event(POWER, 0.5)], [Event(VEHICLE, "bluerov2"), Event(RESET)], [ahead]]
    episode, page = flight(script, environment=STILL)
    assert page.panel._controls[AGENT].value == HELM
    assert page.panel._controls[POWER].value == 0.5
    np.testing.assert_allclose(episode.actions[0, 0], 0.5)


def test_what_cannot_be_made_is_said_and_the_old_environment_flies_on(flight, tmp_path) -> None:
    """There is no wind below the surface."""
    script = [[], [Event(WIND[0], 10.0), Event(RESET)], [], [], [Event(WIND[0], 0.0), Event(RESET)], []]
    trajectory = tmp_path / "flight.csv"
    episode, page = flight(script, environment=STILL, outputs=Outputs(trajectory=trajectory))
    refused = next(notice for notice in page.notices if "is submerged, where there is no wind" in notice)
    assert page.vehicles == ["BlueROV2 Heavy"]  # the last one, without the wind
    assert page.notices.index(refused) < len(page.notices) - 1
    assert len(episode.actions) == 1
    assert trajectory.stat().st_size > 0


def test_a_start_that_means_nothing_to_another_task_is_left_out(flight) -> None:
    script = [[], [Event(TASK, "PathFollowing"), Event(RESET)], []]
    episode, page = flight(script, environment=STILL, start_distance=2.0)
    assert "cross_track_error" in {metric.name for metric in episode.metrics}
    assert set(page.readings) == {"Task", "Motion", "Action", "Reward"}
    assert LEVEL in page.panel._controls


def test_who_was_asked_for_and_cannot_fly_the_next_is_left_out(flight) -> None:
    class Particular(ZeroAgent):
        def reset(self, env: gym.Env[Any, Any]) -> None:
            if env.unwrapped.vehicle.name != "BlueROV2 Heavy":
                raise InvalidInputError("the policy was trained with another vehicle")

    script = [[], [Event(VEHICLE, "bluerov2"), Event(RESET)], []]
    episode, page = flight(script, environment=STILL, offer=lambda env: {"particular": Particular(6)})
    assert page.panel._controls[AGENT].options == (HELM,)
    assert len(episode.actions) == 1


def test_one_that_needs_another_to_be_made_gives_way_to_the_baselines(flight) -> None:
    def offer(env: gym.Env[Any, Any]) -> dict[str, Agent]:
        if env.unwrapped.vehicle.name != "BlueROV2 Heavy":
            raise InvalidInputError("no controller flies this")
        return {"zero": ZeroAgent(6)}

    script = [[], [Event(VEHICLE, "bluerov2"), Event(RESET)], []]
    _, page = flight(script, environment=STILL, offer=offer)
    assert page.panel._controls[AGENT].options == ("controller", "zero", "random", HELM)


def test_who_quits_while_it_is_made_keeps_the_episode_before(flight, slow_making) -> None:
    script = [[], [], [Event(VEHICLE, "bluerov2"), Event(RESET)], []]
    episode, page = flight(script, environment=STILL, impatient=True)
    assert episode.action_names[4] == "pitch"
    assert len(episode.actions) == 2
    assert page.vehicles == []
