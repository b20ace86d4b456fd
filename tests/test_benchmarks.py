"""Benchmarks are run by hand and seldom: each script must still start after the package around it has moved."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"


@pytest.mark.sweep
@pytest.mark.parametrize("script", sorted(path.name for path in BENCHMARKS.glob("*.py")))
def test_a_script_teaches_its_use(script: str) -> None:
    result = subprocess.run(
        [sys.executable, str(BENCHMARKS / script), "--help"], capture_output=True, text=True, timeout=300.0
    )
    assert result.returncode == 0, result.stderr
    assert f"usage: {script}" in result.stdout
