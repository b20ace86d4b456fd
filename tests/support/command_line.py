"""The command line as tests run it."""

from __future__ import annotations

import re
from pathlib import Path

from typer.testing import CliRunner, Result

from dq_marine.cli.main import app


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def assert_refused(result: Result, pattern: str) -> None:
    """One message on stderr, nothing on stdout, exit code 1, no traceback."""
    assert result.exit_code == 1, result.output
    assert result.stdout == ""
    assert re.match(rf"Error: .*{pattern}", result.stderr, re.DOTALL), result.stderr
    assert "Traceback" not in result.stderr
