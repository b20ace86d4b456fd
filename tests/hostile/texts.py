"""Texts and files gone wrong in a few places."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from hostile.values import Rng

NUMBERS = (
    "1e308",
    "-1e200",
    "nan",
    "inf",
    "-1",
    "1e-200",
    "0",
    "",
    "x",
    "1j",
    "9" * 400,
    "0x10",
    "\u0661",
    '"',
    "1;2",
)
"""What may stand in a table where a number should."""


def changed_table(rng: Rng, text: str) -> str:
    """A table of lines with commas, with a line or a field of it changed."""
    lines = text.splitlines() or [""]
    line, other = (int(rng.integers(len(lines))) for _ in range(2))
    fields = lines[line].split(",")
    field = int(rng.integers(len(fields)))
    kind = rng.integers(9)
    if kind == 0:
        del lines[line]
    elif kind == 1:
        lines.insert(line, lines[other])
    elif kind in (2, 3):
        fields[field] = NUMBERS[rng.integers(len(NUMBERS))]
        lines[line] = ",".join(fields)
    elif kind == 4:
        del fields[field]
        lines[line] = ",".join(fields)
    elif kind == 5:
        fields.insert(field, "x" * int(10.0 ** rng.uniform(0.0, 6.0)))
        lines[line] = ",".join(fields)
    elif kind == 6:
        place = int(rng.integers(len(lines[line]) + 1))
        lines[line] = lines[line][:place] + chr(rng.integers(0, 0x2FF)) + lines[line][place:]
    elif kind == 7:
        lines = lines[: line + 1]
    else:
        lines[line] = lines[line].replace("e", "").replace(".", "e")
    return "\n".join(lines)


def changed_text(rng: Rng, text: str) -> str:
    """A TOML file with a line of it changed."""
    lines = text.splitlines()
    line, other = (int(rng.integers(len(lines))) for _ in range(2))
    kind = rng.integers(9)
    if kind == 0:
        del lines[line]
    elif kind == 1:
        lines.insert(line, lines[other])
    elif kind == 2:
        lines[line] = "".join(rng.permutation(list(lines[line])))
    elif kind == 3:
        replaced = (
            "1e308",
            "-1e200",
            "nan",
            "inf",
            "1e-200",
            "true",
            '"text"',
            "[]",
            "{}",
            "1979-05-27",
            "0",
            "9" * 400,
        )
        name = lines[line].split("=")[0]
        lines[line] = f"{name}= {replaced[rng.integers(len(replaced))]}"
    elif kind == 4:
        lines[line] = f"deep = {'[' * 2000}{']' * 2000}"
    elif kind == 5:
        place = int(rng.integers(len(lines[line]) + 1))
        lines[line] = lines[line][:place] + chr(rng.integers(1, 0x2FF)) + lines[line][place:]
    elif kind == 6:
        lines = lines[: line + 1]
    elif kind == 7:
        lines[line] = lines[line].replace("0", "00").replace("1", "-1")
    else:
        lines[line] = lines[line].replace(".", "e")
    return "\n".join(lines) or "x"


def changed_bytes(rng: Rng, content: bytes) -> bytes:
    """Bytes of which some are changed, cut off, put twice or added."""
    place = int(rng.integers(len(content) + 1))
    kind = rng.integers(5)
    if kind == 0:
        return content[:place]
    if kind == 1:
        return content[:place] + rng.bytes(int(rng.integers(1, 20))) + content[place:]
    if kind == 2:
        return content[:place] + rng.bytes(1) + content[place + 1 :]
    if kind == 3:
        return content + content[place:]
    return b""


def spoil_entry(rng: Rng, path: Path) -> None:
    """Make something else of a file or folder: other content, nothing, a folder, a pipe, a link that leads nowhere."""
    kind = rng.integers(9)
    if kind <= 2 and path.is_file():
        path.write_bytes(changed_bytes(rng, path.read_bytes()))
        return
    if kind == 3 and not path.with_name("other").exists():
        path.rename(path.with_name("other"))
        return
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    if kind == 4:
        path.mkdir()
    elif kind == 5:
        os.mkfifo(path)
    elif kind == 6:
        path.symlink_to(path)
    elif kind == 7:
        path.write_bytes(rng.bytes(100))
