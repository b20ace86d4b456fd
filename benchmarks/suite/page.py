"""The page: a record in Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from suite.plan import LEAST, Section
from suite.record import Record
from suite.tables import table

COMMAND = "python benchmarks/performance.py"

HEAD = f"""\
# Performance

Please do not edit this page: `{COMMAND}` writes it. The command can be stopped, and goes on
where it was; every sample is in `{{json}}`.

Unless a section says otherwise, processes are warm and everything is compiled. Cases that are compared are measured in
turn (A B C A B C ...), so that a change of the machine's speed affects all alike. A sample takes
{LEAST * 1e3:.0f} ms or more, with the garbage collector off. The best sample is shown, and how far the medians were
from it. *Load* is the average number of processes that wanted a core in the minute before a section began; after the
first section of a run that was this benchmark itself.
"""

QUICK = "**A quick run with small sizes and few samples: it shows that the benchmark works, but does not measure.**\n"


def page(record: Record, sections: Mapping[str, Section]) -> str:
    """Return the page of what was measured, and of why the rest was not."""
    parts = [HEAD.format(json=record.path.name), summary(record, sections), machine_table(record.content)]
    parts += [part(record, section) for section in sections.values()]
    return "\n".join(parts)


def summary(record: Record, sections: Mapping[str, Section]) -> str:
    """Return a line for each section that was measured."""
    lines = [
        f"- {section.title}: {section.headline(record.sections[name]['content'])}"
        for name, section in sections.items()
        if name in record.sections
    ]
    return "## In short\n\n" + "\n".join(lines) + "\n"


def machine_table(content: dict[str, Any]) -> str:
    """Return what computed, and with which versions."""
    machine, versions = content["machine"], content["versions"]
    lanes = ", ".join(f"{width} in {precision}" for precision, width in machine["lanes"].items())
    installed = ", ".join(f"{name} {number or 'not installed'}" for name, number in versions.items())
    lines = [
        ["processor", f"{machine['cpu']} ({machine['llvm_cpu']} to LLVM)"],
        ["vector registers", machine["simd"]],
        ["bodies in a block of lanes", lanes],
        ["cores that may be used", str(machine["cores"])],
        ["system", machine["system"]],
        ["versions", installed],
    ]
    return "## Machine\n\n" + table(["", ""], lines)


def part(record: Record, section: Section) -> str:
    """Return a section of the page."""
    title = f"## {section.title}\n"
    kept = record.sections.get(section.name)
    if kept is None:
        why = record.missing.get(section.name, f"`{COMMAND} --only {section.name}` does it.")
        return f"{title}\nNot measured yet: {why}\n"
    stamp = kept["stamp"]
    lines = [title, section.method, stamp_line(section.name, stamp)]
    return "\n".join([*lines, *([QUICK] if stamp["quick"] else []), section.tables(kept["content"])])


def stamp_line(name: str, stamp: dict[str, Any]) -> str:
    """Return how and when a section was measured."""
    threads = " and ".join(str(count) for count in stamp["threads"])
    return (
        f"`{COMMAND} --only {name}`, {stamp['date']},\n"
        f"commit {stamp['commit']}, threads {threads}, load {stamp['load_before']}.\n"
    )
