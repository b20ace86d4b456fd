"""The pages of the documentation that people write, and the code on them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
ELSEWHERE = {"architecture.md"}
"""Pages whose code another test runs: tests/cli/test_add.py writes what is on this one into files, and flies them."""

FRONT_MATTER = re.compile(r"\A---\nneeds: \[(.*)\]\n---\n")
BLOCK = re.compile(r"^```(.*?)\n(.*?)^```", re.MULTILINE | re.DOTALL)
SNIPPET = re.compile(r'--8<-- "(.+)"')


class Page(NamedTuple):
    """A page: its path below `docs`, the modules that its code needs, and its blocks as (language, text)."""

    name: str
    needs: tuple[str, ...]
    blocks: tuple[tuple[str, str], ...]
    text: str

    @property
    def program(self) -> str:
        """The blocks of Python in their order; those that show an example's file are `{.python}`."""
        return "\n".join(text for language, text in self.blocks if language == "python")

    @property
    def snippets(self) -> list[str]:
        """Files that the page shows."""
        return SNIPPET.findall(self.text)

    @property
    def commands(self) -> list[str]:
        """Lines of its blocks that call `dq-marine`, without what they say to the reader."""
        lines = [line.split("   #")[0].strip() for _, text in self.blocks for line in text.splitlines()]
        return [line for line in lines if line.startswith("dq-marine ")]


def page_at(path: Path) -> Page:
    """Read a page."""
    text = path.read_text(encoding="utf-8")
    matter = FRONT_MATTER.match(text)
    needs = tuple(name.strip() for name in matter[1].split(",")) if matter else ()
    return Page(str(path.relative_to(DOCS)), needs, tuple(BLOCK.findall(text)), text)


PAGES = [page_at(path) for path in sorted(DOCS.rglob("*.md"))]
WITH_CODE = [page for page in PAGES if page.program and page.name not in ELSEWHERE]
