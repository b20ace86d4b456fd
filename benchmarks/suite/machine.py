"""What figures depend on besides the code measured: machine, versions, sources."""

from __future__ import annotations

import hashlib
import os
import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm

from dq_marine.engines.lanes import PRECISIONS, lanes_of
from dq_marine.engines.workers import usable_cores
from dq_marine.report.machine import cpu_model

ROOT = Path(__file__).parents[2]
SOURCES = (
    "dq_marine/assembly.py",
    "dq_marine/checks.py",
    "dq_marine/engines",
    "dq_marine/kernel",
    "dq_marine/scene.py",
    "dq_marine/terms.py",
    "dq_marine/vehicles",
    "envs",
    "agents",
)
"""What is measured: viewer, report and command line are not."""

PACKAGES = ("numpy", "numba", "llvmlite", "gymnasium", "stable-baselines3", "torch", "mujoco")
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


def versions() -> dict[str, str | None]:
    """Return what is installed, None for what is not."""
    found: dict[str, str | None] = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return found


def commit() -> str:
    """Return the commit, with a mark where the sources differ from it."""
    name = said("git", "rev-parse", "--short", "HEAD") or "unknown"
    changed = said("git", "status", "--porcelain", "--", *SOURCES, "benchmarks")
    return f"{name} and changes" if changed else name


def source_fingerprint() -> str:
    """Return a hash over the sources that are measured."""
    digest = hashlib.sha256()
    for top in SOURCES:
        for path in [ROOT / top, *sorted((ROOT / top).rglob("*"))]:
            if path.suffix in (".py", ".toml"):
                digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def load() -> float:
    """Return how many processes wanted a core, on average over the last minute."""
    return round(os.getloadavg()[0], 2)


def said(*command: str) -> str:
    """Return what a command prints, nothing if it fails."""
    try:
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""
