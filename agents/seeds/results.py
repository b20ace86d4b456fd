"""How the seeds of a training ended: each, their mean and spread, and how many learned the task."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, stdev

from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.evaluation.metrics import Metric, metrics_of
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings
from dq_marine.agents.training.run_folder import RunFolder, damaged_summary
from dq_marine.util.files import write_csv
from dq_marine.util.parted_table import Column, PartedTable

LEARNED = 0.8
"""Share of the episodes that must succeed for a seed to have learned: a curriculum's, before its next level."""


@dataclass(frozen=True)
class SeedResult:
    """How the run of a seed ended.

    Attributes:
        seed: of the run.
        timesteps: learned from.
        wall_time: spent [s], over all sessions.
        episodes: that the best model flew at the end, none of which it had seen.
        mean_return: of these episodes, undiscounted.
        success_rate: share of them at whose end the task counted as done.
        metrics: at the end of an episode, mean over them, by the name with the unit that people read.
    """

    seed: int
    timesteps: int
    wall_time: float
    episodes: int
    mean_return: float
    success_rate: float
    metrics: dict[str, float]

    @property
    def learned(self) -> bool:
        """Whether enough of the episodes succeeded."""
        return self.success_rate >= LEARNED


def result_of(run: RunFolder, seed: int) -> SeedResult:
    """Return how a run that is finished ended, from its summary.

    Raises:
        InvalidInputError: the summary is missing or damaged.
    """
    summary = run.read_summary()
    try:
        score = summary["score"]
        return SeedResult(
            seed=seed,
            timesteps=int(summary["timesteps"]),
            wall_time=float(summary["wall_time"]),
            episodes=int(score["episodes"]),
            mean_return=float(score["returns"]["mean"]),
            success_rate=float(score["success_rate"]),
            metrics={name: float(one["final"]["mean"]) for name, one in score["metrics"].items()},
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise damaged_summary(run.summary_file, error) from error


def write_results(path: Path, results: Sequence[SeedResult]) -> None:
    """Write a row for each seed as CSV.

    Raises:
        InvalidInputError: the file cannot be written.
    """
    write_csv(
        path,
        (
            {
                "seed": one.seed,
                "mean_return": one.mean_return,
                "success_rate": one.success_rate,
                **{f"final_{name}": value for name, value in one.metrics.items()},
                "timesteps": one.timesteps,
                "wall_time_s": one.wall_time,
            }
            for one in results
        ),
    )


def results_table(settings: TrainingSettings, results: Sequence[SeedResult]) -> PartedTable:
    """Return a table for Rich with a row for each seed, and below them mean and standard deviation over the seeds."""
    name, episodes = settings.algorithm.name.upper(), results[0].episodes
    several = len(results) > 1
    learned = sum(one.learned for one in results)
    return PartedTable(
        names=[Column("seed", [*(str(one.seed) for one in results), *(("mean", "sd") if several else ())])],
        numbers=[
            _column("return", [one.mean_return for one in results], "{:.1f}".format),
            *(
                _column(metric.heading("final"), [one.metrics[name] for one in results], _text_of(metric))
                for name, metric in _metrics_in(settings.environment).items()
            ),
            _column("success", [one.success_rate for one in results], "{:.0%}".format),
            _column("timesteps", [one.timesteps for one in results], "{:,.0f}".format),
            _column("wall time [s]", [one.wall_time for one in results], "{:,.0f}".format),
        ],
        title=f"{name}: the best model of each seed, over {episodes} new episodes",
        caption=f"{learned} of {len(results)} seeds learned it: at least {LEARNED:.0%} of their episodes succeeded",
    )


def _column(heading: str, values: Sequence[float], text: Callable[[float], str]) -> Column:
    below = (fmean(values), stdev(values)) if len(values) > 1 else ()
    return Column(heading, [text(value) for value in (*values, *below)])


def _text_of(metric: Metric) -> Callable[[float], str]:
    return lambda value: metric.text(value, unit=False)


def _metrics_in(environment: EnvironmentSettings) -> dict[str, Metric]:
    """Return what episodes in an environment are measured by, by the name with the unit that people read."""
    env = make_environment(environment)
    metrics = metrics_of(marine(env).definition)
    env.close()
    return {metric.shown_name: metric for metric in metrics}
