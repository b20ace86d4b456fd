"""Files are there whole or not at all, and numbers come back bit for bit."""

from __future__ import annotations

import csv
import json
import os
import stat
from pathlib import Path

import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import new_folder, replacing_file, with_folder, write_csv, write_json, write_whole


def test_numbers_come_back_bit_for_bit(tmp_path: Path) -> None:
    numbers = [0.1, 1e-300, 2.0**-1074, 1.0 / 3.0]
    write_json(with_folder(tmp_path / "new" / "numbers.json"), numbers)
    assert json.loads((tmp_path / "new" / "numbers.json").read_text()) == numbers


def test_rows_with_different_entries_share_a_file(tmp_path: Path) -> None:
    write_csv(tmp_path / "rows.csv", [{"a": 1, "b": 0.1}, {"a": 2, "c": "x, y"}])
    with (tmp_path / "rows.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert rows == [{"a": "1", "b": "0.1", "c": ""}, {"a": "2", "b": "", "c": "x, y"}]


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "page.html"
    write_whole(target, "old")

    def full_disk(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full_disk)
        with pytest.raises(InvalidInputError, match=r"page\.html cannot be written: No space left"):
            write_whole(target, "new")
    assert target.read_text() == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["page.html"]


def test_what_is_written_can_be_read_by_others(tmp_path: Path) -> None:
    write_whole(tmp_path / "page.html", b"bytes")
    assert stat.S_IMODE((tmp_path / "page.html").stat().st_mode) == 0o644


def test_a_folder_that_is_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidInputError, match="give a folder"):
        with_folder(tmp_path / "file" / "page.html")


def test_a_device_or_pipe_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InvalidInputError, match=r"pipe is a device or a pipe; give the name of a file"):
        write_whole(tmp_path / "pipe", "text")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)
    assert [one.name for one in tmp_path.iterdir()] == ["pipe"]


def test_a_missing_folder_is_not_made_unasked(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"cannot be written: No such file.*existing folder"):
        write_json(tmp_path / "no" / "scores.json", {})
    assert not list(tmp_path.iterdir())


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "scores.json"
    write_json(path, {"a": 1})

    def fail() -> None:
        with replacing_file(path) as temporary:
            temporary.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert path.read_text() == '{\n  "a": 1\n}\n'
    assert [one.name for one in tmp_path.iterdir()] == ["scores.json"]


def test_a_folder_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    def fail() -> None:
        with new_folder(tmp_path / "best" / "1") as folder:
            (folder / "model").write_text("half")
            raise OSError("disk full")

    with pytest.raises(InvalidInputError, match="cannot be written: disk full"):
        fail()
    assert not list((tmp_path / "best").iterdir())
    with new_folder(tmp_path / "best" / "1") as folder:
        (folder / "model").write_text("whole")
    assert (tmp_path / "best" / "1" / "model").read_text() == "whole"
    assert [one.name for one in (tmp_path / "best").iterdir()] == ["1"]
