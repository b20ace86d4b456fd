"""A training with several seeds: what was done is kept, what was half done goes on, and no seed counts twice."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from support.command_line import assert_refused, run
from support.trainings import preset, tiny

from dq_marine.agents.seeds import one_seed, training
from dq_marine.agents.seeds.one_seed import take_over, train_seed_anywhere
from dq_marine.agents.seeds.results import SeedResult, result_of, results_table
from dq_marine.agents.seeds.seeds_folder import SeedsFolder
from dq_marine.agents.seeds.training import Way, by_team, one_after_the_other, train_seeds
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.run_folder import RunFolder, RunPlan
from dq_marine.agents.training.training import begin_training
from dq_marine.errors import InvalidInputError
from dq_marine.util.side_by_side import Team, team_here


@pytest.fixture
def console() -> Console:
    return Console(file=io.StringIO(), width=100)


@pytest.fixture
def settings(tmp_path: Path) -> TrainingSettings:
    return tiny(tmp_path, "ppo", 128)


def in_a_thread(tasks: int) -> Any:
    """A team of one: numbers would not follow from seeds if two drew from torch's one generator."""
    return ThreadPoolExecutor(1)


def numbers(results: list[SeedResult]) -> list[tuple[Any, ...]]:
    """What a result is but for how long it took."""
    return [(one.seed, one.timesteps, one.mean_return, one.success_rate, one.metrics) for one in results]


