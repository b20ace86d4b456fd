"""Broad sweeps: run in CI and with `--sweeps`, left out of a plain `make test`.

A sweep repeats a law over many vehicles, schemes or conditions, each of which must be compiled; the cases of it that
are no sweeps say in a plain run whether it holds. What takes long for a single case is a sweep as a whole, and CI's
alone. A law that holds for all inputs is tried on fewer of them in a plain run.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable

import pytest
from hypothesis import settings

REASON = "a sweep: runs in CI and with --sweeps"

EXAMPLES, EXAMPLES_IN_PLAIN_RUNS = 100, 20
"""How many inputs hypothesis draws for a law that does not say so itself."""


def sweep(cases: Iterable, *, plain: Collection) -> list:
    """Return the cases of a parametrisation in their order, all but the plain ones marked as a sweep.

    Args:
        cases: values, or tuples of them.
        plain: those among them that a plain run keeps.

    Raises:
        ValueError: one of `plain` is none of the cases, so that it would be kept nowhere.
    """
    cases = list(cases)
    missing = [case for case in plain if case not in cases]
    if missing or not plain:
        raise ValueError(f"plain = {plain!r} must be some of the cases {cases}")
    return [case if case in plain else _marked(case) for case in cases]


def _marked(case):
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.sweep)


def pytest_addoption(parser) -> None:
    """Declare `--sweeps`."""
    parser.addoption("--sweeps", action="store_true", help="run the broad sweeps too, as CI does")


def pytest_configure(config) -> None:
    """Draw fewer inputs in a plain run, and time no test: a busy machine would fail it."""
    examples = EXAMPLES if sweeps_wanted(config) else EXAMPLES_IN_PLAIN_RUNS
    settings.register_profile("untimed", parent=settings(), deadline=None, max_examples=examples)
    settings.load_profile("untimed")


def sweeps_wanted(config) -> bool:
    """Whether sweeps run: in CI, with `--sweeps`, and where `-m` names them."""
    return bool(os.environ.get("CI") or config.getoption("sweeps") or "sweep" in config.option.markexpr)


def pytest_collection_modifyitems(config, items) -> None:
    """Mark sweeps to be skipped unless they are wanted."""
    if not sweeps_wanted(config):
        for item in items:
            if item.get_closest_marker("sweep"):
                item.add_marker(pytest.mark.skip(reason=REASON))


def pytest_terminal_summary(terminalreporter) -> None:
    """Say how many sweeps were left out and how to run them, if any were."""
    skipped = terminalreporter.stats.get("skipped", ())
    count = sum(REASON in str(report.longrepr) for report in skipped)
    if count:
        terminalreporter.write_line(f"{count} sweeps were left out; `pytest --sweeps` runs them, as CI does")
