"""Trainings that are killed at any moment, stopped and continued, or run twice at once; a viewer that is stopped."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from support.command_line import assert_refused, run
from support.trainings import preset

from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.snapshots import is_whole

PATIENCE = 300.0

KILLS = """
import json, os, random, signal, sys, time
from pathlib import Path
from rich.console import Console
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training, resume_training

runs, preset, first, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
settings, console = read_settings(preset, TrainingSettings), Console(file=open(os.devnull, "w"))

def train(folder):
    if folder.holds_run:
        resume_training(folder, console=console)
    else:
        begin_training(folder, settings, console=console)

def forked(folder):
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        train(folder)
        code = 0
    finally:
        os._exit(code)

begun = time.monotonic()
assert os.waitpid(forked(RunFolder(runs / "whole")), 0)[1] == 0
longest = time.monotonic() - begun
ends = []
for seed in range(first, first + count):
    moments, folder = random.Random(seed), RunFolder(runs / str(seed))
    for kill in range(3):
        child = forked(folder)
        time.sleep(moments.uniform(0.0, longest))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        if (folder.path / "summary.json").exists():
            break
    else:
        ends.append(os.waitpid(forked(folder), 0)[1])
print(json.dumps(ends))
"""


@pytest.mark.slow
@pytest.mark.sweep  # one that is killed once is in tests/agents/training/test_training.py
def test_a_training_killed_three_times_at_any_moment_becomes_whole(tmp_path: Path) -> None:
    first, count = 0, 6
    arguments = [str(tmp_path), str(preset(tmp_path, "ppo", 256)), str(first), str(count)]
    ended = subprocess.run(
        [sys.executable, "-c", KILLS, *arguments], capture_output=True, text=True, timeout=1800.0, check=False
    )
    assert ended.returncode == 0, ended.stderr
    ends = json.loads(ended.stdout)
    assert ends == [0] * len(ends), ended.stderr
    for seed in range(first, first + count):
        folder = RunFolder(tmp_path / str(seed))
        assert folder.progress("checkpoints").timesteps == 256
        assert json.loads((folder.path / "summary.json").read_text())["timesteps"] == 256
        assert all(
            is_whole(one) for kind in ("checkpoints", "best") for one in (folder.path / kind).glob("[0-9]*")
        )


def wait_until(true: Callable[[], bool], process: subprocess.Popen) -> None:
    """Wait for something that another process does."""
    deadline = time.monotonic() + PATIENCE
    while not true():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline, "it took too long"
        time.sleep(0.01)


def is_stopped(pid: int) -> bool:
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "T"


@pytest.mark.sweep  # tests/agents/training has one that is killed
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="/proc tells whether a process is stopped")
def test_a_training_that_is_stopped_goes_on_and_keeps_others_out(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "run")
    chosen = preset(tmp_path, "ppo", 256)
    arguments = ["train", "--run", str(folder.path), "--preset", str(chosen)]
    command = [sys.executable, "-m", "dq_marine", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            wait_until(lambda: folder.latest("checkpoints") is not None, process)
            process.send_signal(signal.SIGSTOP)
            wait_until(lambda: is_stopped(process.pid), process)
            for other in (["--resume"], ["--preset", chosen, "--force"]):
                assert_refused(
                    run("train", "--run", folder.path, *other),
                    f"is being trained by process {process.pid}; wait",
                )
            before = folder.progress("checkpoints")
            process.send_signal(signal.SIGCONT)
            assert process.wait(PATIENCE) == 0, process.communicate()
        finally:
            process.kill()
    assert before.timesteps < folder.progress("checkpoints").timesteps == 256
    assert_refused(run("train", "--run", folder.path, "--resume"), "learned from 256 timesteps, of 256")


VIEWED = """
import sys
sys.path.insert(0, sys.argv[1])
from viewer.samples import ROV, snapshot
from dq_marine.viewer import LiveViewer
from dq_marine.viewer.transport import server_process
server_process.REPLY_TIMEOUT = 2.0
with LiveViewer(ROV) as viewer:
    print(viewer._server.pid, flush=True)
    for line in sys.stdin:
        for time in range(int(line)):
            viewer.draw(snapshot(time=float(time)))
        print("drawn", flush=True)
"""


def test_a_viewer_that_is_stopped_with_its_server_goes_on() -> None:
    """As a container is paused: while it draws, for longer than an answer of its server may take."""
    command = [sys.executable, "-c", VIEWED, str(Path(__file__).parents[1])]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            server = int(process.stdout.readline())
            os.kill(server, signal.SIGSTOP)
            process.stdin.write("10\n")
            process.stdin.flush()
            time.sleep(0.1)
            os.kill(process.pid, signal.SIGSTOP)
            time.sleep(2.1)
            os.kill(process.pid, signal.SIGCONT)
            time.sleep(0.3)  # it looks for an answer, and there is none yet
            os.kill(server, signal.SIGCONT)
            assert process.stdout.readline() == "drawn\n"
            process.stdin.close()
            assert process.wait(PATIENCE) == 0
        finally:
            process.kill()
