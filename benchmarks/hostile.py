"""Try any number of seeded hostile cases on the public doors, in child processes with a time and a memory limit.

Run: python benchmarks/hostile.py [--cases N] [--first SEED] [--processes N] [--out FILE]

A case is drawn from its seed: a door, and arguments of which some are wrong (see tests/hostile). It ends accepted,
refused with one of our errors, or else badly: with another exception (raw), not within a minute nor, tried again by
itself, within ten (hung), without a word or with a changed state after a refusal, or with steps that are not finite or
not repeatable after an acceptance (wrong), or with the death of its process (died).
`python benchmarks/hostile.py --case SEED` tries one and says what happened. The exit status is 1 if any case ended
badly.
"""

from __future__ import annotations

import argparse
import json
import queue
import resource
import subprocess
import sys
import threading
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import Progress, TextColumn, TimeRemainingColumn
from suite import circumstances
from suite.tables import table

from dq_marine.backend.workers import usable_cores
from dq_marine.report.machine import machine
from dq_marine.report.presentation import three_digits
from dq_marine.util.files import with_folder, write_whole

TESTS = circumstances.ROOT / "tests"
PAGE = circumstances.ROOT / "docs" / "hostile.md"
GOOD = ("refused", "accepted")
BAD = ("raw", "wrong", "hung", "died")

CHUNK = 500
"""Cases that a child process tries before the next one takes over."""

LONGEST = 60.0
"""Seconds within which a case has to end; a scene that was never compiled before takes up to twenty of them."""

PATIENCE = 600.0
"""Seconds that a case which was late has in a process of its own: a busy machine does not make it hang."""

MEMORY = 8 * 2**30
"""Bytes of address space that a child may ask for."""


@dataclass
class Tally:
    """What came of the cases.

    Attributes:
        outcomes: how many there are, by door and outcome.
        failures: seed, door, outcome and detail of those that ended badly.
    """

    outcomes: dict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    failures: list[dict[str, Any]] = field(default_factory=list)

    def add(self, verdict: dict[str, Any]) -> None:
        """Count a case."""
        self.outcomes[verdict["door"]][verdict["outcome"]] += 1
        if verdict["outcome"] in BAD:
            self.failures.append(verdict)

    @property
    def totals(self) -> Counter[str]:
        """Cases by outcome."""
        return sum(self.outcomes.values(), Counter())


def main() -> int:
    """Try what is asked for; return the exit status."""
    wanted = arguments()
    if wanted.worker is not None:
        return work(*wanted.worker)
    if wanted.case is not None:
        Console().print_json(json.dumps(next(tried(wanted.case, 1))))
        return 0
    tally = campaign(wanted.first, wanted.cases, wanted.processes)
    write_whole(with_folder(wanted.out), page(tally, wanted))
    totals = tally.totals
    Console().print(f"{', '.join(f'{totals[name]:,} {name}' for name in GOOD + BAD)}. Written: {wanted.out}")
    return 1 if tally.failures else 0


