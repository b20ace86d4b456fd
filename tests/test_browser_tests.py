"""Browser tests are skipped, counted and explained where there is no browser; CI skips none; a script gets one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.sweeps import sweep

from dq_marine.viewer.transport.browser import CHROMIUM_VARIABLES

TESTS = Path(__file__).parent
SCRIPT = TESTS.parent / ".ci" / "browser.sh"

PAGES = """
import pytest

@pytest.mark.browser
@pytest.mark.parametrize("page", range(3))
def test_page(page):
    assert page >= 0

def test_no_page():
    pytest.skip("for another reason")
"""


SETTINGS = ("CI", "DQ_MARINE_INSTALL_CHROMIUM", "PYTEST_ADDOPTS")
"""Variables that these tests set themselves, whatever the run of pytest was given."""


def environment(executable: Path, **more: str) -> dict[str, str]:
    """One whose browser is the given program, whatever the machine has."""
    return {
        **{name: value for name, value in os.environ.items() if name not in SETTINGS},
        CHROMIUM_VARIABLES[0]: str(executable),
        "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)]),
        **more,
    }


def program(path: Path, text: str) -> Path:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def run_pages(folder: Path, variables: dict[str, str]) -> list[str]:
    """Return the lines of a pytest that runs the pages above with the hooks of `support.browser`."""
    (folder / "test_pages.py").write_text(PAGES)
    (folder / "pytest.ini").write_text("[pytest]\nmarkers = browser: needs one\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "support.browser", "-p", "no:cacheprovider"]
    return subprocess.run(
        command, cwd=folder, env=variables, capture_output=True, text=True
    ).stdout.splitlines()


@pytest.mark.parametrize("stub", [False, True], ids=["none", "a stub that only tells where to get it"])
def test_without_a_browser_they_are_skipped_and_counted(stub: bool, tmp_path: Path) -> None:
    absent = tmp_path / "chromium"
    if stub:
        program(absent, "echo 'requires the chromium snap to be installed' >&2; exit 1")
    *_, said, last = run_pages(tmp_path, environment(absent))
    assert said.startswith("3 browser tests were skipped, because no Chromium")
    assert "apt-get install chromium" in said
    assert "$CHROME" in said
    assert "4 skipped" in last


def test_with_a_browser_they_run_and_nothing_is_said(tmp_path: Path) -> None:
    lines = run_pages(tmp_path, environment(program(tmp_path / "chromium", "echo Chromium 1.0")))
    assert "3 passed, 1 skipped" in lines[-1]
    assert "browser tests" not in "\n".join(lines)


def test_ci_skips_none(tmp_path: Path) -> None:
    lines = run_pages(tmp_path, environment(tmp_path / "absent", CI="true"))
    assert "3 passed, 1 skipped" in lines[-1]


def get_browser(variables: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = ["bash", str(SCRIPT), sys.executable]
    return subprocess.run(command, env=variables, capture_output=True, text=True)


def test_the_script_does_nothing_where_there_is_a_browser(tmp_path: Path) -> None:
    program(tmp_path / "apt-get", f"touch {tmp_path}/called")
    present = environment(program(tmp_path / "chromium", "echo Chromium 1.0"))
    done = get_browser({**present, "PATH": f"{tmp_path}:{present['PATH']}"})
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert not (tmp_path / "called").exists()


def test_the_script_fails_without_a_browser_in_ci_alone(tmp_path: Path) -> None:
    absent = environment(tmp_path / "absent", DQ_MARINE_INSTALL_CHROMIUM="no")
    done = get_browser(absent)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = get_browser({**absent, "CI": "true"})
    assert done.returncode == 1
    assert done.stderr == "dq-marine: there is no Chromium, and CI skips no test\n"


@pytest.mark.parametrize("rights", sweep(["root", "sudo without a password", "none"], plain=["root"]))
@pytest.mark.parametrize("works", [True, False], ids=["works", "fails"])
def test_the_script_installs_where_it_may(rights: str, works: bool, tmp_path: Path) -> None:
    browser = tmp_path / "chromium"
    made = (
        f"printf '#!/bin/sh\\necho Chromium 1.0\\n' >{browser}; chmod +x {browser}"
        if works
        else "echo no network; exit 100"
    )
    program(tmp_path / "apt-get", f'case "$*" in *install*) {made};; esac')
    program(tmp_path / "id", "echo 0" if rights == "root" else "echo 1000")
    program(tmp_path / "sudo", 'shift; exec "$@"' if rights.startswith("sudo") else "exit 1")
    variables = environment(browser)
    done = get_browser({**variables, "PATH": f"{tmp_path}:{variables['PATH']}"})
    assert (done.returncode, done.stdout) == (0, "")
    assert browser.exists() == (works and rights != "none")
    if rights == "none":
        assert done.stderr == ""
    else:
        assert done.stderr.startswith("dq-marine: installing Chromium with apt-get")
        assert ("could not be installed: no network" in done.stderr) == (not works)
