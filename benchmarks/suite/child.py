"""Measurements that need a process of their own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[1]


def said_by_child(module: str, *arguments: str, **variables: str) -> Any:
    """Run a module of the suite in a fresh interpreter; return the JSON that it prints.

    Args:
        module: to run.
        arguments: of its command line.
        variables: of its environment, beside this process's own.

    Raises:
        RuntimeError: it failed; the message has its error output.
    """
    command = [sys.executable, "-m", module, *arguments]
    ended = subprocess.run(
        command, cwd=FOLDER, env={**os.environ, **variables}, capture_output=True, text=True, check=False
    )
    if ended.returncode:
        raise RuntimeError(f"{module} {' '.join(arguments)} failed:\n{ended.stderr}")
    return json.loads(ended.stdout)
