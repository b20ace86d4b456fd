"""What is measured again when sources change, and what a page says of where it was made."""

from __future__ import annotations

from dq_marine.report import machine


def names() -> set[str]:
    return {path.relative_to(machine.PACKAGE).as_posix() for path in machine.measuring_sources()}


def test_what_decides_the_numbers_counts_and_what_shows_them_does_not() -> None:
    found = names()
    for name in (
        "kernel/drift.py",
        "engines/one_body.py",
        "rivals/rk4_quaternion.py",
        "vehicles/bluerov2_heavy.toml",
        "envs/station_keeping.py",
        "report/cases.py",
        "report/work_precision.py",
        "report/trial.py",
    ):
        assert name in found, name
    for name in ("cli.py", "report/page_html.py", "report/work_precision_view.py", "report/style.py"):
        assert name not in found, name
    assert not any(name.startswith(("agents/", "viewer/")) for name in found)


def test_every_module_that_only_shows_is_there() -> None:
    modules = {path.stem for path in (machine.PACKAGE / "report").glob("*.py")}
    assert set(machine.SHOWING) <= modules


def test_the_machine_is_described_without_its_name() -> None:
    described = machine.machine()
    assert set(described) == {"cpu", "cores", "system"}
    assert described["cores"] >= 1
    assert {"python", "numpy", "numba", "dq-marine"} <= set(machine.versions())


def test_a_program_that_is_not_there_says_nothing() -> None:
    assert machine.said("no-such-program-anywhere") == ""
    assert machine.said("git", "no-such-command") == ""
