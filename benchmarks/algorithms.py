"""Train tasks by several algorithms, and fly what each has learned through episodes that it has never seen.

Run: python benchmarks/algorithms.py [--preset NAME ...] [--algorithm NAME ...] [--also PRESET ...] [--timesteps N]
                                     [--episodes N] [--runs FOLDER]

Each run is that of `dq-marine train --preset NAME --algorithm NAME --run FOLDER/NAME-NAME`, with `--timesteps N` in
FOLDER/NAME-NAME-N; one that is in the folder already, and has ended, is not trained again. Writes the table of
docs/howto/algorithms.md, between its words. The best model is the one of the best evaluation while it was trained;
where that came after 0 timesteps, it is the copy.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from suite import blocks, circumstances, trainings
from suite.tables import table

from dq_marine.agents.policy_names import shipped_policies
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.util.files import write_whole

PAGE = circumstances.ROOT / "docs" / "howto" / "algorithms.md"
FROM_MEMORY = ("sac", "td3", "tqc", "crossq")
ALGORITHMS = ("ppo", *FROM_MEMORY)
DEFAULT_PRESETS = ("WaypointTracking", "DepthHeading", "PathFollowing", "PathFollowing_otter")
"""A vehicle with many thrusters, a torpedo twice, and a surface vessel."""

HEADER = ["preset", "algorithm", "timesteps", *trainings.TIMES, "best after", "success"]


def row(preset: str, algorithm: str, wanted: argparse.Namespace) -> list[str]:
    """Return what an algorithm made of a task, as the cells of a row."""
    asked, name = ["--preset", preset, "--algorithm", algorithm], f"{preset}-{algorithm}"
    if wanted.timesteps and algorithm in FROM_MEMORY:
        asked, name = [*asked, "--timesteps", str(wanted.timesteps)], f"{name}-{wanted.timesteps}"
    folder = wanted.runs / name
    run = trainings.trained(asked, folder)
    found = trainings.successes(folder, folder, wanted.episodes)
    best = RunFolder(folder).progress("best").timesteps
    cost = [f"{run['timesteps']:,}", *trainings.times_of(run)]
    return [preset, algorithm, *cost, f"{best:,}", f"{found} of {wanted.episodes}"]


def main() -> None:
    """Train, fly, and write the table into the page."""
    parser = trainings.options(__doc__, episodes=100)
    parser.add_argument("--algorithm", action="append", choices=ALGORITHMS)
    parser.add_argument(
        "--also", action="append", default=[], choices=list(shipped_policies()), help="by SAC alone"
    )
    parser.add_argument("--timesteps", type=int, help="of algorithms that learn from a memory")
    wanted = parser.parse_args()
    presets, algorithms = wanted.preset or DEFAULT_PRESETS, wanted.algorithm or ALGORITHMS
    pairs = [(preset, one) for preset in presets for one in algorithms]
    pairs += [(preset, "sac") for preset in wanted.also]
    rows = [row(preset, one, wanted) for preset, one in pairs]
    command = f"benchmarks/algorithms.py {' '.join(_said(wanted, presets, algorithms))}"
    content = f"{blocks.provenance(command)}\n{table(HEADER, rows)}\n"
    page = PAGE.read_text(encoding="utf-8")
    write_whole(PAGE, blocks.with_block(page, "benchmarks/algorithms.py", content))


def _said(wanted: argparse.Namespace, presets: Sequence[str], algorithms: Sequence[str]) -> list[str]:
    """Return the options that bring the same about."""
    said = [f"--preset {one}" for one in presets] + [f"--algorithm {one}" for one in algorithms]
    said += [f"--also {one}" for one in wanted.also]
    said += [f"--timesteps {wanted.timesteps}"] if wanted.timesteps else []
    return [*said, f"--episodes {wanted.episodes}"]


if __name__ == "__main__":
    main()
