"""A task from the names of the file that defines it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.registry import register_task
from dq_marine.errors import InvalidInputError
from dq_marine.task.protocol import Task, never, no_errors, no_memory, same_memory

FORMULAS = {
    "start": None,
    "initial_memory": no_memory,
    "update_memory": same_memory,
    "observe": None,
    "measure": None,
    "reward": None,
    "terminated": never,
    "succeeded": never,
    "sense": no_errors,
}
"""Functions of `dq_marine.task.protocol.Task`, and what stands for one that a file does not define."""

TYPES = {"metrics": "Metrics", "rewards": "Rewards"}
"""Attributes of a `Task` that are named tuples, and their names in a file."""

OPTIONAL = {
    "settings": "Settings",
    "fitted": "fitted",
    "formulas": "formulas",
    "goal": "goal",
    "scenery": "scenery",
    "beams": "beams",
    "schedule": "schedule",
    "collided": "collided",
    "goal_reward": "goal_reward",
    "unsuitable": "unsuitable",
}
"""Attributes of a `TaskDefinition` that a file may define, and their names there."""


def define_task(
    names: Mapping[str, Any], *, draws: int, sense_draws: int = 0, **attributes: Any
) -> TaskDefinition:
    """Register the task that a file defines, and return it. The last line of a file that holds a task.

    The file has the functions `start`, `observe`, `measure` and `reward`, and where it needs them `initial_memory`,
    `update_memory`, `terminated`, `succeeded` and `sense`, as `dq_marine.task.protocol.Task` describes them; the named
    tuples `Metrics` and `Rewards`; the functions `parameters` and `observations`, and where it needs them `Settings`,
    `fitted`, `formulas`, `goal`, `scenery`, `beams`, `schedule`, `collided`, `goal_reward` and `unsuitable`, as
    `TaskDefinition` describes them. The weights of the reward are the defaults of `Weights`, or of `Rewards` where
    there is none.

    Args:
        names: of the file: `globals()`.
        draws: how many uniform random numbers `start` and `initial_memory` take.
        sense_draws: how many `sense` takes, whenever it is called; without any it is not.
        attributes: the other attributes of `TaskDefinition`: `id`, `summary`, `options`, `units`...

    Raises:
        InvalidInputError: something is missing, or another task has this id.
    """
    required = [name for name, default in FORMULAS.items() if default is None]
    missing = [
        name for name in (*required, *TYPES.values(), "parameters", "observations") if name not in names
    ]
    if missing:
        raise InvalidInputError(f"the task lacks {missing}; define them in its file")
    weights = names.get("Weights", names["Rewards"])
    try:
        defaults = weights()
    except TypeError as error:
        raise InvalidInputError(
            f"{weights.__name__} has no default for some of {list(weights._fields)}; give each weight one"
        ) from error
    formulas = {name: names.get(name, default) for name, default in FORMULAS.items()}
    types = {attribute: names[name] for attribute, name in TYPES.items()}
    found = {attribute: names[name] for attribute, name in OPTIONAL.items() if name in names}
    definition = TaskDefinition(
        task=Task(draws=draws, sense_draws=sense_draws, **formulas, **types),
        parameters=names["parameters"],
        observations=names["observations"],
        weights=defaults,
        **found,
        **attributes,
    )
    register_task(definition, names.get("__name__"))
    return definition
