"""A stand-in for the live viewer, with a person who does what a script says."""

from __future__ import annotations

from typing import Any

from dq_marine.agents.interactive.controls import QUIT
from dq_marine.agents.interactive.flying import MAKING
from dq_marine.viewer.controls import Event, Panel


class ScriptedPage:
    """At each look it hands over the next events of a script, and Quit at its end.

    Attributes:
        impatient: whether the person quits while another environment is made than the first.
    """

    url = "http://127.0.0.1:7000"

    def __init__(self, script: list[list[Event]], *, impatient: bool = False) -> None:
        self.impatient, self._length = impatient, len(script)
        self.script, self.panel = script, Panel(())
        self.times: list[float] = []
        self.places: list[tuple[float, ...]] = []
        self.goals: list[tuple[float, ...] | None] = []
        self.notices: list[str] = []
        self.values: list[dict[str, Any]] = []
        self.readings: dict[str, Any] = {}
        self.vehicles: list[str] = []

    def __enter__(self) -> ScriptedPage:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def draw(self, snapshot: Any) -> None:
        self.times.append(snapshot.time)
        self.places.append(tuple(snapshot.position_ned.tolist()))
        goal = snapshot.goal_position_ned
        self.goals.append(None if goal is None else tuple(goal.tolist()))

    def clear_trail(self) -> None:
        pass

    def show_vehicle(self, shape: Any, title: str) -> None:
        self.vehicles.append(title)

    def show_controls(self, groups: Any) -> None:
        self.panel = Panel(groups)

    def show_values(self, values: dict[str, Any]) -> None:
        self.values.append(values)

    def show_readings(self, time: float, groups: Any) -> None:
        self.readings = dict(groups)

    def show_notice(self, text: str) -> None:
        self.notices.append(text)

    def events(self) -> list[Event]:
        if self.notices and self.notices[-1].startswith(MAKING):
            return [Event(QUIT)] if self.impatient and len(self.script) < self._length else []
        return self.script.pop(0) if self.script else [Event(QUIT)]
