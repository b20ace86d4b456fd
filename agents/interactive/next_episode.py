"""What a person chooses for the next episode: vehicle, task, level of difficulty and weather."""

from __future__ import annotations

from typing import Any

from dq_marine.agents.interactive.weather import WeatherDials
from dq_marine.agents.keywords import with_changes
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.registry import registered_tasks, short_name, task_imported
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.viewer.controls import Choice, Control, Event, Group

TASK, VEHICLE, LEVEL = "task", "vehicle", "level"
"""Names of the controls."""

NO_LEVEL = "none"

NOTE = "What is chosen here holds from the next episode on: press New episode."


class NextEpisode:
    """The choice of an environment.

    Another task begins with its own defaults, a level with the weather that belongs to it; what was given for the task
    that is flown first holds for that task alone.

    Attributes:
        changed: whether something was chosen that is not flown yet.
    """

    def __init__(self, given: EnvironmentSettings) -> None:
        """Begin with an environment that can be made.

        Raises:
            InvalidInputError: its task is not registered.
        """
        self.changed = False
        self._given = given
        self._definition = task_imported(given.id)
        self._first = self._definition
        vehicle = given.keywords.get("vehicle", self._definition.vehicle)
        self._own_vehicle = {_label(vehicle): vehicle}
        self._vehicle = _label(vehicle)
        self._level = given.keywords.get("level") or NO_LEVEL
        self._dials = self._weather_said()
        self._weather_moved = False

    @property
    def settings(self) -> EnvironmentSettings:
        """What is chosen.

        Raises:
            InvalidInputError: the environment does not take a keyword.
        """
        changes: dict[str, Any] = {
            "vehicle": self._vehicles()[self._vehicle],
            "level": None if self._level == NO_LEVEL else self._level,
        }
        if self._weather_moved and self._dials is not None:
            changes["weather"] = self._dials.weather()
        return with_changes(self._base(), changes)

    def groups(self) -> tuple[Group, ...]:
        """Return the controls, as they stand."""
        tasks = {short_name(task): task for task in registered_tasks()} | {
            short_name(self._first): self._first
        }
        levels = (NO_LEVEL, *self._definition.levels)
        choices: tuple[Control, ...] = (
            Choice(TASK, "task", tuple(sorted(tasks)), short_name(self._definition)),
            Choice(VEHICLE, "vehicle", tuple(self._vehicles()), self._vehicle),
            Choice(LEVEL, "level", levels, self._level),
        )
        weather = () if self._dials is None else self._dials.controls()
        return (Group("Next episode", (*choices, *weather), note=NOTE),)

    def take(self, event: Event) -> bool:
        """Take a choice, if an event is one; return whether that makes the controls others."""
        if self._dials is not None and self._dials.take(event):
            self.changed = self._weather_moved = True
            return False
        if event.name == TASK:
            self._choose_task(event.value)
        elif event.name == VEHICLE:
            self._vehicle = event.value
        elif event.name == LEVEL:
            self._level = event.value
        else:
            return False
        self.changed, self._weather_moved = True, False
        self._dials = self._weather_said()
        return True

    def _choose_task(self, name: str) -> None:
        is_first = name == short_name(self._first)
        self._definition = self._first if is_first else task_imported(name)
        if self._vehicle not in self._vehicles():
            self._vehicle = _label(self._definition.vehicle)
        if self._level not in self._definition.levels:
            self._level = NO_LEVEL

    def _base(self) -> EnvironmentSettings:
        """Return what the choices are changes of."""
        if self._definition is self._first:
            return self._given
        return EnvironmentSettings(id=self._definition.id)

    def _vehicles(self) -> dict[str, Any]:
        """Return the vehicles that suit the task, and that with which the person began, by what they are called."""
        suiting = {name: name for name in vehicle_names() if _suits(self._definition, name)}
        own = {
            label: vehicle
            for label, vehicle in self._own_vehicle.items()
            if self._definition is self._first or _suits(self._definition, vehicle)
        }
        return suiting | own

    def _weather_said(self) -> WeatherDials | None:
        """Return sliders at the weather that task, level and keywords say; None where they cannot say it."""
        keywords = self._base().keywords
        asked = {"vehicle": self._vehicles()[self._vehicle]}
        if "weather" in keywords:
            asked["weather"] = keywords["weather"]
        level = None if self._level == NO_LEVEL else self._level
        said = self._definition.at_level(level, asked)
        weather = said.get("weather", self._definition.surroundings.get("weather", ()))
        try:
            return WeatherDials(weather)
        except InvalidInputError:
            return None


def _label(vehicle: Any) -> str:
    """Return what a vehicle is called: its name in the catalogue, the path of its file, or its own name."""
    return vehicle if isinstance(vehicle, str) else str(getattr(vehicle, "name", vehicle))


def _suits(definition: TaskDefinition, vehicle: Any) -> bool:
    return definition.unsuitable(load_vehicle(vehicle)) is None
