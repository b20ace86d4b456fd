"""What all commands of `dq-marine` share: where they write, how they help, how their errors end."""

from __future__ import annotations

from typing import Any

import typer
from rich.console import Console
from rich.text import Text
from typer.core import TyperGroup

from dq_marine.errors import DQMarineError

console = Console()
error_console = Console(stderr=True)

HELP_OPTIONS = {"help_option_names": ["-h", "--help"]}


class Commands(TyperGroup):
    """Commands whose errors of this package end in one message and exit code 1, without a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command that was asked for."""
        try:
            return super().invoke(ctx)
        except DQMarineError as error:
            error_console.print(Text.assemble(("Error: ", "bold red"), str(error)), soft_wrap=True)
            raise typer.Exit(1) from error


def examples(*lines: str) -> str:
    """Return the end of a command's help."""
    return "\n\n".join(["Examples:", *(f"  [bold]{line}[/bold]" for line in lines)])
