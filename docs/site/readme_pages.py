"""Pages made of README's sections, so that what README says stands in one place."""

from __future__ import annotations

import re
from typing import NamedTuple


class ReadmePage(NamedTuple):
    """A page's title, and the headings of the sections of README that it consists of."""

    title: str
    sections: tuple[str, ...]


PAGES = {
    "settings.md": ReadmePage("Settings and scenarios", ("Settings", "Scenarios")),
    "vehicles.md": ReadmePage(
        "Vehicles and manoeuvres",
        ("Vehicles", "A different vehicle in every episode", "A vehicle from a mesh", "Manoeuvres"),
    ),
    "simulator.md": ReadmePage(
        "Without Gymnasium, and thousands at once", ("The simulator alone", "Thousands at once")
    ),
}

HEADING = re.compile(r"^(#+) (.+)$", re.MULTILINE)
CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\((?!https?:|#)([^)]+)\)")


def page_of_sections(readme: str, page: ReadmePage) -> str:
    """Return a page of sections of README, with links that hold where the page stands."""
    parts = [f"# {page.title}", *(_section(readme, heading) for heading in page.sections)]
    text = "\n\n".join(parts) + "\n"
    return LINK.sub(_link, text.replace("](docs/images/", "](images/"))


def _section(readme: str, heading: str) -> str:
    """Return a section with its subsections, under a heading of the second level.

    Raises:
        ValueError: README has no section of this name, or several.
    """
    prose = CODE.sub(lambda code: code[0].replace("#", " "), readme)  # comments in code are no headings
    found = [match for match in HEADING.finditer(prose) if match[2] == heading]
    if len(found) != 1:
        raise ValueError(f"README has {len(found)} sections {heading!r}, where the site needs one")
    ends = (one.start() for one in HEADING.finditer(prose, found[0].end()) if len(one[1]) <= len(found[0][1]))
    return f"## {heading}{readme[found[0].end() : next(ends, len(readme))]}".rstrip()


def _link(match: re.Match[str]) -> str:
    """Return a link to a page of the site, or what it says and the path where it leads elsewhere in the repository."""
    said, target = match[1], match[2]
    if target.startswith("docs/"):
        inside = target.removeprefix("docs/")
        return f"[{said}]({inside if '.' in inside else inside + '/README.md'})"
    path = f"`{target}`"
    return path if target in said or said.strip("`") in target.rsplit("/", 1)[-1] else f"{said} ({path})"
