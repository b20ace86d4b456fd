"""Drawing libraries are loaded only when something is drawn, and a missing one is named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from viewer.samples import ROV, snapshot

from dq_marine.errors import MissingDependencyError
from dq_marine.viewer import LiveViewer, OffscreenViewer, find_chromium, save_replay
from dq_marine.viewer.browser import CHROMIUM_VARIABLE

INSTALL = r'pip install "dq-marine\[render\]"'


def test_import_loads_no_drawing_library() -> None:
    script = (
        "import sys, dq_marine.viewer;"
        "print([m for m in ('meshcat', 'zmq', 'tornado', 'umsgpack', 'PIL') if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


@pytest.mark.parametrize("name", ["meshcat", "zmq", "tornado", "umsgpack"])
def test_live_viewer_names_the_missing_library(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingDependencyError, match=f"'{name}'.*{INSTALL}"):
        LiveViewer(ROV)


@pytest.mark.parametrize("name", ["meshcat", "umsgpack"])
def test_replay_names_the_missing_library(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingDependencyError, match=f"'{name}'.*{INSTALL}"):
        save_replay(tmp_path / "replay.html", [snapshot()], ROV)
    assert list(tmp_path.iterdir()) == []


def test_offscreen_viewer_needs_pillow(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chromium = tmp_path / "chromium"
    chromium.write_text("#!/bin/sh\n")
    chromium.chmod(0o755)
    monkeypatch.setenv(CHROMIUM_VARIABLE, str(chromium))
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    with pytest.raises(MissingDependencyError, match=f"'PIL.Image'.*{INSTALL}"):
        OffscreenViewer(ROV)


def test_missing_chromium_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(CHROMIUM_VARIABLE, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(MissingDependencyError, match=f"apt-get install chromium.*{CHROMIUM_VARIABLE}"):
        OffscreenViewer(ROV)


def test_variable_names_the_chromium(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    mine = tmp_path / "my-chromium"
    mine.write_text("#!/bin/sh\n")
    mine.chmod(0o755)
    monkeypatch.setenv(CHROMIUM_VARIABLE, str(mine))
    assert find_chromium() == str(mine)
    monkeypatch.setenv(CHROMIUM_VARIABLE, str(tmp_path / "absent"))
    with pytest.raises(MissingDependencyError, match=r"absent.*no program"):
        find_chromium()
