"""A controller's numbers are tuned while it flies."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.controllers.baselines import Agent, ZeroAgent, make_baseline
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.interactive.controls import RESET
from dq_marine.agents.interactive.gains import Gains
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.controls import Event
from dq_marine.viewer.playback import PLAYING

STILL = with_keywords(DEFAULT_ENVIRONMENT, current=0.0)
BANDWIDTH = "gain_position_bandwidth"


def begun(task: str, **keywords: Any) -> Any:
    env = gym.make(f"dq_marine/{task}-v0", disable_env_checker=True, **keywords).unwrapped
    env.reset(seed=1)
    return env


def test_a_number_that_is_moved_is_that_of_the_controller() -> None:
    env = begun("StationKeeping", current=0.0)
    agents: dict[str, Agent] = {"zero": ZeroAgent(6), "controller": make_baseline("controller", env)}
    gains = Gains(agents)
    before = agents["controller"]
    (group,) = gains.groups()
    assert group.label == "Gains of controller"
    sliders = {slider.name: slider for slider in group.controls}
    assert len(sliders) == 9
    assert sliders[BANDWIDTH].value == before.settings.position.bandwidth
    assert gains.take(Event(BANDWIDTH, 1.0), env)
    tuned = agents["controller"]
    assert isinstance(tuned, DPController)
    assert tuned.settings.position.bandwidth == gains.value(BANDWIDTH) == 1.0
    assert tuned.settings.attitude == before.settings.attitude
    assert tuned.gains.proportional[0] < before.gains.proportional[0]
    assert not gains.take(Event("speed", 1.0), env)


def test_what_the_controller_cannot_fly_with_leaves_it_as_it_was() -> None:
    env = begun("StationKeeping", current=0.0)
    agents: dict[str, Agent] = {"controller": make_baseline("controller", env)}
    gains, before = Gains(agents), agents["controller"]
    with pytest.raises(InvalidInputError, match="too long for the controller"):
        gains.take(Event(BANDWIDTH, 10.0), env)
    assert agents["controller"] is before
    assert gains.value(BANDWIDTH) == before.settings.position.bandwidth


@pytest.mark.parametrize(
    ("task", "name", "value"),
    [
        ("PathFollowing", "gain_shortest_look_ahead", 4.0),
        ("WaypointTracking", "gain_haste", 1.0),
        ("ObstacleAvoidance", "gain_slowing_angle", 2.0),
        ("TerrainFollowing", "gain_look_ahead_time", 2.0),
        ("PipelineInspection", "gain_look_ahead_time", 2.0),
    ],
)
def test_autopilots_are_tuned_too(task: str, name: str, value: float) -> None:
    env = begun(task)
    agents: dict[str, Agent] = {"controller": make_baseline("controller", env)}
    gains = Gains(agents)
    for slider in gains.groups()[0].controls:
        assert slider.least <= slider.value <= slider.most
        assert gains.take(Event(slider.name, slider.most), env)  # each end can be flown with
    assert gains.take(Event(name, value), env)
    assert getattr(agents["controller"].settings, name.removeprefix("gain_")) == value
    agents["controller"].act(env.observation)


def test_a_limit_that_is_not_given_has_no_slider() -> None:
    def labels(task: str) -> set[str]:
        agent = make_baseline("controller", begun(task))
        (group,) = Gains({"controller": agent}).groups()
        return {slider.label for slider in group.controls}

    assert labels("DepthHeading") - labels("PathFollowing") == {"share of fastest turn"}


def test_who_has_no_such_numbers_has_no_sliders() -> None:
    gains = Gains({"zero": ZeroAgent(6)})
    assert gains.groups() == ()
    assert not gains.take(Event(BANDWIDTH, 1.0), begun("StationKeeping", current=0.0))


def test_in_a_flight_it_is_tuned_at_once_and_for_the_next_episodes(flight) -> None:
    """What cannot be flown with is said, and the slider goes back."""
    made: list[dict[str, Agent]] = []

    def offer(env: gym.Env[Any, Any]) -> dict[str, Agent]:
        made.append({"controller": make_baseline("controller", env)})
        return made[-1]

    script = [
        [Event(PLAYING, False), Event(BANDWIDTH, 10.0)],
        [Event(PLAYING, True), Event(BANDWIDTH, 0.5)],
        [],
        [Event(RESET)],
        [],
    ]
    _, page = flight(script, environment=STILL, offer=offer)
    assert any("too long for the controller" in notice for notice in page.notices)
    assert {BANDWIDTH: 2.0} in page.values
    assert page.panel._controls[BANDWIDTH].value == 0.5
