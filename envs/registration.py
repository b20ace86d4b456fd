"""Registration of the tasks that come with the package: every file in `envs/tasks` defines one."""

from __future__ import annotations

import importlib
import pkgutil

from dq_marine.envs import tasks


def register_environments() -> None:
    """Import every file in `envs/tasks`: the last line of each registers its task."""
    for module in pkgutil.iter_modules(tasks.__path__, f"{tasks.__name__}."):
        importlib.import_module(module.name)
