"""Who cannot record is told so before anything is flown; what is recorded is tested with Minari, in tests/interop."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.command_line import assert_refused, run

from dq_marine.agents.datasets.dataset_folder import StepData
from dq_marine.agents.interactive.recording import BY_PERSON, PUSHED, Recorder, noted
from dq_marine.errors import InvalidInputError, MissingDependencyError


@pytest.mark.parametrize("missing", ["minari", "h5py", "jax"])
def test_what_is_missing_is_named_with_its_extra(
    missing: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("minari", "h5py", "jax"):
        monkeypatch.setitem(sys.modules, name, None if name == missing else SimpleNamespace())
    with pytest.raises(MissingDependencyError, match=rf"needs '{missing}'.*dq-marine\[interop\]"):
        Recorder(tmp_path / "flights")
    assert not (tmp_path / "flights").exists()


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("minari", "h5py", "jax"):
        monkeypatch.setitem(sys.modules, name, SimpleNamespace())
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidInputError, match="cannot be written"):
        Recorder(tmp_path / "file")


def test_a_flight_without_a_panel_has_nothing_to_record(tmp_path: Path) -> None:
    assert_refused(run("fly", "--record", tmp_path / "flights"), "add --teleop or --panel")


def test_a_step_is_kept_as_it_was_held_with_who_gave_it_and_whether_it_was_pushed() -> None:
    at_helm = pushed = True
    step: Any = StepData(noted(lambda: at_helm, lambda: pushed))
    begun = step(None, obs=np.zeros(2), info={"a": 1.0})
    assert begun["action"] is None
    assert begun["info"] == {"a": 1.0, BY_PERSON: True, PUSHED: False}
    at_helm = False
    held = step(None, np.ones(2), {}, np.array([0.5, 1.5], np.float32), 1.0, False, True)
    np.testing.assert_array_equal(held["action"], np.array([0.5, 1.0], np.float32))
    assert held["action"].dtype == np.float32
    assert (held["reward"], held["terminated"], held["truncated"]) == (1.0, False, True)
    assert held["info"] == {BY_PERSON: False, PUSHED: True}
