"""Work that is spread over machines by Ray: a cluster that there is, or one that is begun on this machine.

Ray gives a task whose worker or machine was lost to another one, so that nothing of what was asked for is lost. Every
machine of a cluster has this package, and sees the files that tasks name under the same paths.
"""

from __future__ import annotations

import contextlib
import logging
import os
import socket
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import AbstractContextManager
from typing import Any

from dq_marine.errors import InvalidInputError
from dq_marine.util.cluster_desk import Desk, new_desk
from dq_marine.util.extras import optional_library
from dq_marine.util.side_by_side import one_thread_each

RETRIES = 5
"""How often a task is begun again whose worker was lost; one that fails by itself is not."""

PATIENCE = 10.0
"""How long a cluster may take to answer [s]."""

ATTEMPTS = 5
"""To begin a cluster here, each of which Ray gives half a minute: too little now and then on a busy machine."""

SILENCE = {"RAY_USAGE_STATS_ENABLED": "0"}
"""Of the environment that Ray reads: it tells nobody that it is used."""

LOOPBACK = {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0"}
"""The same: what is begun here listens on 127.0.0.1 alone. Ray means it for other systems, and reads it on all."""


class ClusterPool:
    """Takes tasks as an executor of `concurrent.futures` does; each has one processor of the cluster."""

    def __init__(self, ray: Any) -> None:
        """Take the library, which is connected to a cluster."""
        self._ray = ray
        self._called = ray.remote(_called)
        self._asked: list[Any] = []

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Future[Any]:
        """Let function(*arguments) be called somewhere, and return what will be its result."""
        reference = self._called.options(num_cpus=1, max_retries=RETRIES).remote(function, *arguments)
        self._asked.append(reference)
        found: Future[Any] = Future()
        reference.future().add_done_callback(lambda done: self._hand_on(done, found))
        return found

    def desk(self) -> Desk:
        """Return a desk where tasks may ask this process."""
        return new_desk()

    def processors(self) -> int:
        """Return how many tasks the cluster works on at a time, at least 1: machines come and go."""
        return max(int(self._ray.cluster_resources().get("CPU", 0)), 1)

    def _hand_on(self, done: Future[Any], found: Future[Any]) -> None:
        """Hand on what a task came to, with its own error in place of Ray's, whose words are a traceback."""
        error = done.exception()
        if error is None:
            found.set_result(done.result())
        elif isinstance(cause := getattr(error, "cause", None), BaseException):
            found.set_exception(cause)
        elif isinstance(error, self._ray.exceptions.RayError):
            found.set_exception(
                InvalidInputError(
                    f"its worker or machine was lost {RETRIES + 1} times, as where memory runs out: "
                    f"{str(error).strip().partition(chr(10))[0]}; let fewer work on a machine at a time"
                )
            )
        else:
            found.set_exception(error)

    def give_up(self) -> None:
        """Take back what has not ended."""
        for reference in self._asked:
            self._ray.cancel(reference, force=True)


def _called(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call what Ray itself would not take, too: it refuses functions that are not written in Python."""
    return function(*arguments)


Cluster = Callable[[], AbstractContextManager[ClusterPool]]
"""What lets a cluster work within a block."""


@contextlib.contextmanager
def cluster_workers(address: str | None, processes: int) -> Iterator[ClusterPool]:
    """Let a cluster work within the block; an exception takes back what has not ended.

    Args:
        address: of a cluster, as Ray has it: "host:port", "ray://host:port" or "auto"; None begins one here.
        processes: how many work at a time on one that is begun here.

    Raises:
        MissingDependencyError: Ray is not installed.
        InvalidInputError: there is no cluster at the address, or none can be begun here.
    """
    os.environ.update(SILENCE if address else SILENCE | LOOPBACK)
    ray = optional_library("work on a cluster", "ray", "distributed")
    with one_thread_each():
        _connect(ray, address, processes)
        pool = ClusterPool(ray)
        try:
            yield pool
        except BaseException:
            pool.give_up()
            raise
        finally:
            ray.shutdown()


def _connect(ray: Any, address: str | None, processes: int) -> None:
    # "local", or Ray would join a cluster of somebody else's that it finds on this machine.
    here = {"address": "local", "num_cpus": processes, "include_dashboard": False}
    where = here if address is None else {"address": address}
    host, _, port = (address or "").removeprefix("ray://").rpartition(":")
    try:
        if host:  # Ray would wait for minutes
            socket.create_connection((host, int(port)), timeout=PATIENCE).close()
        _init(ray, where, ATTEMPTS)
    except Exception as error:
        raise InvalidInputError(
            f"Ray cannot begin a cluster on this machine: {error}; try again when it is less busy, or leave "
            "--distributed out"
            if address is None
            else f"no cluster of Ray answers at {address}: {error}; begin one with `ray start --head`, and give the "
            "address that it prints, or leave the address out"
        ) from error


def _init(ray: Any, where: dict[str, Any], attempts: int) -> None:
    try:
        ray.init(**where, logging_level=logging.ERROR, log_to_driver=False)
    except Exception as error:
        ray.shutdown()
        if attempts == 1 or type(error) is not Exception:  # Ray's for half a minute that was not enough
            raise
        _init(ray, where, attempts - 1)
