"""Train the policies of presets with several seeds, and fly each through episodes that it has never seen.

Run: python benchmarks/training_seeds.py [--preset NAME ...] [--seed N ...] [--episodes N] [--runs FOLDER] [--out FILE]

Each run is that of `dq-marine train --preset NAME --seed N --run FOLDER/NAME-N`; one that is in the folder already, and
has ended, is not trained again. Writes the tables of docs/howto/shipped_policies.md, between its words. A bound is kept
in an episode where the means of both errors over its last third are within it. In the helix, errors are root mean
squares: over all instants, with the way from the start to the point, and over the last thirds, without it; and over
all instants of flights that begin at rest where the point is, with the bow where it goes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import gymnasium as gym
import numpy as np
from suite import blocks, circumstances, trainings
from suite.tables import table

from dq_marine.agents.environments import make_environment, marine, scenario_settings
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.metrics import Metric
from dq_marine.agents.policies import load_policy, trained_environment
from dq_marine.agents.policy_names import policy_path, shipped_policies
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.scenarios.files import load_scenario
from dq_marine.util.files import with_folder, write_json, write_whole

PAGE = circumstances.ROOT / "docs" / "howto" / "shipped_policies.md"

Env: TypeAlias = gym.Env[Any, Any]

Begin: TypeAlias = Callable[[Env, int], dict[str, Any] | None]
"""Environment and seed -> options of its reset."""


class Bound(NamedTuple):
    """Within what the two errors of a task shall stay, in the units that people read; and a scenario to fly besides."""

    errors: tuple[float, float]
    scenario: str | None = None


BOUNDS = {
    "StationKeeping": Bound((0.05, 3.0)),
    "TrajectoryTracking": Bound((0.1, 5.0), "TrajectoryTracking/helix_of_unknown_vehicle"),
}


@dataclass(frozen=True)
class Flights:
    """What a policy did in its episodes.

    Attributes:
        episodes: how many.
        successes: of them that succeeded, as the task says.
        kept: of them in which the bound was kept.
        percentile: the 95th of each error's mean over the last third.
        whole: each error's root mean square over all instants of all episodes.
        steady: the same over their last thirds.
    """

    episodes: int
    successes: int
    kept: int
    percentile: list[float]
    whole: list[float]
    steady: list[float]


def trained(preset: str, seed: int, runs: Path) -> tuple[Path, list[str]]:
    """Return the folder of a run, which is trained if it is not there, and its two times, as the cells of its row."""
    folder = runs / f"{preset}-{seed}"
    run = trainings.trained(["--preset", preset, "--seed", str(seed)], folder)
    return folder, trainings.times_of(run)


def folder_of_shipped(preset: str, runs: Path) -> Path:
    """Return where what the shipped policy flew is kept: elsewhere once there is another policy of that name."""
    digest = hashlib.sha256(policy_path(preset).read_bytes()).hexdigest()
    return runs / f"{preset}-shipped-{digest[:12]}"


def errors_of(episode: Episode, metric: Metric, *, steady: bool) -> Any:
    """Return an error over an episode, or over its last third, in the unit that people read."""
    values = metric.shown(episode.measured[metric.name])
    return values[episode.last_third] if steady else values


def anywhere(env: Env, seed: int) -> None:
    """Let an episode begin where the task lets it."""


def at_the_point(env: Env, seed: int) -> dict[str, Any]:
    """Return options by which an episode begins at rest where its goal is then, with the bow where that goes."""
    env.reset(seed=seed)
    shown = marine(env).snapshot()
    attitude = shown.goal_quaternion_body_to_ned
    return {"position": shown.goal_position_ned, "quaternion": attitude, "velocity": np.zeros(6)}


def flights(
    policy: Path, environment: EnvironmentSettings, bound: Bound, episodes: int, begin: Begin = anywhere
) -> Flights:
    """Fly a policy through episodes that it has not seen."""
    env, agent = make_environment(environment), load_policy(policy)
    seeds = range(trainings.UNSEEN, trainings.UNSEEN + episodes)
    flown = [fly_episode(env, agent, seed=seed, options=begin(env, seed)) for seed in seeds]
    metrics = flown[0].metrics

    def root_mean_squares(*, steady: bool) -> list[float]:
        every = [
            np.concatenate([errors_of(one, metric, steady=steady) for one in flown]) for metric in metrics
        ]
        return [float(np.sqrt(np.mean(np.square(values)))) for values in every]

    means = np.array([[errors_of(one, metric, steady=True).mean() for metric in metrics] for one in flown])
    return Flights(
        episodes,
        sum(one.success for one in flown),
        int(np.count_nonzero((means <= bound.errors).all(axis=1))),
        np.percentile(means, 95.0, axis=0).tolist(),
        root_mean_squares(steady=False),
        root_mean_squares(steady=True),
    )


def kept_flights(
    file: Path,
    policy: Path,
    environment: EnvironmentSettings,
    bound: Bound,
    episodes: int,
    begin: Begin = anywhere,
) -> Flights:
    """Return the flights of a policy, which stand in a file once they are flown."""
    if not file.is_file():
        write_json(with_folder(file), vars(flights(policy, environment, bound, episodes, begin)))
    return Flights(**json.loads(file.read_text(encoding="utf-8")))


def cells_of(policy: Path, bound: Bound, episodes: int, folder: Path) -> list[str]:
    """Return what a policy did, as the last cells of its row."""
    file = folder / f"flights_{episodes}.json"
    own = kept_flights(file, policy, trained_environment(policy), bound, episodes)
    cells = [f"{own.successes} of {episodes}", f"{own.kept} of {episodes}"]
    cells += [f"{number:.3g}" for number in own.percentile]
    if bound.scenario is not None:
        helix = scenario_settings(load_scenario(bound.scenario))
        there = kept_flights(folder / f"helix_{episodes}.json", policy, helix, bound, episodes)
        cells += [f"{there.kept} of {episodes}"]
        cells += [f"{whole:.3g}, {late:.3g}" for whole, late in zip(there.whole, there.steady, strict=True)]
        kept = folder / f"helix_at_the_point_{episodes}.json"
        along = kept_flights(kept, policy, helix, bound, episodes, at_the_point)
        cells += [", ".join(f"{whole:.3g}" for whole in along.whole)]
    return cells


def other_presets(presets: Sequence[str], seeds: Sequence[int], episodes: int, runs: Path) -> str:
    """Return the table of the presets without a bound."""
    rows = []
    for preset in presets:
        shipped = trainings.successes(folder_of_shipped(preset, runs), policy_path(preset), episodes)
        rows.append([preset, "as it ships", "", "", f"{shipped} of {episodes}"])
        for seed in seeds:
            folder, times = trained(preset, seed, runs)
            found = trainings.successes(folder, folder, episodes)
            rows.append(["", f"seed {seed}", *times, f"{found} of {episodes}"])
    header = ["preset", "policy", *trainings.TIMES, "success"]
    return f"{table(header, rows)}\n"


def section(preset: str, seeds: Sequence[int], episodes: int, runs: Path) -> str:
    """Return the table of a preset, with its heading."""
    bound, as_shipped = BOUNDS[preset], folder_of_shipped(preset, runs)
    rows = [["as it ships", "", "", *cells_of(policy_path(preset), bound, episodes, as_shipped)]]
    for seed in seeds:
        folder, times = trained(preset, seed, runs)
        rows.append([f"seed {seed}", *times, *cells_of(folder, bound, episodes, folder)])
    position, angle = bound.errors
    header = [
        "policy",
        *trainings.TIMES,
        "success",
        f"within {position:g} m and {angle:g} deg",
        "position, 95 % [m]",
        "angle, 95 % [deg]",
    ]
    if bound.scenario is not None:
        header += ["helix: within the same", "helix: position, RMS [m]", "helix: heading, RMS [deg]"]
        header += ["helix from the point on: both, RMS"]
    return f"### {preset}\n\n{table(header, rows)}\n"


def provenance(wanted: argparse.Namespace, presets: Sequence[str]) -> str:
    """Return the command for these presets, machine and versions, as a paragraph."""
    chosen = [f"--preset {one}" for one in presets] + [f"--seed {one}" for one in wanted.seed]
    command = f"benchmarks/training_seeds.py {' '.join(chosen)} --episodes {wanted.episodes}"
    return blocks.provenance(command)


def main() -> None:
    """Train, fly, and write the tables into the page."""
    parser = trainings.options(__doc__, episodes=200)
    parser.add_argument("--seed", action="append", type=int)
    parser.add_argument("--out", type=Path, default=PAGE)
    wanted = parser.parse_args()
    wanted.preset = wanted.preset or list(shipped_policies())
    wanted.seed = wanted.seed or list(range(5))
    page = PAGE.read_text(encoding="utf-8")
    bounded = [one for one in wanted.preset if one in BOUNDS]
    if bounded:
        tables = [section(one, wanted.seed, wanted.episodes, wanted.runs) for one in bounded]
        page = _with(page, "bounds", provenance(wanted, bounded), "".join(tables))
    others = [one for one in wanted.preset if one not in BOUNDS]
    if others:
        tables = [other_presets(others, wanted.seed, wanted.episodes, wanted.runs)]
        page = _with(page, "others", provenance(wanted, others), "".join(tables))
    write_whole(with_folder(wanted.out), page)


def _with(page: str, block: str, source: str, tables: str) -> str:
    return blocks.with_block(page, f"benchmarks/training_seeds.py: {block}", f"{source}\n{tables}")


if __name__ == "__main__":
    main()
