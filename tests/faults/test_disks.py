"""Full and read-only disks end in one error that says so, and leave what was there before."""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from rich.console import Console
from support.command_line import assert_refused, run
from support.disks import files_of_at_most, mounted, read_only
from support.sweeps import sweep
from support.trainings import preset, tiny

from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training, resume_training
from dq_marine.errors import InvalidInputError

FULL = r"cannot be written: (No space left on device|File too large); free some space on its disk"


@pytest.fixture(params=["a small disk", "a share of a disk"])
def little_space(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Path]:
    """A folder for 30 kB, or for files of at most 30 kB: a network of 8 neurons takes 40."""
    if request.param == "a small disk":
        with mounted(tmp_path / "disk", "size=30k") as folder:
            yield folder
    else:
        (tmp_path / "disk").mkdir()
        with files_of_at_most(30_000):
            yield tmp_path / "disk"


@pytest.mark.parametrize("algorithm", sweep(["ppo", "sac"], plain=["ppo"]))
def test_a_training_on_a_full_disk_says_so(little_space: Path, tmp_path: Path, algorithm: str) -> None:
    folder = RunFolder(little_space / "run")
    with pytest.raises(InvalidInputError, match=FULL):
        begin_training(folder, tiny(tmp_path, algorithm), console=Console(file=io.StringIO()))
    assert folder.latest("checkpoints") is None
    assert not list((little_space / "run").rglob(".incomplete*"))


def test_a_training_whose_disk_became_full_keeps_its_checkpoints(tmp_path: Path) -> None:
    folder, console = RunFolder(tmp_path / "run"), Console(file=io.StringIO())
    begin_training(folder, tiny(tmp_path, "ppo", 64), console=console)
    before = folder.latest("checkpoints")
    with files_of_at_most(10_000), pytest.raises(InvalidInputError, match=FULL):
        resume_training(folder, timesteps=256, console=console)
    assert folder.latest("checkpoints") == before
    assert resume_training(folder, timesteps=256, console=console).timesteps == 256


FILES = [("--html", "replay.html"), ("--plot", "p.png"), ("--trajectory", "t.csv")]


@pytest.mark.parametrize(("option", "name"), sweep(FILES, plain=FILES[:1]))
def test_a_flight_on_a_full_disk_says_so(little_space: Path, option: str, name: str) -> None:
    file = little_space / name
    file.write_text("what was there before")
    arguments = ["fly", "--agent", "zero", "--seconds", "30", "--seed", "1", option]
    assert_refused(run(*arguments, file), f"{name} {FULL}")
    assert [one.name for one in little_space.iterdir()] == [name]
    assert file.read_text() == "what was there before"


def test_a_read_only_disk_is_named(tmp_path: Path) -> None:
    with mounted(tmp_path / "disk", "ro") as folder:
        refused = r"cannot be written: Read-only file system; give a folder that can be written"
        assert_refused(run("train", "--run", folder / "run", "--preset", preset(tmp_path, "ppo")), refused)
        refused = r"cannot be written: Read-only file system; give a file in"
        for option in ("--html", "--plot"):
            file = folder / f"picture.{'html' if option == '--html' else 'png'}"
            assert_refused(run("fly", "--agent", "zero", "--seconds", "1", option, file), refused)


def test_a_run_on_a_read_only_disk_is_flown_but_not_resumed(tmp_path: Path) -> None:
    begin_training(
        RunFolder(tmp_path / "run"), tiny(tmp_path, "ppo", 64), console=Console(file=io.StringIO())
    )
    with mounted(tmp_path / "disk", "size=4m") as folder:
        shutil.copytree(tmp_path / "run", folder / "run")
        with read_only(folder):
            flown = run("evaluate", "--run", folder / "run", "--episodes", "1")
            assert flown.exit_code == 0, flown.output
            assert_refused(
                run("train", "--run", folder / "run", "--resume", "--timesteps", "128"),
                "Read-only file system",
            )
