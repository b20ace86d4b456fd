"""A person conducts a flight: plays, pauses, steps, restarts, chooses who flies, turns the current."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from support.scripted_page import ScriptedPage

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.evaluation.flight import Outputs
from dq_marine.agents.interactive.conductor import Conductor
from dq_marine.agents.interactive.controls import AGENT, CURRENT, GOAL, HOLD, POWER, RESET, SEED, STICK
from dq_marine.agents.interactive.flights import HELM, offered_agents
from dq_marine.agents.interactive.helm import Helm
from dq_marine.agents.interactive.next_episode import NextEpisode
from dq_marine.viewer.controls import LEFT, Event
from dq_marine.viewer.playback import PLAYING, STEP

STILL = with_keywords(DEFAULT_ENVIRONMENT, current=0.0)


def test_it_plays_until_the_person_quits(flight) -> None:
    episode, page = flight([[]] * 12)
    assert len(episode.actions) == 12
    assert page.times[0] == 0.0


def test_paused_it_goes_step_by_step(flight) -> None:
    script = [[Event(PLAYING, False)], [], [Event(STEP)], [], [], [Event(STEP), Event(STEP)], [], []]
    episode, page = flight(script)
    assert len(episode.actions) == 3
    assert {PLAYING: False} in page.values
    assert page.times[-1] == pytest.approx(0.3)  # the state between two steps is shown at once


def test_another_episode_with_another_seed(flight) -> None:
    episode, page = flight([[], [], [Event(SEED, 11), Event(RESET)], [], []])
    assert episode.seed == 11
    assert len(episode.actions) == 2
    assert page.times.count(0.0) >= 2


def test_at_its_end_an_episode_waits_for_play_and_says_how_it_went(flight) -> None:
    script = [[]] * 10 + [[]] * 5 + [[Event(PLAYING, True)]] + [[]] * 3
    episode, page = flight(script, seconds=1.0)
    assert len(episode.actions) == 3
    assert any("The task is not done after 1.0 s" in notice for notice in page.notices)


def test_ctrl_c_as_the_end_of_an_episode_is_shown_ends_the_flight(flight, monkeypatch) -> None:
    def interrupted(page: ScriptedPage, text: str) -> None:
        if text.startswith("The task is not done"):
            raise KeyboardInterrupt

    monkeypatch.setattr(ScriptedPage, "show_notice", interrupted)
    episode, _ = flight([[]] * 20, seconds=1.0)
    assert len(episode.actions) == 10


def test_who_flies_is_chosen_by_name(flight) -> None:
    script = [
        [],
        [Event(AGENT, HELM), Event(HOLD, False), Event(STICK, (1.0,) + (0.0,) * 5)],
        [],
        [Event(LEFT)],
        [],
    ]
    episode, page = flight(script)
    np.testing.assert_allclose(episode.actions[:, 0], [0.0, 1.0, 1.0, 0.0, 0.0])
    agents = next(one for one in page.panel.described()[0]["controls"] if one["name"] == AGENT)
    assert agents["options"] == ("zero", HELM)


def test_at_the_helm_from_the_start_with_half_the_power(flight) -> None:
    script = [[Event(HOLD, False), Event(POWER, 0.5), Event(STICK, (0.0, 0.0, 1.0, 0.0, 0.0, 0.0))], []]
    episode, page = flight(script, teleoperated=True)
    np.testing.assert_allclose(episode.actions[:, 2], 0.5)
    agents = next(one for one in page.panel.described()[0]["controls"] if one["name"] == AGENT)
    assert agents["options"] == (HELM, "zero")


@pytest.mark.sweep
def test_the_current_that_is_chosen_is_felt(flight, tmp_path) -> None:
    """A vehicle that drifts goes with the water in the end."""
    script = [[Event(CURRENT[0], 0.8), Event(CURRENT[1], 90.0)]] + [[]] * 400
    episode, page = flight(script, seconds=40.0, outputs=Outputs(trajectory=tmp_path / "flight.csv"))
    east = episode.track.columns()["east_m"]
    assert np.diff(east)[-1] / 0.1 == pytest.approx(0.8, rel=0.05)
    assert set(CURRENT) <= set(page.panel._controls)


def test_without_a_current_there_is_no_slider_for_it(flight) -> None:
    _, page = flight([[]], environment=STILL)
    assert CURRENT[0] not in page.panel._controls


def test_the_goal_is_put_elsewhere_at_once_also_while_it_is_paused(flight) -> None:
    there = (1.0, -0.5, 6.0)
    script = [[Event(PLAYING, False)], [Event(GOAL, there)], [Event(STEP)], []]
    episode, page = flight(script, environment=STILL)
    assert page.goals[-1] == there
    assert page.goals[0] == (0.0, 0.0, 5.0)
    assert page.times[page.goals.index(there)] == 0.0
    before, after = episode.measured["position_error"]
    assert before == pytest.approx(math.dist(page.places[0], page.goals[0]))
    assert after == pytest.approx(math.dist(page.places[-1], there))
    goal = page.panel._controls[GOAL]
    assert (goal.least, goal.most) == ((-3.0, -3.0, 2.0), (3.0, 3.0, 8.0))  # half of the workspace around it


def test_a_goal_that_is_refused_is_said(flight) -> None:
    script = [[Event(GOAL, (0.0, 0.0, -5.0))], []]
    _, page = flight(script, environment=STILL)
    assert any("up in the air" in notice for notice in page.notices)
    assert page.goals[-1] == (0.0, 0.0, 5.0)


def test_everything_can_be_read(flight) -> None:
    _, page = flight([[]] * 3)
    assert set(page.readings) == {"Task", "Motion", "Action", "Reward"}
    units = {reading.label: reading.unit for group in page.readings.values() for reading in group}
    assert units["position error"] == "m"
    assert units["attitude error"] == "deg"
    assert units["u, surge"] == "m/s"
    assert units["depth"] == "m"
    assert "effort" in units


def test_other_baselines_are_offered_where_they_can_fly() -> None:
    env = gym.make("dq_marine/StationKeeping-v0", disable_env_checker=True)
    offered = offered_agents(env, baselines=["zero"], runs=[], seed=0)
    assert list(offered) == ["zero", "controller", "random"]


def test_a_flight_must_have_begun() -> None:
    env = gym.make("dq_marine/StationKeeping-v0", disable_env_checker=True)
    helm = Helm(env)
    chosen = NextEpisode(DEFAULT_ENVIRONMENT)
    conductor = Conductor(ScriptedPage([]), {HELM: helm}, helm, seed=0, next_episode=chosen)  # type: ignore[arg-type]
    with pytest.raises(ResetNeeded):
        conductor.act(None)  # type: ignore[arg-type]
