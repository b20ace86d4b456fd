"""What figures depend on besides what is measured: processor, versions, sources."""

from __future__ import annotations

import functools
import hashlib
import os
import platform
import shutil
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from dq_marine.engines.workers import usable_cores

PACKAGE = Path(__file__).parents[1]
LIBRARIES = ("dq-marine", "numpy", "numba", "llvmlite", "scipy", "mujoco", "gymnasium", "matplotlib")

SHOWING = (
    "presentation",
    "style",
    "axes",
    "curves",
    "fits",
    "orders",
    "overview",
    "rates",
    "advice",
    "page",
    "command",
)
"""Modules of the report that only show what was measured, besides `*_view` and `page_*`."""


def machine() -> dict[str, Any]:
    """Return what computes, without naming the computer."""
    return {
        "cpu": cpu_model(),
        "cores": usable_cores(),
        "system": f"{platform.system()} {platform.machine()}",
    }


def cpu_model() -> str:
    """Return the processor's name."""
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    if platform.system() == "Darwin":
        return said("sysctl", "-n", "machdep.cpu.brand_string") or platform.machine()
    return platform.processor() or platform.machine()


def versions() -> dict[str, str]:
    """Return what is installed, without what is not."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def commit() -> str:
    """Return the commit of a checkout, marked where the sources differ from it; empty for an installed package."""
    if not (PACKAGE.parent / ".git").exists():
        return ""
    name = said("git", "-C", str(PACKAGE.parent), "rev-parse", "--short", "HEAD")
    changed = said("git", "-C", str(PACKAGE.parent), "status", "--porcelain", "--", "dq_marine", "envs")
    return f"{name} and changes" if name and changed else name


def load() -> float | None:
    """Return how many processes wanted a core, on average over the last minute."""
    return round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None


@functools.cache
def source_fingerprint() -> str:
    """Return a hash over the sources that decide what is measured: not those that only show it."""
    digest = hashlib.sha256()
    for path in measuring_sources():
        digest.update(str(path.relative_to(PACKAGE)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def measuring_sources() -> list[Path]:
    """Return the files that decide what is measured; a checkout has the environments behind a link."""
    files = {path for folder in (PACKAGE, PACKAGE / "envs") for path in folder.rglob("*")}
    return sorted(path for path in files if path.suffix in (".py", ".toml") and measures(path))


def measures(path: Path) -> bool:
    """Whether a file decides what is measured."""
    inside = path.relative_to(PACKAGE).parts
    shows = inside[0] == "report" and only_shows(path.stem)
    return inside[0] not in ("agents", "viewer", "cli.py") and not shows


def only_shows(module: str) -> bool:
    """Whether a module of the report decides nothing about what is measured."""
    return module in SHOWING or module.endswith("_view") or module.startswith("page_")


def said(program: str, *arguments: str) -> str:
    """Return what a program prints, nothing if it is not there or fails."""
    found = shutil.which(program)
    if found is None:
        return ""
    outcome = subprocess.run([found, *arguments], capture_output=True, text=True, check=False)  # noqa: S603
    return outcome.stdout.strip() if outcome.returncode == 0 else ""
