"""Measure everything that the documentation says about speed, memory and endurance, and write it down.

Run: python benchmarks/performance.py [--quick] [--only SECTION ...] [--fresh] [--out DIR] [--threads N]

Two files are written, `performance.json` with every sample and `performance.md` with the tables: into `docs`, or with
--quick into `build/benchmarks`, so that a trial does not replace figures. Both are written whole after each section. If
the run is stopped, the same command goes on with the section that it was in; a section that was measured with the same
sources, threads and sizes is kept. All takes about fifteen minutes on two cores, a quick trial about three, more
where nothing is compiled yet. Let the machine do nothing else meanwhile.

MuJoCo (pip install 'mujoco>=4') and Stable-Baselines3 (pip install "dq-marine[agents]") are needed by one section each,
which is left out without them.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from rich.console import Console
from suite import circumstances
from suite.page import page
from suite.plan import NotInstalledError, Plan, Section
from suite.record import OtherMachineError, Record, stamp
from suite.sections import SECTIONS

from dq_marine.backend.workers import MOST_THREADS, usable_cores
from dq_marine.report.screen import Screen
from dq_marine.util.files import with_folder, write_whole

DOCS = circumstances.ROOT / "docs"
TRIALS = circumstances.ROOT / "build" / "benchmarks"
UNFINISHED = TRIALS / "unfinished"
"""Where a long section keeps how far it is."""

INTERRUPTED = 130
"""Exit status of a process that was stopped by Ctrl-C."""


def main() -> int:
    """Measure what is asked for and not there yet; return the exit status."""
    wanted = arguments()
    folder = wanted.out or (TRIALS if wanted.quick else DOCS)
    run = Run(Record(folder / "performance.json"), wanted.quick, tuple(sorted({1, wanted.threads})))
    screen = run.screen
    try:
        run.begin(fresh=wanted.fresh)
        for name in wanted.only or SECTIONS:
            run.measure(SECTIONS[name], fresh=wanted.fresh)
    except OtherMachineError as error:
        screen.say(f"Error: {error}", "bold red")
        return 1
    except KeyboardInterrupt:
        screen.say("Stopped. What was measured is kept; the same command, without --fresh, goes on.")
        return INTERRUPTED
    screen.say(f"Written: {run.write_page()} and {run.record.path}")
    return 0


class Run:
    """One run of the command.

    Attributes:
        record: of what is measured.
        screen: to tell progress on.
    """

    def __init__(self, record: Record, quick: bool, threads: tuple[int, ...]) -> None:
        self.record = record
        self.screen = Screen(Console())
        self._quick = quick
        self._threads = threads
        self._sources = circumstances.source_fingerprint()

    def begin(self, *, fresh: bool) -> None:
        """Make ready, and if afresh, forget what was not finished."""
        self.record.begin(fresh=fresh)
        if fresh:
            for path in UNFINISHED.glob("*.json"):
                path.unlink()

    def measure(self, section: Section, *, fresh: bool) -> None:
        """Measure a section and write both files, unless it is there already."""
        measured = stamp(self._sources, quick=self._quick, threads=self._threads)
        if self.record.holds(section.name, measured) and not fresh:
            date = self.record.sections[section.name]["stamp"]["date"]
            self.screen.say(f"{section.name}: kept, measured {date}")
            return
        plan = Plan(self._quick, self._threads, UNFINISHED, self.screen.tell, self.screen.progress)
        start = time.monotonic()
        try:
            with self.screen.section(section.name):
                content = section.measure(plan)
        except NotInstalledError as error:
            self.record.miss(section.name, str(error))
            self.screen.say(f"{section.name}: left out. {error}", "yellow")
        else:
            self.record.keep(section.name, measured, content)
            taken = time.monotonic() - start
            self.screen.say(f"{section.name}, {taken:.0f} s: {section.headline(content)}")
        self.write_page()

    def write_page(self) -> Path:
        """Write the page of all that is recorded; return its path."""
        path = self.record.path.with_suffix(".md")
        write_whole(with_folder(path), page(self.record, SECTIONS))
        return path


def arguments() -> argparse.Namespace:
    """Return what the command line says."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=listed_sections(), formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="small sizes and few samples: does it work?")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=SECTIONS,
        metavar="SECTION",
        help="of those below; the others stay as they are",
    )
    parser.add_argument(
        "--fresh",
        action="store_true",
        help="measure again what is there, and replace figures of another machine or of other versions",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of both files instead of the usual")
    parser.add_argument(
        "--threads",
        type=a_number_of_threads,
        default=usable_cores(),
        metavar="N",
        help="measure with 1 and with N; by default as many as there are cores, %(default)s here",
    )
    return parser.parse_args()


def listed_sections() -> str:
    """Return the names of the sections and what they are about."""
    lines = [f"  {name:18}{section.title}" for name, section in SECTIONS.items()]
    examples = [
        "  python benchmarks/performance.py --quick",
        "  python benchmarks/performance.py --only mujoco ppo",
    ]
    return "\n".join(["sections:", *lines, "", "examples:", *examples])


def a_number_of_threads(text: str) -> int:
    """Return a number of threads.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    if not text.isdecimal() or not 1 <= int(text) <= MOST_THREADS:
        raise argparse.ArgumentTypeError(f"{text!r}; give a whole number from 1 to {MOST_THREADS}")
    return int(text)


if __name__ == "__main__":
    sys.exit(main())
