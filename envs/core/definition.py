"""What a file that defines a task says: its formulas, its keywords, what its numbers mean, and whom it suits."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.vector3 import Vector3
from dq_marine.checks import finite_number, one_of, shown
from dq_marine.errors import InvalidInputError, UnknownKeywordError
from dq_marine.task.protocol import Task
from dq_marine.task.ranging import Schedule
from dq_marine.task.things import Beam, Thing
from dq_marine.task.traffic import Own

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle


LARGEST_WEIGHT = 1e6
"""Of a term of the reward: beside one this large, single precision keeps a term of 1 to a digit."""

NARROWEST_WIDTH = 1e-6
"""Of a bell of the reward, in the unit of what it is over: nothing is told apart by less."""

PARTS = ("observation", "achieved_goal", "desired_goal")
"""Of an observation of a goal-conditioned task, as Gymnasium's `GoalEnv` and hindsight replay name them."""

PRIVILEGED = "privileged"
"""The part that only the simulator knows, of any task, where it is asked for."""


class Observed(NamedTuple):
    """Some numbers of an observation that belong together.

    Attributes:
        name: in snake case, with the frame.
        unit: such as "m/s"; "" for ratios.
        size: how many numbers.
        bound: their largest magnitude.
        meaning: one line for people.
        part: which of `PARTS` they belong to; where all are of the first, the observation is a `Box`, else a `Dict`.
    """

    name: str
    unit: str
    size: int
    bound: float
    meaning: str
    part: str = PARTS[0]


class Goal(NamedTuple):
    """Where the vehicle is to go, for drawing: position in NED [m], attitude body to NED."""

    position_ned: Vector3
    attitude: Quaternion = (1.0, 0.0, 0.0, 0.0)


def goal_along(position_ned: Vector3, direction_ned: Vector3) -> Goal:
    """Return a level goal at a position [m] that heads along a direction, seen from above."""
    heading = math.atan2(direction_ned[1], direction_ned[0])
    return Goal(position_ned, quaternion_from_euler(0.0, 0.0, heading))


class ForVehicle(NamedTuple):
    """A value of a level that is in proportion to the vehicle.

    Attributes:
        value: (vehicle) -> the value.
        meaning: one line for people, such as "0.05 of the cruising speed".
    """

    value: Callable[[Vehicle], Any]
    meaning: str

    def __repr__(self) -> str:
        """Return what it means, in brackets: it stands where a plain value would."""
        return f"({self.meaning})"


class EpisodeContext(NamedTuple):
    """What a task's parameters may depend on besides its own settings.

    Attributes:
        vehicle: the nominal one.
        control_period: time between actions [s].
        fitted: (settings, vehicle) -> the settings with what depends on the vehicle filled in, where nothing was said.
        options: the task's own options of `reset`, checked: arrays by name.
    """

    vehicle: Vehicle
    control_period: float
    options: Mapping[str, NDArray[np.float64]]


@dataclass(frozen=True)
class NoSettings:
    """Of a task without keywords of its own."""


def as_given(settings: Any, vehicle: Vehicle) -> Any:
    """Return a task's settings: nothing of them depends on the vehicle."""
    return settings


def same_formulas(settings: Any) -> Mapping[str, Any]:
    """Return that the task's formulas are the same whatever the settings."""
    return {}


def no_goal(parameters: Any, memory: Any) -> Goal | None:
    """Return that there is nothing to draw."""
    return None


def nothing_around(parameters: Any, memory: Any) -> Sequence[Thing]:
    """Return that there is nothing around the vehicle to draw."""
    return ()


def no_beams(parameters: Any, memory: Any) -> Sequence[Beam]:
    """Return that there are no range sensors to draw."""
    return ()


def no_schedule(settings: Any, period: float) -> Schedule | None:
    """Return that range sensors, if there are any, tell in every control period what they meet then."""
    return None


def suits_all(vehicle: Vehicle) -> str | None:
    """Return that any vehicle can do the task."""
    return None


