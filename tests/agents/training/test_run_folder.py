"""A run's folder: complete or absent snapshots, and nothing removed that is not a run's."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import RunFolder, RunPlan
from dq_marine.agents.training.snapshots import Progress
from dq_marine.errors import InvalidInputError


@pytest.fixture
def plan() -> RunPlan:
    return RunPlan(read_settings("ppo", TrainingSettings), seed=3, versions={"torch": "2"})


def begin(folder: RunFolder, plan: RunPlan, *, force: bool = False) -> None:
    with folder.begun(plan, force=force):
        pass


def replace(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def write_model(text: str):
    def write(folder: Path) -> None:
        (folder / "model.zip").write_text(text)

    return write


def test_plan_comes_back(tmp_path: Path, plan: RunPlan) -> None:
    folder = RunFolder(tmp_path / "run")
    begin(folder, plan)
    assert folder.read_plan() == plan


def test_a_run_is_replaced_only_by_force(tmp_path: Path, plan: RunPlan) -> None:
    folder = RunFolder(tmp_path / "run")
    begin(folder, plan)
    folder.save("best", Progress(10, 1.0), write_model("old"))
    (folder.path / "notes.txt").write_text("mine")
    with pytest.raises(InvalidInputError, match=r"holds a run already; continue it with --resume.*--force"):
        begin(folder, plan)
    assert folder.latest("best") is not None
    begin(folder, plan, force=True)
    assert folder.latest("best") is None
    assert (folder.path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("force", [False, True])
def test_what_is_no_run_is_left_alone(tmp_path: Path, plan: RunPlan, force: bool) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(InvalidInputError, match="is not a run"):
        begin(RunFolder(tmp_path), plan, force=force)
    with pytest.raises(InvalidInputError, match="is not a run"):
        begin(RunFolder(tmp_path / "thesis.tex"), plan, force=force)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_the_latest_snapshot_stays(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path)
    assert folder.progress("checkpoints") == Progress(0, 0.0)
    # A resumed run may be behind the best of the session that was killed.
    for timesteps in (100, 300, 200):
        folder.save("best", Progress(timesteps, 1.0, mean_return=5.0), write_model(str(timesteps)))
    assert folder.progress("best") == Progress(200, 1.0, 5.0)
    latest = folder.latest("best")
    assert latest is not None
    assert (latest / "model.zip").read_text() == "200"
    assert sorted(path.name for path in (tmp_path / "best").iterdir()) == ["000002", "000003"]


@pytest.mark.parametrize(
    "damage",
    [
        lambda snapshot: (snapshot / "model.zip").write_text("other"),
        lambda snapshot: (snapshot / "model.zip").write_text(""),
        lambda snapshot: (snapshot / "model.zip").unlink(),
        lambda snapshot: (snapshot / "progress.json").write_text("{"),
        lambda snapshot: (snapshot / "progress.json").unlink(),
        lambda snapshot: (snapshot / "progress.json").write_text("[]"),
        lambda snapshot: replace(snapshot / "progress.json", '"timesteps": ', '"timesteps": -'),
        lambda snapshot: replace(snapshot / "progress.json", '"wall_time": 1.0', '"wall_time": "a day"'),
        lambda snapshot: (snapshot / "progress.json").write_text("[" * 100_000),
        lambda snapshot: ((snapshot / "progress.json").unlink(), os.mkfifo(snapshot / "progress.json")),
        lambda snapshot: ((snapshot / "model.zip").unlink(), os.mkfifo(snapshot / "model.zip")),
        lambda snapshot: ((snapshot / "model.zip").unlink(), (snapshot / "model.zip").mkdir()),
    ],
    ids=[
        "changed",
        "emptied",
        "removed",
        "half of progress",
        "no progress",
        "other progress",
        "less than no progress",
        "a word for a number",
        "deep progress",
        "progress is a pipe",
        "model is a pipe",
        "model is a folder",
    ],
)
def test_a_damaged_snapshot_gives_way_to_the_one_before(
    tmp_path: Path, damage: Callable[[Path], object]
) -> None:
    folder = RunFolder(tmp_path)
    for timesteps in (100, 200):
        folder.save("checkpoints", Progress(timesteps, 1.0), write_model(str(timesteps)))
    damage(tmp_path / "checkpoints" / "000002")
    assert folder.progress("checkpoints").timesteps == 100
    folder.save("checkpoints", Progress(150, 1.0), write_model("150"))
    assert folder.progress("checkpoints").timesteps == 150
    damage(tmp_path / "checkpoints" / "000003")
    with pytest.raises(InvalidInputError, match=r"000003 is damaged.*--force"):
        folder.latest("checkpoints")


def test_two_trainings_keep_out_of_each_others_way(tmp_path: Path, plan: RunPlan) -> None:
    folder = RunFolder(tmp_path / "run")
    begin(folder, plan)
    with folder.locked():
        with pytest.raises(InvalidInputError, match=f"by process {os.getpid()}"), folder.locked():
            pass
        with pytest.raises(InvalidInputError, match="is being trained"):
            begin(RunFolder(tmp_path / "run"), plan, force=True)
        assert folder.holds_run
    begin(RunFolder(tmp_path / "run"), plan, force=True)


def test_a_snapshot_that_failed_leaves_the_one_before(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path)
    folder.save("checkpoints", Progress(1, 0.0), write_model("good"))

    def fail(snapshot: Path) -> None:
        write_model("half")(snapshot)
        raise OSError("disk full")

    with pytest.raises(InvalidInputError, match="cannot be written: disk full"):
        folder.save("checkpoints", Progress(2, 0.0), fail)
    assert folder.progress("checkpoints").timesteps == 1
    assert len(list((tmp_path / "checkpoints").iterdir())) == 1


def test_leftovers_of_a_killed_save_do_not_count(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path)
    folder.save("checkpoints", Progress(1, 0.0), write_model("good"))
    (tmp_path / "checkpoints" / ".incomplete-abc").mkdir()
    assert folder.progress("checkpoints").timesteps == 1


def test_damage_is_named(tmp_path: Path, plan: RunPlan) -> None:
    with pytest.raises(InvalidInputError, match=r"holds no run \(no run\.json\)"):
        RunFolder(tmp_path).read_plan()
    folder = RunFolder(tmp_path / "run")
    begin(folder, plan)
    for damaged in (
        "{}",
        "",
        "[" * 100_000,
        '{"seed": 1.5, "settings": {}, "versions": {}}',
        "\0",
        "[]",
        "3",
    ):
        (folder.path / "run.json").write_text(damaged)
        with pytest.raises(InvalidInputError, match=r"run\.json is damaged.*restore it.*--force"):
            folder.read_plan()
    (folder.path / "run.json").unlink()
    (folder.path / "run.json").mkdir()
    with pytest.raises(InvalidInputError, match="holds no run"):
        folder.read_plan()


def test_what_does_not_belong_to_a_snapshot_does_not_damage_it(tmp_path: Path) -> None:
    """As file managers and network disks leave it behind; nor does a file beside the snapshots."""
    folder = RunFolder(tmp_path)
    folder.save("best", Progress(1, 0.0), write_model("good"))
    (tmp_path / "best" / "000001" / ".DS_Store").write_text("view")
    (tmp_path / "best" / "000009").write_text("no folder")
    (tmp_path / "best" / "2 copy").mkdir()
    assert folder.progress("best").timesteps == 1
    folder.save("best", Progress(2, 0.0), write_model("better"))
    assert folder.progress("best").timesteps == 2


@pytest.mark.parametrize("path", ["~nosuchuser/run", "a\0b", "x" * 5000])
def test_what_can_be_no_folder_is_named(path: str) -> None:
    with pytest.raises(InvalidInputError, match=r"run = .* is no path of a file: .*; give another"):
        RunFolder(path)
