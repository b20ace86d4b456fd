"""A desk where the tasks of a cluster ask the process that gave them out, and wait for its answer.

Only that process has what answers them, such as a file on its disk. The desk itself is a task that any machine of the
cluster may hold; where that one is lost another takes its place, and what was asked is asked again.
"""

from __future__ import annotations

import asyncio
from typing import Any

from dq_marine.util.extras import optional_library

MOST_AT_ONCE = 10_000
"""Tasks that may wait for an answer at the same time."""


class Desk:
    """The desk, as either side holds it; it travels with a task's arguments."""

    def __init__(self, counter: Any) -> None:
        """Take the handle of the task that holds what was asked."""
        self._counter = counter

    def ask(self, number: int, what: Any) -> Any:
        """Ask as the task of a number, and return the answer once there is one."""
        return _ray().get(self._counter.ask.remote(number, what))

    def waiting(self) -> dict[int, Any]:
        """Return what has been asked and not been answered, by the number of the task."""
        found: dict[int, Any] = _ray().get(self._counter.waiting.remote())
        return found

    def answer(self, number: int, reply: Any) -> None:
        """Answer the task of a number; nothing where it does not ask."""
        _ray().get(self._counter.answer.remote(number, reply))


def new_desk() -> Desk:
    """Return a desk on the cluster that this process is connected to."""
    counter = _ray().remote(_Counter)
    options = {"num_cpus": 0, "max_restarts": -1, "max_task_retries": -1, "max_concurrency": MOST_AT_ONCE}
    return Desk(counter.options(**options).remote())


class _Counter:
    """Holds what was asked until it is answered, in one thread of one process."""

    def __init__(self) -> None:
        self._asked: dict[int, tuple[Any, asyncio.Future[Any]]] = {}

    async def ask(self, number: int, what: Any) -> Any:
        """Return the answer."""
        reply = asyncio.get_running_loop().create_future()
        self._asked[number] = (what, reply)
        return await reply

    async def waiting(self) -> dict[int, Any]:
        """Return what is to be answered."""
        return {number: what for number, (what, _) in self._asked.items()}

    async def answer(self, number: int, reply: Any) -> None:
        """Let what was asked return."""
        asked = self._asked.pop(number, None)
        if asked is not None and not asked[1].done():
            asked[1].set_result(reply)


def _ray() -> Any:
    return optional_library("work on a cluster", "ray", "distributed")
