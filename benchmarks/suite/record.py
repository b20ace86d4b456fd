"""The measured numbers on disk: written whole after each section, so that an interrupted run can go on."""

from __future__ import annotations

import json
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from dq_marine.report import machine
from dq_marine.util.files import with_folder, write_whole
from suite import circumstances


class OtherMachineError(Exception):
    """A record holds figures of another machine or of other versions, which must not be mixed."""


class Record:
    """A JSON file of sections.

    Attributes:
        path: of the file.
        content: of the file: `machine`, `versions`, `sections` by name, each with `stamp` and `content`, and why
            others are `missing`, by name.
    """

    def __init__(self, path: Path) -> None:
        """Read the file, or begin an empty record."""
        self.path = path
        self.content: dict[str, Any] = {"machine": {}, "versions": {}, "sections": {}, "missing": {}}
        if path.exists():
            self.content = json.loads(path.read_text())

    @property
    def sections(self) -> dict[str, Any]:
        """The sections measured, by name."""
        return self.content["sections"]

    @property
    def missing(self) -> dict[str, str]:
        """Why sections could not be measured at the last try, by name."""
        return self.content["missing"]

    def begin(self, *, fresh: bool) -> None:
        """Make ready for figures of this machine and these versions.

        Raises:
            OtherMachineError: the record has figures of others, and is not to be begun afresh.
        """
        here, installed = machine.machine(), circumstances.versions()
        differing = differences(self.content["machine"], here) + differences(
            self.content["versions"], installed
        )
        if differing and self.sections:
            if not fresh:
                raise OtherMachineError(
                    f"{self.path} was measured elsewhere: {'; '.join(differing)}. Give --fresh to begin it anew, or "
                    "another --out"
                )
            self.sections.clear()
            self.content["versions"] = {}
        self.content["machine"] = here
        self.content["versions"] = installed | {
            name: number for name, number in self.content["versions"].items() if name not in installed
        }

    def holds(self, name: str, stamp: dict[str, Any]) -> bool:
        """Whether a section was measured with the same sources and settings."""
        kept = self.sections.get(name)
        same = ("sources", "quick", "threads")
        return kept is not None and all(kept["stamp"][key] == stamp[key] for key in same)

    def keep(self, name: str, stamp: dict[str, Any], content: dict[str, Any]) -> None:
        """Add a section and write the file."""
        self.sections[name] = {"stamp": stamp, "content": content}
        self.missing.pop(name, None)
        self._write()

    def miss(self, name: str, why: str) -> None:
        """Note why a section cannot be measured here, and write the file; what there was of it stays."""
        self.missing[name] = why
        self._write()

    def _write(self) -> None:
        write_whole(with_folder(self.path), as_json(self.content))


def stamp(sources: str, *, quick: bool, threads: tuple[int, ...]) -> dict[str, Any]:
    """Return what tells how and when a section is measured.

    Args:
        sources: hash over the sources as they were when the process began.
        quick: whether sizes are small.
        threads: numbers of threads to measure with.
    """
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": circumstances.commit(),
        "sources": sources,
        "quick": quick,
        "threads": list(threads),
        "load_before": machine.load(),
    }


def as_json(content: Any) -> str:
    """Return indented JSON, in which a list of plain values is one line."""
    text = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
    return re.sub(r"\[[^\[\]{}]*\]", lambda found: re.sub(r"\s*\n\s*", " ", found[0]), text)


def differences(then: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return in what two descriptions differ; what one of them lacks counts as equal."""
    return [
        f"{name} {then[name]}, now {now[name]}"
        for name in then
        if then[name] is not None and now.get(name) is not None and then[name] != now[name]
    ]