@dataclass(frozen=True)
class TaskDefinition:
    """A task, for `dq_marine.register_task`.

    Attributes:
        id: for `gym.make`, such as "dq_marine/StationKeeping-v0".
        summary: one line.
        task: its formulas, see `dq_marine.task.protocol`.
        parameters: (settings, context) -> the named tuple of numbers that the formulas take first.
        observations: (settings, vehicle) -> what the observation consists of, in its order.
        weights: the named tuple of the reward's weights, and of what else shapes it, with their defaults. The names of
            widths end with `_width`.
        settings: a frozen dataclass of the task's keywords, with their defaults, which checks itself.
        fitted: (settings, vehicle) -> the settings with what depends on the vehicle filled in, where nothing was said.
        formulas: (settings) -> those of the task's functions that settings choose, by their names: the same for equal
            settings, and not those of `task` only where a keyword of `lasting` asks for others.
        lasting: names of keywords that hold as long as an environment does.
        options: the task's own options of `reset`, with the size of each; a quaternion's name ends with `quaternion`.
        episode_fields: of the parameters, those that the options change.
        units: of the metrics, by name; for angles in radians "rad".
        tolerances: of some metrics: an episode is settled from when on all of them stay within.
        goal: (parameters, memory) -> the goal to be drawn.
        scenery: (parameters, memory) -> what is around the vehicle, to be drawn.
        beams: (parameters, memory) -> the beams of the task's range sensors, with what they tell the agent now, to be
            drawn.
        schedule: (settings, control period [s]) -> when the task's range sensor pings and tells, of a task whose
            `observe` returns its readings first; None for always and at once.
        collided: (parameters, memory) -> whether the vehicle has hit something since the start, for evaluations; None
            of a task with nothing to hit.
        meets: (parameters, memory) -> one's own vessel, of a task whose memory has a `Lookout` called `lookout`, into
            which environments of several agents write the others.
        goal_reward: (parameters, weights, achieved goal, desired goal) -> the term `goal` of the reward, with its
            weight, of a task whose observation has goals among its parts: for `compute_reward` and hindsight replay.
        levels: of difficulty, by name, the easiest first: keywords of the task and of `dq_marine.Settings`, each with
            its value, or with a `ForVehicle` that has one for every vehicle.
        unsuitable: (vehicle) -> why the task cannot be done with it; None where it can.
        surroundings: defaults of other keywords of `dq_marine.Settings`, by name, where the task has its own.
        vehicle: the default one.
        control_period: the default one [s]; or (vehicle) -> the default one, of a task whose pace is the vehicle's.
        substeps: the default number of integrator steps in a control period.
        max_episode_steps: control periods after which an episode is truncated.
    """

    id: str
    summary: str
    task: Task
    parameters: Callable[[Any, EpisodeContext], Any]
    observations: Callable[[Any, Vehicle], Sequence[Observed]]
    weights: Any
    settings: type[Any] = NoSettings
    fitted: Callable[[Any, Vehicle], Any] = as_given
    formulas: Callable[[Any], Mapping[str, Any]] = same_formulas
    lasting: tuple[str, ...] = ()
    options: Mapping[str, int] = field(default_factory=dict)
    episode_fields: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    tolerances: Mapping[str, float] = field(default_factory=dict)
    goal: Callable[[Any, Any], Goal | None] = no_goal
    scenery: Callable[[Any, Any], Sequence[Thing]] = nothing_around
    beams: Callable[[Any, Any], Sequence[Beam]] = no_beams
    schedule: Callable[[Any, float], Schedule | None] = no_schedule
    collided: Callable[[Any, Any], Any] | None = None
    meets: Callable[[Any, Any], Own] | None = None
    goal_reward: Callable[[Any, Any, Any, Any], float] | None = None
    levels: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    unsuitable: Callable[[Vehicle], str | None] = suits_all
    surroundings: Mapping[str, Any] = field(default_factory=dict)
    vehicle: str = "bluerov2_heavy"
    control_period: float | Callable[[Vehicle], float] = 0.1
    substeps: int = 4
    max_episode_steps: int = 300

    @property
    def metric_names(self) -> tuple[str, ...]:
        """Names of what the task measures."""
        return tuple(self.task.metrics._fields)

    @property
    def reward_names(self) -> tuple[str, ...]:
        """Names of the terms of its reward."""
        return tuple(self.task.rewards._fields)

    @property
    def has_goals(self) -> bool:
        """Whether its observation shows goals, and its environment tells the reward at others."""
        return self.goal_reward is not None

    @property
    def keywords(self) -> tuple[str, ...]:
        """Names of its own keywords."""
        return tuple(one.name for one in fields(self.settings))

    def task_for(self, settings: Any) -> Task:
        """Return the formulas for settings, which are `checked_settings`'s."""
        chosen = self.formulas(settings)
        return replace(self.task, **chosen) if chosen else self.task

    def period_for(self, vehicle: Vehicle) -> float:
        """Return the default control period for a vehicle [s]."""
        own = self.control_period
        return own(vehicle) if callable(own) else own

    def at_level(self, level: str | None, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return keywords, with those of a level of difficulty for what is not given; None is no level.

        What a level has in proportion to the vehicle follows the vehicle that is given, or else the default one.

        Raises:
            InvalidInputError: the task has no such level.
        """
        if level is None:
            return dict(given)
        if not self.levels:
            raise InvalidInputError(f"level = {shown(level)}, and {self.id} has no levels; leave it out")
        said = self.levels[one_of("level", level, self.levels)]
        return {**{name: self.for_vehicle(value, given) for name, value in said.items()}, **given}

    def for_vehicle(self, value: Any, given: Mapping[str, Any]) -> Any:
        """Return a keyword's value for the vehicle that is given, or else the default one: see `ForVehicle`."""
        from dq_marine.vehicles import load_vehicle  # here: `import dq_marine` stays light

        if not isinstance(value, ForVehicle):
            return value
        return value.value(load_vehicle(given.get("vehicle", self.vehicle)))

    def checked_settings(self, given: Mapping[str, Any], vehicle: Vehicle) -> Any:
        """Return the task's settings for a vehicle.

        Raises:
            UnknownKeywordError: a keyword is unknown.
            InvalidInputError: a value is wrong.
        """
        unknown = sorted(set(given) - set(self.keywords))
        if unknown:
            remedy = f"its own are {list(self.keywords)}, and it takes those of dq_marine.Settings"
            raise UnknownKeywordError.of(self.id, unknown, remedy)
        return self.fitted(self.settings(**given), vehicle)

    def checked_weights(self, reward: Any) -> Any:
        """Return the weights of the reward from whatever form they are given in.

        Raises:
            InvalidInputError: a name is unknown, or a value is not finite, negative, too large, or a width of 0.
        """
        known = list(self.weights._fields)
        if reward is None:
            return self.weights
        given = reward._asdict() if isinstance(reward, type(self.weights)) else reward
        if not isinstance(given, Mapping):
            raise InvalidInputError(f"reward = {shown(reward)}; give a dictionary with keys among {known}")
        unknown = sorted(map(str, set(given) - set(known)))
        if unknown:
            raise InvalidInputError(f"reward has unknown keys {unknown}; it takes {known}")
        return self.weights._replace(**{name: _checked_weight(name, value) for name, value in given.items()})


def _checked_weight(name: str, value: Any) -> float:
    least = NARROWEST_WIDTH if name.endswith("_width") else 0.0
    return finite_number(f"reward.{name}", value, least=least, most=LARGEST_WEIGHT)
