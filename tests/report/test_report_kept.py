"""What was kept is good under its own stamp alone."""

from __future__ import annotations

from pathlib import Path

from dq_marine.report.kept import Kept


def test_numbers_come_back_bit_for_bit_under_the_same_stamp(tmp_path: Path) -> None:
    path, stamp = tmp_path / "new" / "kept.json", {"seed": 1, "pair": (1, 2)}
    content = {"state": [0.1, 1e-300, 1.0 / 3.0]}
    assert Kept(path, stamp).read() is None
    Kept(path, stamp).write(content)
    assert Kept(path, stamp).read() == content
    assert Kept(path, {"seed": 2, "pair": (1, 2)}).read() is None


def test_what_is_damaged_or_removed_is_not_there(tmp_path: Path) -> None:
    kept = Kept(tmp_path / "kept.json", "stamp")
    kept.write([1])
    for damage in ("[1, 2]", '{"stamp": "stamp"', "{}"):
        (tmp_path / "kept.json").write_text(damage)
        assert kept.read() is None
    kept.write([1])
    kept.remove()
    kept.remove()
    assert kept.read() is None
