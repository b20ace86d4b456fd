"""What all commands of `dq-marine` share: where they write, how they help, how their errors end."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any

import typer
from rich.console import Console
from rich.segment import Segment
from rich.text import Text
from typer.core import TyperGroup

from dq_marine.checks import printable
from dq_marine.errors import DQMarineError


class SafeConsole(Console):
    """A console on which what came in from outside, such as the name of a file, cannot act on the terminal."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Return the text as it is shown, before its place in a table is measured."""
        return super().render_str(safe(text), **options)

    def render(self, renderable: Any, options: Any = None) -> Iterator[Segment]:
        """Yield what is written: of texts, only what is printed; the console's own controls as they are."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else Segment(safe(segment.text), segment.style)


def safe(text: str) -> str:
    """Return the text with only its lines and tabs left of what is not printed."""
    return "".join(one if one in "\n\t" else printable(one) for one in text)


console = SafeConsole()
error_console = SafeConsole(stderr=True)

HELP_OPTIONS = {"help_option_names": ["-h", "--help"]}


class Commands(TyperGroup):
    """Commands whose errors of this package end in one message and exit code 1, without a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command that was asked for."""
        try:
            return super().invoke(ctx)
        except DQMarineError as error:
            _say(str(error))
            raise typer.Exit(1) from error
        except ConnectionError:  # nobody reads any more, as after `| head`: click ends the command
            raise
        except OSError as error:
            _drop_what_is_unwritten()
            what = "the output" if error.filename is None else error.filename
            _say(
                f"{what} cannot be read or written: {error.strerror or error}; mend that, and run the command again"
            )
            raise typer.Exit(1) from error
        except MemoryError as error:
            _say("there is not enough memory for this; ask for less, such as fewer environments")
            raise typer.Exit(1) from error


def _say(message: str) -> None:
    with contextlib.suppress(OSError):  # standard error may be gone, too
        error_console.print(Text.assemble(("Error: ", "bold red"), message), soft_wrap=True)


def _drop_what_is_unwritten() -> None:
    """Let standard output, which could not be written, lead nowhere, so that Python does not try again at its end."""
    if sys.stdout is not sys.__stdout__ or sys.stdout is None:
        return
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextlib.contextmanager
def shown_part(what: str) -> Iterator[Callable[[float], None]]:
    """Yield a function that shows, on standard error, what part of something is done, from 0 to 1."""
    from rich.progress import Progress, TaskID

    bar, tasks = Progress(console=error_console, transient=True), list[TaskID]()

    def show(done: float) -> None:
        if not tasks:
            bar.start()  # not before: a bar leaves a line behind, and nothing may come of it
            tasks.append(bar.add_task(what, total=1.0))
        bar.update(tasks[0], completed=done)

    try:
        yield show
    finally:
        if tasks:
            bar.stop()


def examples(*lines: str) -> str:
    """Return the end of a command's help."""
    return "\n\n".join(["Examples:", *(f"  [bold]{line}[/bold]" for line in lines)])
