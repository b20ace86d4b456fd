"""What is measured, written between the words of a page that say by which program."""

from __future__ import annotations

from dq_marine.backend.workers import usable_cores
from dq_marine.report.machine import cpu_model, load
from suite import circumstances

BEGIN, END = "<!-- {} -->\n", "<!-- end -->\n"


def with_block(page: str, program: str, content: str) -> str:
    """Return a page with other content in the block that names a program."""
    before, rest = page.split(BEGIN.format(program))
    return f"{before}{BEGIN.format(program)}\n{content}{END}{rest.split(END, 1)[1]}"


def provenance(command: str) -> str:
    """Return a command, this machine and the versions, as two paragraphs."""
    installed = ", ".join(f"{name} {version}" for name, version in circumstances.versions().items())
    machine = f"{cpu_model()}, {usable_cores()} processors, load at the end {load()}"
    return f"`python {command}`\n\n{machine}; {installed}.\n"
