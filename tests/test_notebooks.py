"""The notebooks of `examples` run, show what they say, and are kept without outputs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
NOTEBOOKS = sorted(EXAMPLES.glob("*.ipynb"))

RUN = """
import sys, nbformat
from nbclient import NotebookClient
notebook = nbformat.read(sys.argv[1], as_version=4)
NotebookClient(notebook, timeout=1800).execute()
nbformat.write(notebook, "run.ipynb")
"""


def outputs_of(path: Path) -> list[dict[str, Any]]:
    """The outputs of all cells of code, in order."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [output for cell in cells if cell["cell_type"] == "code" for output in cell["outputs"]]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_kept_without_outputs(path: Path) -> None:
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    assert outputs_of(path) == []
    assert {cell["execution_count"] for cell in cells if cell["cell_type"] == "code"} == {None}


@pytest.mark.sweep
def test_the_first_steps_run_and_show_the_environment_and_its_replay(tmp_path: Path) -> None:
    """In a process of its own: what Jupyter warns of is not ours."""
    result = subprocess.run(
        [sys.executable, "-c", RUN, str(EXAMPLES / "first_steps.ipynb")],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=3600,
    )
    assert result.returncode == 0, result.stderr
    shown = [output for output in outputs_of(tmp_path / "run.ipynb") if "data" in output]
    pages = ["".join(output["data"].get("text/html", "")) for output in shown]
    assert "BlueROV2 Heavy" in pages[0]
    assert any("image/png" in output["data"] for output in shown)
    assert "<iframe" in pages[-1]
    assert "srcdoc" in pages[-1]
