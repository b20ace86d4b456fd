"""Tasks by id: registered with Gymnasium, found again by environments in this process and in workers."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, NamedTuple

import gymnasium as gym

from dq_marine.checks import shown
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SINGLE = "dq_marine.envs.core.making:make_single"
VECTOR = "dq_marine.envs.vector.vector_env:MarineVectorEnv"

_TASKS: dict[str, TaskDefinition] = {}
_MODULES: dict[str, str] = {}


class TravellingTask(NamedTuple):
    """A registered task on its way to another process: its id, and the module that registers it there."""

    id: str
    module: str


def register_task(definition: TaskDefinition, module: str | None = None) -> None:
    """Register a task: `gym.make` and `gym.make_vec` then know its id.

    A module that is reloaded, or a cell of a notebook that is run again, replaces what it registered before.

    In a worker process that is started afresh, the module that calls this has to be imported, too:
    `gym.make("my_module:my/Task-v0")` does so, and so does an environment that is unpickled there.

    Args:
        definition: of the task.
        module: that calls this, by its dotted name; None for the one that defines the task's parameters.

    Raises:
        InvalidInputError: a task of another module has this id.
    """
    module = module or definition.parameters.__module__
    known = _TASKS.get(definition.id)
    if known is not None and known != definition:
        if _MODULES[definition.id] != module:
            raise InvalidInputError(
                f"there is another task {definition.id!r}, of {_MODULES[definition.id]}; give yours an id of its own"
            )
        unregister_task(definition.id)
    _TASKS[definition.id] = definition
    _MODULES[definition.id] = module
    if definition.id not in gym.registry:
        gym.register(
            id=definition.id,
            entry_point=SINGLE,
            vector_entry_point=VECTOR,
            max_episode_steps=definition.max_episode_steps,
            kwargs={"task": definition.id},
        )


def unregister_task(identifier: str) -> None:
    """Forget a task, and its id at Gymnasium. Environments that were made of it go on.

    Raises:
        InvalidInputError: there is none of this id.
    """
    task_named(identifier)
    del _TASKS[identifier], _MODULES[identifier]
    gym.registry.pop(identifier, None)


def task_named(task: TaskDefinition | str) -> TaskDefinition:
    """Return a registered task by its id, or the one given.

    Raises:
        InvalidInputError: there is none of this id.
    """
    if isinstance(task, TaskDefinition):
        return task
    if task not in _TASKS:
        raise InvalidInputError(
            f"there is no task {shown(task)}; there are {sorted(_TASKS)}, and what dq_marine.register_task is given"
        )
    return _TASKS[task]


def short_name(definition: TaskDefinition) -> str:
    """Return a task's id without its namespace and version."""
    return definition.id.rpartition("/")[2].rpartition("-v")[0]


def task_called(name: str) -> TaskDefinition:
    """Return a task by its id, or by its short name in any case.

    Raises:
        InvalidInputError: there is none.
    """
    return task_named(full_id(name))


def task_imported(name: str) -> TaskDefinition:
    """Return a task by its id or short name, behind a module and a colon if importing that registers it.

    Raises:
        InvalidInputError: there is no such module, or no such task.
    """
    module, _, task = name.rpartition(":")
    try:
        if module:
            importlib.import_module(module)
    except ImportError as error:
        raise InvalidInputError(
            f"task = {shown(name)}: {error}; give a module that can be imported"
        ) from error
    return task_called(task)


def full_id(name: str) -> str:
    """Return the id of the task of a short name; any other id as it is."""
    meant = (task.id for task in registered_tasks() if short_name(task).lower() == name.lower())
    return next(meant, name)


def travelling(definition: TaskDefinition) -> TaskDefinition | TravellingTask:
    """Return what stands for a task on its way to another process; one that is not registered travels itself."""
    if _TASKS.get(definition.id) != definition:
        return definition
    return TravellingTask(definition.id, _MODULES[definition.id])


def arrived(task: TaskDefinition | TravellingTask) -> TaskDefinition:
    """Return the task that `travelling` stood for; the module that registers it is imported if need be.

    Raises:
        InvalidInputError: that module does not register it.
        ImportError: there is no such module here.
    """
    if isinstance(task, TaskDefinition):
        return task
    if task.id not in _TASKS:
        importlib.import_module(task.module)
    return task_named(task.id)


def registered_tasks() -> tuple[TaskDefinition, ...]:
    """Return all tasks, in the order of their ids."""
    return tuple(_TASKS[name] for name in sorted(_TASKS))


def shipped_tasks() -> tuple[TaskDefinition, ...]:
    """Return the tasks of this package, in the order of their ids."""
    return tuple(task for task in registered_tasks() if task.id.startswith("dq_marine/"))


def tasks_suiting(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the ids of the tasks that can be done with a vehicle."""
    return tuple(task.id for task in registered_tasks() if task.unsuitable(vehicle) is None)