def arguments() -> argparse.Namespace:
    """Return what the command line says."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", type=int, default=10_000, help="how many")
    parser.add_argument("--first", type=int, default=0, metavar="SEED", help="seed of the first")
    parser.add_argument("--processes", type=int, default=usable_cores(), help="at a time")
    parser.add_argument("--out", type=Path, default=PAGE, metavar="FILE", help="where the page is written")
    parser.add_argument("--case", type=int, metavar="SEED", help="try one case and say what happened")
    parser.add_argument("--worker", type=int, nargs=2, metavar=("FIRST", "COUNT"), help=argparse.SUPPRESS)
    return parser.parse_args()


def campaign(first: int, count: int, processes: int) -> Tally:
    """Try cases in child processes, and count how they end."""
    tally, chunks, verdicts = Tally(), queue.SimpleQueue(), queue.SimpleQueue()
    for start in range(first, first + count, CHUNK):
        chunks.put((start, min(CHUNK, first + count - start)))
    threads = [
        threading.Thread(target=supervise, args=(chunks, verdicts), daemon=True) for _ in range(processes)
    ]
    for thread in threads:
        thread.start()
    columns = (
        *Progress.get_default_columns()[:3],
        TextColumn("{task.fields[bad]} ended badly"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        task = progress.add_task("hostile cases", total=count, bad=0)
        for _ in range(count):
            tally.add(verdicts.get())
            progress.update(task, advance=1, bad=len(tally.failures))
    return tally


def supervise(
    chunks: queue.SimpleQueue[tuple[int, int]], verdicts: queue.SimpleQueue[dict[str, Any]]
) -> None:
    """Let children try chunks of cases; one that hangs or dies is followed by another, from the next case on."""
    while True:
        try:
            first, count = chunks.get_nowait()
        except queue.Empty:
            return
        last = first + count
        while first < last:
            for verdict in from_child(first, last - first, LONGEST):
                verdicts.put(again(first) if verdict["outcome"] == "hung" else verdict)
                first += 1


def again(seed: int) -> dict[str, Any]:
    """Return the verdict on a case that was late, tried by itself and with patience."""
    return next(from_child(seed, 1, PATIENCE))


def from_child(first: int, count: int, longest: float) -> Iterator[dict[str, Any]]:
    """Yield the verdicts of a child process, the last of which may be that it hung or died."""
    command = [sys.executable, __file__, "--worker", str(first), str(count)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        assert child.stdout is not None
        for line in child.stdout:
            lines.put(line)
        lines.put("")

    threading.Thread(target=read, daemon=True).start()
    seed, last = first, first + count
    try:
        while seed < last:
            try:
                line = lines.get(timeout=longest)
            except queue.Empty:
                line, ended = "", "hung"
            else:
                ended = "died"
            if not line:
                yield {"seed": seed, "door": "?", "outcome": ended, "detail": ""}
                return
            if line.startswith("{"):
                yield json.loads(line)
                seed += 1
    finally:
        child.kill()
        child.wait()


def work(first: int, count: int) -> int:
    """Try cases in this process, and print a line of JSON for each."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for verdict in tried(first, count):
        print(json.dumps(verdict), flush=True)
    return 0


def tried(first: int, count: int) -> Iterator[dict[str, Any]]:
    """Yield the verdicts of cases."""
    sys.path.insert(0, str(TESTS))
    from hostile.cases import judged

    for seed in range(first, first + count):
        yield {"seed": seed, **judged(seed)._asdict()}


HEAD = """\
# Hostile cases

{command}: seeds {first:,} to {last:,}, {accepted} % accepted.

Measured on {machine}.

A case gives a public door arguments of which some are wrong: other types, NaN, infinities, numbers beyond any double,
wrong shapes, objects whose conversions fail, damaged files. It should end *refused*, with an error of ours after which
the state has the same bits, or *accepted*, after which ten steps are finite and repeatable. *Raw* is another exception,
*wrong* a broken promise, *hung* longer than a minute and, tried again by itself, than ten, *died* the end of a process.
"""


def page(tally: Tally, wanted: argparse.Namespace) -> str:
    """Return the page."""
    totals = tally.totals
    head = HEAD.format(
        command=f"`python benchmarks/hostile.py --cases {wanted.cases} --first {wanted.first}`",
        first=wanted.first,
        last=wanted.first + wanted.cases - 1,
        accepted=three_digits(100.0 * totals["accepted"] / max(1, totals.total())),
        machine=where(),
    )
    lines = [("**all**", totals), *sorted(tally.outcomes.items())]
    rows = [
        [door, *(f"{n:,}" for n in (counts.total(), *(counts[name] for name in GOOD + BAD)))]
        for door, counts in lines
    ]
    parts = [head, table(["door", "cases", *GOOD, *BAD], rows)]
    if not tally.failures:
        return "\n".join([*parts, "", "None ended badly.", ""])
    bad = [
        f"- {one['seed']}, {one['door']}: {one['outcome']}: `{one['detail'][:300]}`" for one in tally.failures
    ]
    return "\n".join([*parts, "", "## What ended badly", "", *bad, ""])


def where() -> str:
    """Return the machine, the versions and the commit."""
    here = machine()
    installed = ", ".join(f"{name} {number}" for name, number in circumstances.versions().items() if number)
    return f"{here['cpu']}, {here['cores']} cores, {here['system']}, {installed}, commit {circumstances.commit()}"


if __name__ == "__main__":
    sys.exit(main())
