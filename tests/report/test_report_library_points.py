"""Libraries' points: errors, times, failures as failures, and nothing printed or left behind."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.timings import without_timings

from dq_marine.report.cases import CASES
from dq_marine.report.libraries import LIBRARIES
from dq_marine.report.library_points import available, library_rows, settings_of


def test_tolerances_and_steps_go_from_coarse_to_fine() -> None:
    case = CASES["torque_free_top"]
    for library in available(case):
        settings = settings_of(library, case, (20, 40), quick=False)
        assert settings == sorted(settings, reverse=True)
        assert len(settings) > 1


@pytest.mark.sweep
def test_errors_fall_with_the_tolerance_and_are_the_same_again() -> None:
    case, library = CASES["munk_spheroid"], LIBRARIES["scipy_dop853"]
    first, second = (library_rows(case, library, [1e-4, 1e-8], 1, 10_000) for _ in range(2))
    assert without_timings(first) == without_timings(second)
    assert first[0]["attitude"] > 10.0 * first[1]["attitude"]
    assert first[0]["best_ns"] > 0.0


def test_no_finer_setting_is_tried_once_a_run_was_long() -> None:
    case, library = CASES["munk_spheroid"], LIBRARIES["scipy_dop853"]
    assert len(library_rows(case, library, [1e-4, 1e-8], 1, 10)) == 1


def test_mujoco_blows_up_without_a_word(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Its warnings would end up on the terminal and in a log file in the working folder."""
    pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    case = CASES["torque_free_top"]
    rows = library_rows(case, LIBRARIES["mujoco_euler"], [1.5], 1, 10_000)
    assert rows[0]["outcome"] == "blew up" or rows[0]["position"] > 1e3
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []
