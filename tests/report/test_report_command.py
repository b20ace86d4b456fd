"""`dq-marine report`: clear refusals, exit codes, resuming, and the same errors each time."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from report import synthetic
from support.timings import without_timings
from typer.testing import CliRunner, Result

from dq_marine.cli.main import app
from dq_marine.report import command
from dq_marine.report.command import Request, failure_lines
from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.registry import STUDIES
from dq_marine.report.showing.page import make_page


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, ["report", *map(str, arguments)], env={"COLUMNS": "200"})


@pytest.fixture
def only_terms(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], Rows]], None]:
    """Leaves one study, whose one unit is measured by a function."""

    def leave(measure: Callable[[], Rows]) -> None:
        real = STUDIES["solver"]
        study = Study(
            "solver",
            real.title,
            real.method,
            lambda plan: [Unit("first", synthetic.solver), Unit("second", measure)],
            real.drawings,
            real.tables,
            real.findings,
            real.checks,
        )
        monkeypatch.setattr(command, "STUDIES", {"solver": study})

    return leave


def test_help_has_an_example() -> None:
    output = run("--help").output
    assert "Examples:" in output
    assert "dq-marine report --quick" in output


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--only", "everything"], "study everything is unknown; give any of work_precision"),
        (["--case", "titanic"], "case titanic is unknown; give any of torque_free_top"),
    ],
)
def test_unknown_names_are_refused(arguments: list[str], complaint: str, tmp_path: Path) -> None:
    result = run(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert complaint in " ".join(result.stderr.split())
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path, only_terms) -> None:
    only_terms(list)
    (tmp_path / "file").write_text("")
    result = run("--out", tmp_path / "file")
    assert result.exit_code == 1
    assert "cannot be written" in result.stderr


def test_a_run_writes_everything_and_says_where(tmp_path: Path, only_terms) -> None:
    only_terms(list)
    result = run("--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert f"Wrote {tmp_path / 'out' / 'index.html'}" in result.output
    assert "1 of 1 checks passed" in result.output
    files = {
        path.relative_to(tmp_path / "out").as_posix()
        for path in (tmp_path / "out").rglob("*")
        if path.is_file()
    }
    assert {"index.html", "report.md", "results.json", "data/solver.csv", "figures/solver.png"} <= files
    assert not any("incomplete" in name or "/." in name for name in files)


def test_a_check_that_fails_fails_the_command_after_the_page(tmp_path: Path, only_terms) -> None:
    only_terms(
        lambda: [{"scene": "ordinary", "method": "dqvi2", "how": "fallbacks", "iterations": 9, "steps": 4}]
    )
    result = run("--out", tmp_path)
    assert result.exit_code == 1
    assert "FAILED ordinary steps need neither fallback nor refusal: 4 fallbacks" in result.output
    assert "FAILED" in (tmp_path / "index.html").read_text()


def test_ctrl_c_keeps_what_was_measured_and_says_how_to_go_on(tmp_path: Path, only_terms) -> None:
    def interrupted() -> Rows:
        raise KeyboardInterrupt

    only_terms(interrupted)
    result = run("--quick", "--seed", "4", "--out", tmp_path)
    assert result.exit_code == 130
    words = " ".join(result.output.split())
    assert "Stopped; 1 of 2 parts are measured and kept." in words
    assert f"Go on: dq-marine report --quick --seed 4 --out {tmp_path}" in words
    assert not (tmp_path / "index.html").exists()
    only_terms(list)
    assert run("--quick", "--seed", "4", "--out", tmp_path).exit_code == 0


def test_the_command_to_go_on_has_all_options() -> None:
    request = Request(Path("x"), ("terms", "solver"), Plan(True, 2, ("munk_spheroid",)))
    assert request.command == (
        "dq-marine report --quick --only terms --only solver --case munk_spheroid --seed 2 --out x"
    )


def test_failures_are_named() -> None:
    results = {"stability_map": synthetic.stability()}
    assert list(failure_lines(make_page(STUDIES, results, Plan()))) == []
    results["stability_map"][0]["largest_step"] *= 0.5
    lines = list(failure_lines(make_page(STUDIES, results, Plan())))
    assert len(lines) == 1
    assert re.match(
        r"FAILED damping bound of RK4, quaternion: .*, where theory asks for h lambda = 2\.785", lines[0]
    )


@pytest.mark.parametrize("missing", ["matplotlib", "scipy"])
def test_a_missing_library_is_named_with_its_remedy(missing: str, tmp_path: Path) -> None:
    arguments = [
        "report",
        "--only",
        "work_precision",
        "--case",
        "kirchhoff_remus",
        "--quick",
        "--out",
        str(tmp_path),
    ]
    program = (
        f"import sys; sys.modules[{missing!r}] = None; from dq_marine.cli.main import app; app({arguments})"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.returncode == 1, result.stdout + result.stderr
    assert re.search(rf"Error: .* needs '{missing}[^']*', which is not installed", result.stderr), (
        result.stderr
    )
    assert 'pip install "dq-marine[report]"' in result.stderr
    assert "Traceback" not in result.stderr


CASE, MORE_CASES = ["--case", "munk_spheroid"], ["--case", "ship_restoring", "--case", "damped_bluerov2_x30"]
ONE_CASE = ["--only", "work_precision", *CASE]


class Made(NamedTuple):
    """A quick report: what was asked for, its folder, and what the command printed."""

    choice: list[str]
    folder: Path
    output: str

    def rows(self) -> dict[str, Rows]:
        """Return what was measured, by study."""
        return dict(json.loads((self.folder / "results.json").read_text())["studies"])


def make_quickly(choice: list[str], folder: Path) -> Made:
    result = run("--quick", *choice, "--out", folder)
    assert result.exit_code == 0, result.output
    return Made(choice, folder, result.output)


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """A quick report of all studies on three cases, which differ most."""
    return make_quickly([*CASE, *MORE_CASES], tmp_path_factory.mktemp("quick"))


@pytest.mark.slow
@pytest.mark.sweep  # it compiles every method; a plain run has them one by one in the files beside this one
def test_the_quick_report_passes_its_checks_and_is_there_at_once_the_second_time(quick: Made) -> None:
    decided = re.search(r"(\d+) of \1 checks passed", quick.output)
    assert decided, quick.output
    text, rows = (quick.folder / "index.html").read_text(), quick.rows()
    assert int(decided[1]) >= 70, "most orders can be read off"
    assert set(rows) == set(STUDIES)
    for name in rows:
        assert STUDIES[name].title in text
    assert text.count("<figure ") == sum(len(STUDIES[name].drawings(rows[name])) for name in rows)
    times = {path: path.stat().st_mtime_ns for path in (quick.folder / "measured").rglob("*.json")}
    make_quickly(quick.choice, quick.folder)
    assert times == {path: path.stat().st_mtime_ns for path in (quick.folder / "measured").rglob("*.json")}


@pytest.mark.slow
@pytest.mark.sweep
def test_two_runs_have_the_same_errors(quick: Made, tmp_path: Path) -> None:
    """To the last digit: only times differ."""
    again = make_quickly(ONE_CASE, tmp_path).rows()
    for study, rows in again.items():
        first = [row for row in quick.rows()[study] if row.get("case") in {row.get("case") for row in rows}]
        assert without_timings(rows) == without_timings(first)
