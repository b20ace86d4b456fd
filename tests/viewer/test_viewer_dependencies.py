"""Drawing libraries are loaded only when something is drawn, and a missing one is named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from viewer.samples import ROV, snapshot

from dq_marine.errors import MissingDependencyError
from dq_marine.viewer import LiveViewer, OffscreenViewer, find_chromium, save_replay
from dq_marine.viewer.transport import browser
from dq_marine.viewer.transport.browser import CHROMIUM_VARIABLES

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


def program(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The only folder where programs are looked for, on a machine without a browser."""
    for variable in CHROMIUM_VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(browser, "APPLICATION_FOLDERS", (tmp_path / "Applications",))
    return tmp_path / "bin"


@pytest.mark.usefixtures("bare")
def test_the_library_that_pip_installs_is_named_before_the_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    with pytest.raises(MissingDependencyError, match=f"'PIL.Image'.*{INSTALL}"):
        OffscreenViewer(ROV)


@pytest.mark.usefixtures("bare")
def test_missing_chromium_is_named() -> None:
    with pytest.raises(
        MissingDependencyError, match=r"apt-get install chromium.*DQ_MARINE_CHROMIUM or CHROME"
    ):
        OffscreenViewer(ROV)


@pytest.mark.parametrize("variable", CHROMIUM_VARIABLES)
def test_a_variable_names_the_browser(variable: str, bare: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program(bare / "chromium")
    mine = program(bare.parent / "mine" / "my browser")
    monkeypatch.setenv(variable, str(mine))
    assert find_chromium() == str(mine)
    monkeypatch.setenv(variable, "chromium")  # a name will do
    assert find_chromium() == str(bare / "chromium")
    monkeypatch.setenv(variable, str(bare / "absent"))
    with pytest.raises(MissingDependencyError, match=rf"{variable} = .*absent.*no program"):
        find_chromium()
    monkeypatch.setenv(variable, "")
    assert find_chromium() == str(bare / "chromium")


@pytest.mark.parametrize("name", ["chromium-browser", "google-chrome", "google-chrome-stable", "chrome"])
def test_a_browser_of_another_name_is_found(name: str, bare: Path) -> None:
    mine = program(bare / name)
    assert find_chromium() == str(mine)
    first = program(bare / "chromium")
    assert find_chromium() == str(first)


@pytest.mark.parametrize("inside", browser.APPLICATIONS)
def test_an_application_of_macos_is_found(inside: str, bare: Path) -> None:
    mine = program(bare.parent / "Applications" / inside)
    assert find_chromium() == str(mine)
