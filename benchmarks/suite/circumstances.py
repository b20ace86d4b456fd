"""What the figures here depend on besides the machine: sources and libraries."""

from __future__ import annotations

from dq_marine.report import machine
from dq_marine.report.sources import PACKAGE, fingerprint, sources

ROOT = PACKAGE.parent

NOT_MEASURED = ("cli", "manoeuvres", "report", "viewer")
"""Folders of the package whose changes make no figures old; every other file counts.

The section `viewer` measures one of them: after a change of it, `--only viewer --fresh` measures it again.
"""

MEASURED_FOLDERS = ("dq_marine", "envs", "agents", "benchmarks")
"""Of the checkout: a commit is marked where they differ from it."""

LIBRARIES = ("numpy", "numba", "llvmlite", "gymnasium", "stable-baselines3", "torch", "mujoco")


def source_fingerprint() -> str:
    """Return a hash over the sources that are measured."""
    return fingerprint(sources(without=NOT_MEASURED))


def commit() -> str:
    """Return the commit, with a mark where the sources differ from it."""
    return machine.commit(*MEASURED_FOLDERS) or "unknown"


def versions() -> dict[str, str]:
    """Return what is installed, without what is not."""
    return machine.versions(LIBRARIES)
