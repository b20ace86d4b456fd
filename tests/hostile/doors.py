"""The public doors, by name."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hostile.acting import (
    Target,
    batch_target,
    body_target,
    drawn_batch_call,
    drawn_body_call,
    drawn_env_call,
    drawn_vector_call,
    env_target,
    vector_target,
)
from hostile.commands import drawn_command
from hostile.files import drawn_log_file, drawn_mesh_file, drawn_reference_file, drawn_scenario_file
from hostile.folders import drawn_run_folder
from hostile.making import (
    MADE,
    drawn_environment,
    drawn_making,
    drawn_scene,
    drawn_sea,
    drawn_settings,
    drawn_task_environment,
    drawn_vector_environment,
    drawn_vehicle,
    drawn_vehicle_file,
)
from hostile.tables import drawn_force_file, drawn_radiation_file
from hostile.values import Rng


@dataclass(frozen=True)
class Door:
    """A public function with hostile arguments.

    Attributes:
        draw: (generator) -> a function without arguments that goes through the door.
        target: what it acts on, None if it makes something new.
    """

    draw: Callable[[Rng], Callable[[], Any]]
    target: Callable[[], Target] | None = None


DOORS: dict[str, Door] = {
    "scene": Door(drawn_scene),
    "environment": Door(drawn_environment),
    "vector environment": Door(drawn_vector_environment),
    "settings": Door(drawn_settings),
    "sea": Door(drawn_sea),
    "vehicle": Door(drawn_vehicle),
    "vehicle file": Door(drawn_vehicle_file),
    "force file": Door(drawn_force_file),
    "radiation file": Door(drawn_radiation_file),
    "mesh file": Door(drawn_mesh_file),
    "log file": Door(drawn_log_file),
    "reference file": Door(drawn_reference_file),
    "scenario file": Door(drawn_scenario_file),
    "run folder": Door(drawn_run_folder),
    "command": Door(drawn_command),
    "body": Door(drawn_body_call, body_target),
    "batch": Door(drawn_batch_call, batch_target),
    "env": Door(drawn_env_call, env_target),
    "vector env": Door(drawn_vector_call, vector_target),
    **{name: Door(functools.partial(drawn_making, name=name)) for name in MADE},
    "task environment": Door(drawn_task_environment),
}
"""By name; a case goes through one of them."""

OFTEN = ("scene", "settings", "vehicle", "vehicle file")
"""Doors that make something, and through which more cases go than through the others."""

WEIGHTS = {name: 4 if door.target or name in OFTEN else 1 for name, door in DOORS.items()}
"""How often a door is drawn."""
