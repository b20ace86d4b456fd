"""Every example runs; so does the README's first code, and its numbers are those of a run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.sweeps import sweep

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*.py"))
LONG = {
    "evaluate_with_plots",
    "hindsight_replay",
    "sensors_and_randomisation",
    "several_vessels",
    "ship_in_waves",
    "train_with_sb3",
}
AS_ON_A_PAGE = {
    "custom_task",
    "own_force",
    "own_reward",
    "own_vehicle",
}  # tests/cli/test_add.py flies the like


@pytest.mark.parametrize("name", sweep(EXAMPLES, plain=sorted(set(EXAMPLES) - LONG - AS_ON_A_PAGE)))
def test_example(name, tmp_path):
    path = ROOT / "examples" / f"{name}.py"
    result = subprocess.run(
        [sys.executable, "-W", "error", str(path)], capture_output=True, text=True, cwd=tmp_path, timeout=1800
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout


FIRST_BLOCKS = 4  # of README's programs; a plain run keeps them
BLOCKS = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)


@pytest.mark.parametrize(
    "program",
    sweep(BLOCKS, plain=BLOCKS[:FIRST_BLOCKS]),
    ids=lambda program: program.strip().splitlines()[-1][:40],
)
def test_readme_code(program, tmp_path):
    if "my_rov.toml" in program:
        (tmp_path / "my_rov.toml").write_text(
            (ROOT / "dq_marine/vehicles/catalogue/bluerov2_heavy.toml").read_text()
        )
        program += "env.reset(seed=0)\n"
    program = "import gymnasium as gym, dq_marine\n" + program
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=1800,
    )
    assert result.returncode == 0, result.stderr
    if "save_html" in program:
        assert (tmp_path / "replay.html").stat().st_size > 10_000
