"""What is measured again when sources change, and what a page says of where it was made."""

from __future__ import annotations

from dq_marine.report import machine
from dq_marine.report.sources import ONLY_SHOWING, PACKAGE, sources


def names() -> set[str]:
    return {path.relative_to(PACKAGE).as_posix() for path in sources(without=ONLY_SHOWING)}


def test_what_decides_the_numbers_counts_and_what_shows_them_does_not() -> None:
    found = names()
    for name in (
        "integrator/drift.py",
        "simulation/one_body.py",
        "report/baselines/rk4_quaternion.py",
        "vehicles/catalogue/bluerov2_heavy.toml",
        "envs/tasks/station_keeping.py",
        "report/cases.py",
        "report/work_precision.py",
        "report/trial.py",
    ):
        assert name in found, name
    for name in ("cli/main.py", "report/showing/page_html.py", "report/showing/work_precision_view.py"):
        assert name not in found, name
    assert not any(name.startswith(("agents/", "viewer/")) for name in found)


def test_every_folder_that_only_shows_is_there() -> None:
    assert all((PACKAGE / folder).is_dir() for folder in ONLY_SHOWING)


def test_every_other_file_of_the_package_counts() -> None:
    counted, every = set(sources(without=ONLY_SHOWING)), set(sources(without=()))
    left_out = {path.relative_to(PACKAGE).as_posix() for path in every - counted}
    assert left_out
    assert all(name.startswith(ONLY_SHOWING) for name in left_out)
    assert {"vehicles/catalogue", "backend/simd", "util"} <= {
        path.relative_to(PACKAGE).parent.as_posix() for path in counted
    }


def test_the_machine_is_described_without_its_name() -> None:
    described = machine.machine()
    assert set(described) == {"cpu", "llvm_cpu", "simd", "cores", "lanes", "system"}
    assert described["cores"] >= 1
    assert {"python", "numpy", "numba", "dq-marine"} <= set(machine.versions())


def test_a_program_that_is_not_there_says_nothing() -> None:
    assert machine.said("no-such-program-anywhere") == ""
    assert machine.said("git", "no-such-command") == ""
