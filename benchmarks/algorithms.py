"""Train tasks by several algorithms, and fly what each has learned through episodes that it has never seen.

Run: python benchmarks/algorithms.py [--preset NAME ...] [--algorithm NAME ...] [--episodes N] [--runs FOLDER]

Each run is that of `dq-marine train --preset NAME --algorithm NAME --run FOLDER/NAME-NAME`; one that is in the folder
already, and has ended, is not trained again. Writes the table of docs/howto/algorithms.md, between its words.
"""

from __future__ import annotations

from pathlib import Path

from suite import blocks, circumstances, trainings
from suite.tables import table

from dq_marine.util.files import write_whole

PAGE = circumstances.ROOT / "docs" / "howto" / "algorithms.md"
ALGORITHMS = ("ppo", "sac", "td3", "tqc", "crossq")
DEFAULT_PRESETS = ("WaypointTracking", "DepthHeading", "PathFollowing", "PathFollowing_otter")
"""A vehicle with many thrusters, a torpedo twice, and a surface vessel."""


def row(preset: str, algorithm: str, episodes: int, runs: Path) -> list[str]:
    """Return what an algorithm made of a task, as the cells of a row."""
    folder = runs / f"{preset}-{algorithm}"
    run = trainings.trained(["--preset", preset, "--algorithm", algorithm], folder)
    found = trainings.successes(folder, folder, episodes)
    cost = [f"{run['timesteps']:,}", *trainings.times_of(run)]
    return [preset, algorithm, *cost, f"{found} of {episodes}"]


def main() -> None:
    """Train, fly, and write the table into the page."""
    parser = trainings.options(__doc__, episodes=100)
    parser.add_argument("--algorithm", action="append", choices=ALGORITHMS)
    wanted = parser.parse_args()
    presets, algorithms = wanted.preset or DEFAULT_PRESETS, wanted.algorithm or ALGORITHMS
    rows = [row(preset, one, wanted.episodes, wanted.runs) for preset in presets for one in algorithms]
    header = ["preset", "algorithm", "timesteps", *trainings.TIMES, "success"]
    chosen = [f"--preset {one}" for one in presets] + [f"--algorithm {one}" for one in algorithms]
    command = f"benchmarks/algorithms.py {' '.join(chosen)} --episodes {wanted.episodes}"
    content = f"{blocks.provenance(command)}\n{table(header, rows)}\n"
    page = PAGE.read_text(encoding="utf-8")
    write_whole(PAGE, blocks.with_block(page, "benchmarks/algorithms.py", content))


if __name__ == "__main__":
    main()
