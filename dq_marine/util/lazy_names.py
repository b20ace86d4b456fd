"""Public names of a package that are imported when they are first used."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any


def public_names(package_file: str) -> dict[str, str]:
    """Return the names that a package's stub (`__init__.pyi`, beside its `__init__.py`) imports, with their modules.

    The stub is what editors and type checkers read, so a public name is one line in it and stands nowhere else:

        from dq_marine.simulation.scene import Scene as Scene

    Args:
        package_file: the package's `__file__`.
    """
    stub = Path(package_file).with_suffix(".pyi")
    imports = [
        node for node in ast.parse(stub.read_text(encoding="utf-8")).body if isinstance(node, ast.ImportFrom)
    ]
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def lazy_attributes(
    package: str, names: dict[str, str], namespace: dict[str, Any]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return `__getattr__` and `__dir__` of a package whose public names are imported on first use (PEP 562).

    Args:
        package: its name.
        names: public names, each with the module that defines it.
        namespace: the package's `globals()`, which keeps what has been imported.
    """

    def get_attribute(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(importlib.import_module(names[name]), name)
        namespace[name] = value
        return value

    def list_names() -> list[str]:
        return sorted({*namespace, *names})

    return get_attribute, list_names
