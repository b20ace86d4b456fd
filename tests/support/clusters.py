"""Clusters of Ray on this machine; what imports this is skipped where Ray is not installed."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from dq_marine.util.cluster import LOOPBACK, SILENCE

os.environ.update(SILENCE | LOOPBACK)  # read when Ray is imported
ray: Any = pytest.importorskip("ray")

from ray.cluster_utils import Cluster  # noqa: E402

PATIENCE = 900.0
"""With a busy machine, to begin workers [s]."""


@contextlib.contextmanager
def two_machines() -> Iterator[tuple[Any, list[Any]]]:
    """A cluster of a head that does no work and two machines with a processor each."""
    cluster, machines = _begun()
    try:
        yield cluster, machines
    finally:
        cluster.shutdown()


def _begun(attempts: int = 5) -> tuple[Any, list[Any]]:
    """Begin a cluster: Ray waits half a minute for each machine, which now and then is not enough on a busy one."""
    cluster = Cluster()
    try:
        cluster.add_node(num_cpus=0, include_dashboard=False)
        return cluster, [cluster.add_node(num_cpus=1) for _ in range(2)]
    except Exception:
        cluster.shutdown()
        if attempts == 1:
            raise
    return _begun(attempts - 1)


def alive() -> set[str]:
    """The machines that the cluster takes to be alive."""
    return {node["NodeID"] for node in ray.nodes() if node["Alive"]}


def wait_until(holds: Callable[[], bool], every: float = 0.1) -> None:
    """Return when `holds` does, which a busy machine may need minutes for."""
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end, "what was waited for did not come"
        time.sleep(every)
