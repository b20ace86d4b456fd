"""Commands whose output nobody takes, and processes without a home or a network, or with a clock that goes back."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from rich.console import Console
from support.sweeps import sweep
from support.trainings import tiny

from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training

VEHICLES = [sys.executable, "-m", "dq_marine", "vehicles"]
SHEET = [*VEHICLES, "sheet", "otter", "--json"]


def ended(command: Sequence[str], **keywords: object) -> subprocess.CompletedProcess:
    """A command that has ended, with what it wrote to standard error."""
    return subprocess.run(command, stderr=subprocess.PIPE, text=True, timeout=600.0, check=False, **keywords)


@pytest.mark.parametrize("command", sweep([VEHICLES, SHEET], plain=[SHEET]))
def test_a_reader_that_has_gone_is_no_mistake(command: list[str]) -> None:
    """As after `| head`: nothing is said."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        result = ended(command, stdout=writer)
    finally:
        os.close(writer)
    assert result.stderr == ""
    assert result.returncode == 1


@pytest.mark.parametrize("closed", sweep([1, 2, 3], plain=[2]))
def test_a_command_runs_without_its_first_standard_files(closed: int, tmp_path: Path) -> None:
    script = f'exec {" ".join(f"{one}>&-" for one in range(closed))}; exec "$@"'
    file = tmp_path / "mine.toml"
    command = [*VEHICLES, "export", "otter", str(file)]
    assert ended(["sh", "-c", script, "sh", *command]).returncode == 0
    assert "otter" in file.read_text().lower()


@pytest.mark.sweep  # a reader that has gone is one, too
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_output_to_a_full_disk_is_one_message() -> None:
    with Path("/dev/full").open("w") as full:
        for command in (VEHICLES, SHEET):
            result = ended(command, stdout=full)
            assert result.returncode == 1
            assert result.stderr.startswith(
                "Error: the output cannot be read or written: No space left on device; "
            )
            assert len(result.stderr.splitlines()) == 1, result.stderr


HOMELESS = """
import os, pwd
def nobody(*_):
    raise KeyError("no such user")
pwd.getpwuid = nobody
for name in ("HOME", "XDG_CACHE_HOME", "DQ_MARINE_CACHE_DIR"):
    os.environ.pop(name, None)
import dq_marine.viewer.transport.browser
from dq_marine.backend.compilation import compile_function
from dq_marine.algebra.vector3 import dot, norm
print(compile_function(dot, "a test")((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)))
print(compile_function(norm, "a test")((3.0, 4.0, 0.0)))
"""


@pytest.mark.sweep  # tests/backend/test_disk_cache.py has other folders that cannot be written
def test_who_has_no_home_compiles_anew() -> None:
    result = ended([sys.executable, "-c", HOMELESS], stdout=subprocess.PIPE)
    assert result.stdout == "32.0\n5.0\n", result.stderr
    assert (
        result.stderr.count(
            "there is no home to keep compiled code in; set DQ_MARINE_CACHE_DIR to a folder of yours"
        )
        == 1
    )
    assert "Traceback" not in result.stderr


LONELY = """
import fcntl, socket, struct, sys
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:  # SIOCSIFFLAGS: up and running
    fcntl.ioctl(control, 0x8914, struct.pack("16sH14s", b"lo", 0x1 | 0x40, b""))
assert [name for _, name in socket.if_nameindex()] == ["lo"]
sys.path.insert(0, sys.argv[1])
from urllib.request import urlopen
from viewer.samples import ROV, snapshot
from dq_marine.viewer import LiveViewer
with LiveViewer(ROV) as viewer:
    viewer.draw(snapshot(time=1.0))
    with urlopen(viewer.url) as page:
        print(page.status)
"""


def test_a_viewer_needs_no_network_but_its_own_computer() -> None:
    apart = ["unshare", "--user", "--map-root-user", "--net"]
    try:
        permitted = ended([*apart, "true"])
    except OSError as error:
        pytest.skip(f"no network can be left out here: {error}")
    if permitted.returncode:
        pytest.skip(f"no network can be left out here: {permitted.stderr.strip()}")
    tests = str(Path(__file__).parents[1])
    result = ended([*apart, sys.executable, "-c", LONELY, tests], stdout=subprocess.PIPE)
    assert result.stdout == "200\n", result.stderr


@pytest.mark.sweep  # tests/agents/training resumes one
def test_a_training_does_not_mind_a_clock_that_is_set_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By an hour at each look at it; how long a run took is told by a clock that nobody sets."""
    looks = iter(range(10**9))
    begun, begun_ns = time.time(), time.time_ns()
    monkeypatch.setattr(time, "time", lambda: begun - 3600.0 * next(looks))
    monkeypatch.setattr(time, "time_ns", lambda: begun_ns - 3600 * 10**9 * next(looks))
    folder = RunFolder(tmp_path / "run")
    summary = begin_training(folder, tiny(tmp_path, "ppo", 128), console=Console(file=io.StringIO()))
    assert summary.timesteps == folder.progress("checkpoints").timesteps == 128
    assert summary.wall_time > 0.0
    assert summary.steps_per_second > 0.0
    assert next(looks) > 1
