"""What a task is, as tables: made from its definition, for the terminal and as Markdown for documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any, NamedTuple, get_args

from rich.table import Table

from dq_marine.envs.core.definition import ForVehicle, TaskDefinition
from dq_marine.envs.core.registry import registered_tasks, short_name
from dq_marine.envs.scenarios.files import scenarios_of
from dq_marine.physics.fields import Motion
from dq_marine.task.protocol import never
from dq_marine.vehicles import Vehicle, load_vehicle, vehicle_names

AXES: tuple[str, ...] = get_args(Motion)
UNITS = ("N",) * 3 + ("N m",) * 3
"""Of a force and a moment."""


class TextTable(NamedTuple):
    """A table of texts."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    @property
    def markdown(self) -> str:
        """The table without its title, as Markdown."""
        lines = [self.columns, ("---",) * len(self.columns), *self.rows]
        return "\n".join("| " + " | ".join(line) + " |" for line in lines)

    @property
    def shown(self) -> Table:
        """The table for a terminal."""
        table = Table(title=self.title, title_justify="left")
        for number, column in enumerate(self.columns):
            table.add_column(column, no_wrap=number == 0)
        for row in self.rows:
            table.add_row(*(cell.replace("`", "") for cell in row))
        return table


def task_table() -> TextTable:
    """Return a table of all registered tasks."""
    rows = [
        (f"`{task.id}`", task.summary, ", ".join(f"`{name}`" for name in suiting_vehicles(task)))
        for task in registered_tasks()
    ]
    return TextTable("tasks", ("id", "task", "vehicles that it suits"), rows)


def suiting_vehicles(definition: TaskDefinition) -> tuple[str, ...]:
    """Return the names of the catalogue's vehicles that a task can be done with."""
    return tuple(name for name in vehicle_names() if definition.unsuitable(load_vehicle(name)) is None)


def description(definition: TaskDefinition) -> tuple[TextTable, ...]:
    """Return the tables of a task, with its default vehicle."""
    vehicle = load_vehicle(definition.vehicle)
    return (
        action_table(definition, vehicle),
        observation_table(definition, vehicle),
        reward_table(definition),
        outcome_table(definition),
        keyword_table(definition, vehicle),
        *((level_table(definition),) if definition.levels else ()),
    )


def action_table(definition: TaskDefinition, vehicle: Vehicle) -> TextTable:
    """Return what the numbers of an action are by default: the actuated axes, or the channels, with their limits."""
    if definition.surroundings.get("actuation") == "thrusters":
        channels = [(one.name, one.unit, f"{one.low:.4g}", f"{one.high:.4g}") for one in vehicle.channels]
        return TextTable("action", ("channel", "unit", "at -1", "at 1"), channels)
    axes = zip(AXES, UNITS, vehicle.wrench_limits.tolist(), strict=True)
    rows = [(axis, unit, f"{limit:g}") for axis, unit, limit in axes if limit]
    return TextTable("action", ("axis", "unit", "at 1"), rows)


def observation_table(definition: TaskDefinition, vehicle: Vehicle) -> TextTable:
    """Return what an observation consists of, with the parts of one that shows goals."""
    observed = definition.observations(definition.checked_settings({}, vehicle), vehicle)
    rows = [
        (f"`{one.name}`", str(one.size), one.unit or "1", _plain(one.bound), one.meaning) for one in observed
    ]
    columns = ("name", "numbers", "unit", "bound", "meaning")
    if not definition.has_goals:
        return TextTable("observation", columns, rows)
    parts = [(f"`{one.part}`",) for one in observed]
    return TextTable("observation", ("part", *columns), [a + b for a, b in zip(parts, rows, strict=True)])


def reward_table(definition: TaskDefinition) -> TextTable:
    """Return the weights of the reward, and what else shapes it, with their defaults."""
    rows = [(f"`{name}`", f"{value:g}") for name, value in definition.weights._asdict().items()]
    return TextTable("reward", ("weight or width", "default"), rows)


def outcome_table(definition: TaskDefinition) -> TextTable:
    """Return the metrics, and what counts as success."""
    rows = [
        (f"`{name}`", definition.units.get(name) or "1", "metric, in `info`")
        for name in definition.metric_names
    ]
    succeeded = definition.task.succeeded
    success = "never" if succeeded is never else (succeeded.__doc__ or "").partition("\n")[0]
    return TextTable("outcome", ("name", "unit", "meaning"), [*rows, ("`is_success`", "", success)])


def keyword_table(definition: TaskDefinition, vehicle: Vehicle) -> TextTable:
    """Return the task's own keywords, and what they are for a vehicle; it takes those of `dq_marine.Settings`, too."""
    made, fitted = definition.settings(), definition.checked_settings({}, vehicle)
    rows = [
        (f"`{one.name}`", _value(getattr(made, one.name)), _value(getattr(fitted, one.name)))
        for one in fields(definition.settings)
    ]
    return TextTable("own keywords", ("keyword", "default", "with the default vehicle"), rows)


def level_table(definition: TaskDefinition) -> TextTable:
    """Return the levels of difficulty, and the keywords that each stands for."""
    rows = [
        (f"`{level}`", _said(keywords) or "the defaults") for level, keywords in definition.levels.items()
    ]
    return TextTable("levels", ("level", "keywords"), rows)


def scenario_count_table() -> TextTable:
    """Return a table of how many scenarios ship for each task, with the first of them."""
    rows = [
        (f"`{short_name(task)}`", str(len(found)), ", ".join(f"`{one.name}`" for one in found[:5]) + ", ...")
        for task in registered_tasks()
        if (found := scenarios_of(task.id))
    ]
    return TextTable("scenarios", ("task", "scenarios", "such as"), rows)


def scenario_table(definition: TaskDefinition) -> TextTable:
    """Return the scenarios of a task, with what each is."""
    rows = [(f"`{one.name}`", one.description, str(one.seed)) for one in scenarios_of(definition.id)]
    return TextTable("scenarios", ("scenario", "what it is", "seed"), rows)


def scenario_conditions_table(definition: TaskDefinition) -> TextTable:
    """Return the scenarios of a task, with the keywords and the options of reset that each stands for."""
    rows = [
        (f"`{one.name}`", one.description, _said(one.keywords), _said(one.reset), str(one.seed))
        for one in scenarios_of(definition.id)
    ]
    return TextTable("scenarios", ("scenario", "what it is", "keywords", "options of `reset`", "seed"), rows)


def _said(values: Mapping[str, Any]) -> str:
    """Return keywords or options as Python has them."""
    return ", ".join(f"`{name}={_value(value)}`" for name, value in values.items())


def _value(value: Any) -> str:
    """Return a value as Python has it, its numbers with at most six digits."""
    if isinstance(value, ForVehicle):
        return repr(value)
    if isinstance(value, float):
        return f"{value:.6g}" if value % 1.0 else repr(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name!r}: {_value(one)}" for name, one in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(value)


def _plain(number: float) -> str:
    """Return a number with at most two decimals."""
    return f"{number:.2f}".rstrip("0").rstrip(".")
