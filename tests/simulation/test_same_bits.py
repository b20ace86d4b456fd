"""Same seed, same bits, whatever BLAS, NumPy and the compiler make of a processor and of its vectors."""

from __future__ import annotations

import ast
import functools
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

TESTS = Path(__file__).parents[1]
PACKAGE = TESTS.parent / "dq_marine"
PROMISED = ("checks.py", "algebra", "integrator", "task", "backend", "simulation", "envs")
"""What every step, start and observation goes through."""

BLAS = {"linalg", "norm", "dot", "vdot", "inner", "outer", "matmul", "einsum", "tensordot"}
"""Names of NumPy that lead to BLAS, or to sums in an order that depends on the processor."""

PROCESSORS = {"Prescott": (), "Haswell": ("AVX2", "FMA3"), "SkylakeX": ("AVX512_SKX",)}
"""OpenBLAS's kernels, and what of NumPy's features a processor must have to run them."""

TARGETS = {"x86-64": (), "haswell": ("AVX2", "FMA3"), "skylake-avx512": ("AVX512_SKX",)}
"""LLVM's processors with vectors of two, four and eight numbers."""

DISPATCHED = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
"""What NumPy can leave out here."""

WIDE = [name for name in DISPATCHED if "512" in name or name.endswith("V4")]
PLAIN = {"OPENBLAS_CORETYPE": "Prescott", "NPY_DISABLE_CPU_FEATURES": " ".join(DISPATCHED)}

on_x86 = pytest.mark.skipif(
    platform.machine().lower() not in ("x86_64", "amd64"), reason="the variants are those of x86 processors"
)


def runs_here(features: tuple[str, ...]) -> bool:
    """Whether this processor has the features."""
    return all(__cpu_features__.get(name) for name in features)


NARROWER = dict([one for one in TARGETS.items() if runs_here(one[1])][:-1])
"""Targets whose vectors are narrower than this processor's own, which the usual bits come from."""


def variants() -> list[object]:
    """Environment variables that leave out some of what the processor can do."""
    found = [
        pytest.param({variable: name, **more}, id=f"{variable}={name}", marks=_needs(features))
        for variable, kinds, more in (
            ("OPENBLAS_CORETYPE", PROCESSORS, {}),
            ("NUMBA_CPU_NAME", NARROWER, {"NUMBA_CPU_FEATURES": ""}),
        )
        for name, features in kinds.items()
    ]
    narrow = {"NPY_DISABLE_CPU_FEATURES": " ".join(WIDE)}
    return [*found, pytest.param(narrow, id="NumPy without AVX-512"), pytest.param(PLAIN, id="plain NumPy")]


def _needs(features: tuple[str, ...]) -> pytest.MarkDecorator:
    return pytest.mark.skipif(not runs_here(features), reason=f"this processor lacks {' or '.join(features)}")


def printed(variables: dict[str, str], *parts: str) -> dict[str, list[str]]:
    """What `support.bits` prints in a process of its own, with some environment variables."""
    command = [sys.executable, "-m", "support.bits", *parts]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))} | variables
    done = subprocess.run(command, cwd=TESTS, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, list[str]] = json.loads(done.stdout)
    assert list(found) == list(parts)
    return found


@functools.cache
def usual(*parts: str) -> dict[str, list[str]]:
    """The same on the processor as it is."""
    return printed({}, *parts)


def assert_bits_are_the_usual(found: dict[str, list[str]]) -> None:
    for name, (alone, together) in found.items():
        assert alone == together, f"{name}: alone and together differ"
    assert found == usual(*found)


def sources(folder: Path) -> list[Path]:
    """Python files of a folder, or the file itself."""
    return sorted(folder.resolve().rglob("*.py")) if folder.is_dir() else [folder]


@pytest.mark.parametrize("name", PROMISED)
def test_nothing_that_promises_bits_goes_through_blas(name: str) -> None:
    found = [
        f"{path.name}:{node.lineno}"
        for path in sources(PACKAGE / name)
        for node in ast.walk(ast.parse(path.read_text()))
        if (isinstance(node, ast.Attribute) and node.attr in BLAS)
        or (isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.MatMult))
    ]
    assert sources(PACKAGE / name)
    assert found == []


@on_x86
def test_bodies_are_placed_with_the_same_bits_by_the_plainest_numpy() -> None:
    assert_bits_are_the_usual(printed(PLAIN, "starts"))


@on_x86
@pytest.mark.slow
@pytest.mark.sweep
@pytest.mark.parametrize("variables", variants())
def test_flights_and_episodes_have_the_same_bits_on_all_processors(variables: dict[str, str]) -> None:
    assert_bits_are_the_usual(printed(variables, "starts", "flights", "episodes"))
