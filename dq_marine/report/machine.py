"""What figures depend on besides what is measured: machine, versions, commit."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm

from dq_marine.backend.simd.lanes import PRECISIONS, lanes_of
from dq_marine.backend.workers import usable_cores
from dq_marine.report.sources import PACKAGE

LIBRARIES = ("dq-marine", "numpy", "numba", "llvmlite", "scipy", "mujoco", "gymnasium", "matplotlib")
"""That the report's figures depend on."""

SIMD_LEVELS = {
    "avx512f": "AVX-512",
    "avx2": "AVX2",
    "avx": "AVX",
    "sse2": "SSE2",
    "sve": "SVE",
    "neon": "NEON",
}
"""LLVM's names of the features that decide how wide a register is, widest first."""


def machine() -> dict[str, Any]:
    """Return what computes, without naming the computer."""
    return {
        "cpu": cpu_model(),
        "llvm_cpu": llvm.get_host_cpu_name(),
        "simd": simd_level(),
        "cores": usable_cores(),
        "lanes": {name: lanes_of(name, "strict").width for name in PRECISIONS},
        "system": f"{platform.system()} {platform.machine()}",
    }


def simd_level() -> str:
    """Return the widest kind of vector registers."""
    features = llvm.get_host_cpu_features()
    return next((name for feature, name in SIMD_LEVELS.items() if features.get(feature)), "unknown")


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


def versions(libraries: Iterable[str] = LIBRARIES) -> dict[str, str]:
    """Return what is installed, without what is not."""
    found = {"python": platform.python_version()}
    for name in libraries:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def commit(*folders: str) -> str:
    """Return the commit of a checkout, marked where the folders differ from it; empty for an installed package."""
    if not (PACKAGE.parent / ".git").exists():
        return ""
    name = said("git", "-C", str(PACKAGE.parent), "rev-parse", "--short", "HEAD")
    changed = said("git", "-C", str(PACKAGE.parent), "status", "--porcelain", "--", *folders)
    return f"{name} and changes" if name and changed else name


def load() -> float | None:
    """Return how many processes wanted a core, on average over the last minute."""
    return round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None


def said(program: str, *arguments: str) -> str:
    """Return what a program prints, nothing if it is not there or fails."""
    found = shutil.which(program)
    if found is None:
        return ""
    outcome = subprocess.run([found, *arguments], capture_output=True, text=True, check=False)  # noqa: S603
    return outcome.stdout.strip() if outcome.returncode == 0 else ""
