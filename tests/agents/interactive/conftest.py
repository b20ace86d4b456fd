"""Flights by a script of events, without a browser and without waiting."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from support.scripted_page import ScriptedPage

from dq_marine.agents.controllers.baselines import ZeroAgent
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs
from dq_marine.agents.interactive import flying
from dq_marine.viewer.controls import Event
from dq_marine.viewer.pacing import RealTimePacer


@pytest.fixture(autouse=True)
def no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(RealTimePacer, "wait_until", lambda self, time: None)


@pytest.fixture
def flight(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[Any, ScriptedPage]]:
    """Fly by a script of events: the last episode, and the page."""

    def fly(script: list[list[Event]], *, seconds: float = 3.0, **keywords: Any) -> tuple[Any, ScriptedPage]:
        page = ScriptedPage(script, impatient=keywords.pop("impatient", False))
        monkeypatch.setattr(flying, "open_page", lambda shape, title: page)
        offer = keywords.pop("offer", lambda env: {"zero": ZeroAgent(env.action_space.shape[0])})
        environment = keywords.pop("environment", DEFAULT_ENVIRONMENT)
        plan = FlightPlan(environment, seconds, 4, keywords.pop("start_distance", None))
        episode = flying.fly_interactively(
            plan, offer, keywords.pop("outputs", Outputs()), title="", **keywords
        )
        return episode, page

    return fly
