"""Progress on the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn


class Screen:
    """A line that says what is measured, and lines that stay.

    It is drawn when there is something new, not by a thread of its own, which would share a core with what is timed.

    Args:
        console: to draw on.
        estimate: whether to say how much longer it takes.
    """

    def __init__(self, console: Console, *, estimate: bool = False) -> None:
        self.console = console
        remaining = [TextColumn("about"), TimeRemainingColumn(), TextColumn("left")] if estimate else []
        self._bar = Progress(
            TextColumn("[bold]{task.fields[section]}"),
            BarColumn(bar_width=20),
            TextColumn("{task.percentage:3.0f} %"),
            TimeElapsedColumn(),
            *remaining,
            TextColumn("{task.description}", markup=False),
            console=console,
            auto_refresh=False,
            transient=True,
        )
        self._task: TaskID | None = None

    @contextmanager
    def section(self, name: str) -> Iterator[None]:
        """Show a section's progress while it is measured."""
        self._task = self._bar.add_task("", total=1.0, section=name)
        try:
            with self._bar if self.console.is_terminal else nullcontext():
                yield
        finally:
            self._bar.remove_task(self._task)
            self._task = None

    def tell(self, words: str, done: float = 0.0) -> None:
        """Say what is being measured, and what part is done."""
        self._update(words, done)

    def progress(self, done: float) -> None:
        """Say what part of it is done."""
        self._update(None, done)

    def say(self, words: str, style: str = "") -> None:
        """Print a line that stays."""
        self.console.print(words, style=style, highlight=False, markup=False, soft_wrap=True)

    def _update(self, words: str | None, done: float) -> None:
        if self._task is not None and self.console.is_terminal:
            self._bar.update(self._task, description=words, completed=done, refresh=True)