def half_done(run: RunFolder, settings: TrainingSettings, seed: int, console: Console) -> None:
    """Train half of a run, and leave it as if it had been stopped there."""
    half = settings.model_copy(update={"timesteps": settings.timesteps // 2})
    begin_training(run, half, seed=seed, console=console)
    plan = run.read_plan()
    run.write_plan(RunPlan(settings, seed, plan.versions))


@pytest.mark.parametrize("way", [one_after_the_other, by_team(in_a_thread)], ids=["here", "team"])
def test_a_half_done_set_of_seeds_goes_on(
    tmp_path: Path, settings: TrainingSettings, way: Way, console: Console
) -> None:
    folder = SeedsFolder(tmp_path / "runs")
    (first,) = train_seeds(folder, settings, range(3, 4), way=way, console=console)
    ended = (folder.run(3).path / "summary.json").stat()
    half_done(folder.run(4), settings, 4, console)
    results = train_seeds(folder, settings, range(3, 6), way=way, console=console)
    assert [one.seed for one in results] == [3, 4, 5]
    assert [one.timesteps for one in results] == [128, 128, 128]
    assert results[0] == first
    assert (folder.run(3).path / "summary.json").stat() == ended, "a finished seed was trained again"
    assert len(list(folder.run(4).tensorboard.rglob("events*"))) == 2, "the half done one did not go on"
    assert len({one.mean_return for one in results}) == 3
    assert train_seeds(folder, settings, range(3, 6), way=never, console=console) == results
    alone = RunFolder(tmp_path / "alone")
    begin_training(alone, settings, seed=5, console=console)
    assert numbers([result_of(alone, 5)]) == numbers(results[2:])


def never(*arguments: Any) -> Any:
    raise AssertionError("nothing was left to be trained")


@pytest.mark.slow
@pytest.mark.sweep
def test_processes_train_what_one_after_the_other_is_trained(
    tmp_path: Path, settings: TrainingSettings, console: Console
) -> None:
    ways = {"here": one_after_the_other, "processes": by_team(team_here(2))}
    found = [
        numbers(train_seeds(SeedsFolder(tmp_path / name), settings, range(3), way=way, console=console))
        for name, way in ways.items()
    ]
    assert found[0] == found[1]


def test_a_machine_that_does_not_see_the_folder_hands_its_run_over(
    tmp_path: Path, settings: TrainingSettings, console: Console
) -> None:
    here = SeedsFolder(tmp_path / "here")
    with here.begun(settings, force=False) as mark:
        half_done(here.run(0), settings, 0, console)
        for elsewhere in (SeedsFolder(tmp_path / "nowhere"), SeedsFolder(tmp_path / "another")):
            if elsewhere.path.name == "another":
                with elsewhere.begun(settings, force=False):
                    pass
            packed = train_seed_anywhere(elsewhere.path, mark, settings, 0)
            assert packed is not None
            assert not elsewhere.run(0).path.exists()
        take_over(packed, here.run(0))
    assert here.is_finished(0, settings)
    alone = RunFolder(tmp_path / "alone")
    begin_training(alone, settings, seed=0, console=console)
    assert numbers([result_of(here.run(0), 0)]) == numbers([result_of(alone, 0)])
    assert train_seed_anywhere(here.path, mark, settings, 0) is None


def test_a_seed_that_fails_leaves_the_others(
    tmp_path: Path, settings: TrainingSettings, console: Console, monkeypatch: pytest.MonkeyPatch
) -> None:
    trained: list[int] = []
    unlucky = {1}

    def train_seed(run: RunFolder, settings: TrainingSettings, seed: int, console: Console) -> None:
        if seed in unlucky:
            raise ValueError("not finite")
        trained.append(seed)
        one_seed_trained(run, settings, seed, console)

    one_seed_trained = one_seed.train_seed
    monkeypatch.setattr(training, "train_seed", train_seed)
    monkeypatch.setattr(one_seed, "train_seed", train_seed)
    folder = SeedsFolder(tmp_path / "runs")
    with pytest.raises(
        InvalidInputError, match="1 of 2 seeds failed, and the others are kept: seed 1: not f"
    ):
        train_seeds(folder, settings, range(2), way=one_after_the_other, console=console)
    with pytest.raises(
        InvalidInputError, match="1 of 2 seeds failed, and the others are kept: seed 1: not f"
    ):
        train_seeds(folder, settings, range(2), way=by_team(in_a_thread), console=console)
    unlucky.clear()
    results = train_seeds(folder, settings, range(2), way=one_after_the_other, console=console)
    assert [one.seed for one in results] == trained == [0, 1]


def test_a_process_that_is_killed_is_told_of_in_words(
    tmp_path: Path, settings: TrainingSettings, console: Console
) -> None:
    class Broken:
        def submit(self, *arguments: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(BrokenProcessPool())
            return future

    @contextmanager
    def broken(tasks: int) -> Iterator[Broken]:
        yield Broken()

    team: Team = broken
    with pytest.raises(
        InvalidInputError, match=r"was killed.*train fewer at a time.*goes on where they were"
    ):
        train_seeds(SeedsFolder(tmp_path / "runs"), settings, range(2), way=by_team(team), console=console)


def test_another_training_in_the_folder_is_named_and_replaced_only_by_force(
    tmp_path: Path, settings: TrainingSettings, console: Console
) -> None:
    folder, way = SeedsFolder(tmp_path / "runs"), one_after_the_other
    before = train_seeds(folder, settings, range(2), way=way, console=console)
    other = settings.model_copy(update={"timesteps": 64})
    with pytest.raises(
        InvalidInputError, match=r"holds another training: timesteps is 128, not 64; go on with"
    ):
        train_seeds(folder, other, range(2), way=never, console=console)
    (after,) = train_seeds(folder, other, range(1), way=way, force=True, console=console)
    assert after.timesteps == 64
    assert not folder.run(1).holds_run
    assert before[0].timesteps == 128
    folder.run(5).path.mkdir()
    folder.run(0).path.rename(tmp_path / "kept")
    begin_training(folder.run(1), settings, seed=1, console=console)
    begin_training(folder.run(2), other, seed=9, console=console)
    for seed, wrong in (
        (1, "another run in seed_1: timesteps is 128, not 64"),
        (2, "a run of seed 9, not 2"),
    ):
        with pytest.raises(InvalidInputError, match=wrong):
            train_seeds(folder, other, range(seed, seed + 1), way=never, console=console)


def test_what_is_no_training_is_refused_and_left(
    tmp_path: Path, settings: TrainingSettings, console: Console
) -> None:
    def train(folder: Path, seeds: range) -> None:
        train_seeds(SeedsFolder(folder), settings, seeds, way=never, console=console)

    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(InvalidInputError, match="exists and holds no training with several seeds"):
        train(tmp_path, range(2))
    for seeds, wrong in ((range(0), "seeds = 0"), (range(2**32 - 1, 2**32 + 1), "seed = 4294967296")):
        with pytest.raises(InvalidInputError, match=wrong):
            train(tmp_path / "new", seeds)
    assert not (tmp_path / "new").exists()
    (tmp_path / "seeds.json").write_text("{")
    with pytest.raises(InvalidInputError, match=r"seeds\.json is missing or damaged"):
        train(tmp_path, range(2))


def test_the_table_has_each_seed_their_mean_and_how_many_learned(tmp_path: Path) -> None:
    settings = tiny(tmp_path, "ppo")
    results = [
        SeedResult(
            seed, 256, 3.0, 5, mean_return, success, {"position_error_m": error, "attitude_error_deg": 9.0}
        )
        for seed, mean_return, success, error in (
            (0, 10.0, 1.0, 0.1),
            (1, 20.0, 0.8, 0.3),
            (2, 6.0, 0.6, 1.1),
        )
    ]
    wide = Console(file=io.StringIO(), width=200)
    wide.print(results_table(settings, results))
    text = wide.file.getvalue()  # type: ignore[attr-defined]
    rows = {line.split()[0]: line.split()[1:] for line in text.splitlines() if line.split()}
    assert rows["0"] == ["10.0", "0.100", "9.00", "100%", "256", "3"]
    assert rows["mean"] == ["12.0", "0.500", "9.00", "80%", "256", "3"]
    assert rows["sd"][:2] == ["7.2", "0.529"]
    assert "2 of 3 seeds learned it: at least 80% of their episodes succeeded" in " ".join(text.split())
    alone = Console(file=io.StringIO(), width=200)
    alone.print(results_table(settings, results[:1]))
    assert "mean" not in alone.file.getvalue().split("seed", 2)[2]  # type: ignore[attr-defined]


@pytest.mark.parametrize("damage", ["", "[]", '{"timesteps": 128, "score": 5}'])
def test_a_damaged_summary_is_told_of(tmp_path: Path, damage: str) -> None:
    (tmp_path / "summary.json").write_text(damage)
    with pytest.raises(InvalidInputError, match=r"summary\.json is missing or damaged: .*; remove it"):
        result_of(RunFolder(tmp_path), 0)


def test_seeds_from_the_command_line(tmp_path: Path) -> None:
    folder = tmp_path / "runs"
    command = ["train", "--run", folder, "--preset", preset(tmp_path, "ppo", 64), "--processes", "1"]
    done = run(*command, "--seeds", "1")
    assert done.exit_code == 0, done.output
    done = run(*command, "--seeds", "2")
    assert done.exit_code == 0, done.output
    said = " ".join(done.output.split())
    assert "Seed 1, in" in said
    assert "Seed 0, in" not in said
    assert "2 seeds learned it" in said
    with (folder / "seeds.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["seed"] for row in rows] == ["0", "1"]
    assert "final_position_error_m" in rows[0]
    done = run("evaluate", "--run", folder / "seed_0", "--run", folder / "seed_1", "--episodes", "1")
    assert done.exit_code == 0, done.output


def test_interrupted_seeds_say_how_to_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: Any, **keywords: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("dq_marine.cli.seeds.train_seeds", interrupted)
    done = run("train", "--run", tmp_path / "runs", "--seeds", "2")
    assert done.exit_code == 130
    assert "Go on with the same command." in done.output


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        (["--processes", "2"], "--processes needs --seeds"),
        (["--distributed", "--address", "h:1"], "--distributed, --address needs --seeds"),
        (["--seeds", "2", "--address", "h:1"], "--address h:1 needs --distributed"),
        (["--seeds", "2", "--resume"], "--resume cannot go with --seeds"),
        (["--seeds", "2", "--watch"], "--watch cannot go with --seeds"),
    ],
)
def test_options_that_do_not_go_together_are_refused(
    tmp_path: Path, options: list[str], pattern: str
) -> None:
    assert_refused(run("train", "--run", tmp_path / "runs", *options), pattern)
    assert not (tmp_path / "runs").exists()


def test_no_seeds_are_refused() -> None:
    done = run("train", "--run", "runs", "--seeds", "0")
    assert done.exit_code == 2
    assert "--seeds" in done.output
