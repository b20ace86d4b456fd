"""Every example runs; so does the README's first code, and its numbers are those of a run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_example(path, tmp_path):
    result = subprocess.run(
        [sys.executable, "-W", "error", str(path)], capture_output=True, text=True, cwd=tmp_path, timeout=300
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout


@pytest.mark.parametrize("number", range(3))
def test_readme_code(number, tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(blocks) == 3
    program = blocks[number]
    if "my_rov.toml" in program:
        (tmp_path / "my_rov.toml").write_text((ROOT / "dq_marine/vehicles/bluerov2_heavy.toml").read_text())
        program = "import gymnasium as gym, dq_marine\n" + program + "env.reset(seed=0)\n"
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=300,
    )
    assert result.returncode == 0, result.stderr
    if "save_html" in program:
        assert (tmp_path / "replay.html").stat().st_size > 10_000
