"""Profiles of browsers: those of the living are left alone, from the first moment on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from dq_marine.util import locks
from dq_marine.util.locks import is_free
from dq_marine.viewer.transport.browser import OWNER_FILE, new_profile, remove_abandoned_profiles


@pytest.mark.skipif(locks.fcntl is None, reason="this system has no locks on files")
def test_another_process_that_looks_meanwhile_takes_no_new_profile_away(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    take = locks.fcntl.flock

    def take_after_another_has_looked(*arguments: Any) -> None:
        monkeypatch.setattr(locks.fcntl, "flock", take)
        remove_abandoned_profiles()
        take(*arguments)

    monkeypatch.setattr(locks.fcntl, "flock", take_after_another_has_looked)
    profile, lock = new_profile()
    assert [path.name for path in profile.iterdir()] == [OWNER_FILE]
    assert not is_free(profile / OWNER_FILE)
    remove_abandoned_profiles()
    assert profile.is_dir()
    lock.release()
    remove_abandoned_profiles()
    assert not profile.exists()
