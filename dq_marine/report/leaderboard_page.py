"""The leaderboard as a page: tables for each task, of seeded episodes and of scenarios."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dq_marine.report.interquartile import Interval, interquartile_interval
from dq_marine.report.leaderboard import Result, wilson_interval

OF_ACTIONS = ("effort", "action_change")
"""Figures of the actions, in the order of the tables."""

NOT_SHOWN = ("return", "collided", *OF_ACTIONS)
"""Figures that are no metrics of the task."""

EXPLANATION = """\
Success is what the task says of it, at the end of an episode; in brackets the 95 % interval by Wilson's score. Metrics
are means over the last third of an episode; `effort` is the mean square of the actions, 0 to 1, and `action_change` the
root mean square of their change from one control period to the next, 0 to 2: the smoother, the smaller. Of these,
tables give the interquartile mean over the episodes, and in brackets its 95 % interval by the percentile bootstrap
(Agarwal et al. 2021, as rliable has it). `collided` counts the episodes in which the vehicle hit something, of tasks
with something to hit."""

OF_SCENARIOS = """\
Each scenario is flown once, as it is named; the intervals say what other scenarios of the kind may bring, by drawing
scenarios with replacement. `dq-marine scenarios` says what each is."""


def markdown(results: Sequence[Result], command: str, circumstances: str) -> str:
    """Return the page.

    Args:
        results: of all entries.
        command: that makes the page again.
        circumstances: what was measured with, as a sentence.
    """
    lines = ["# Leaderboard", "", f"`{command}`", "", circumstances, "", EXPLANATION]
    if any(one.entry.scenario for one in results):
        lines += ["", OF_SCENARIOS]
    for task in dict.fromkeys(one.entry.task for one in results):
        lines += ["", f"## {task}"]
        own = [one for one in results if one.entry.task == task]
        seeded = [one for one in own if not one.entry.scenario]
        named = [one for one in own if one.entry.scenario]
        if seeded:
            lines += ["", *seeded_table(seeded)]
        if named:
            lines += ["", "Scenarios together:", "", *agents_table(named), "", "One by one:", ""]
            lines += scenarios_table(named)
    return "\n".join(lines) + "\n"


def seeded_table(results: Sequence[Result]) -> list[str]:
    """Return the lines of a table of a task's seeded episodes: a row for each of who flew what."""
    names = _metrics(results)
    perturbed = any(one.entry.perturbation for one in results)
    who = ["vehicle", "level", *(["perturbed by"] if perturbed else []), "agent"]
    heading = [*who, *_headings(names, results), "ended early"]
    rows = []
    for one in results:
        figures = [_with_interval(one.figures[name]) for name in (*names, *OF_ACTIONS)]
        early = f"{one.score['early_end_rate']:.1%}"
        cells = [_success(one.successes, one.episodes), *figures, *_collisions([one]), early]
        by = [one.entry.perturbation or "nothing"] if perturbed else []
        rows.append([one.entry.vehicle, one.entry.level, *by, one.entry.agent, *cells])
    return _table(heading, rows, texts=len(who))


def agents_table(results: Sequence[Result]) -> list[str]:
    """Return the lines of a table of all scenarios of a task together: a row for each agent."""
    names = _metrics(results)
    rows = []
    for agent in dict.fromkeys(one.entry.agent for one in results):
        own = [one for one in results if one.entry.agent == agent]
        figures = [
            _with_interval(interquartile_interval([one.figures[name].iqm for one in own]))
            for name in (*names, *OF_ACTIONS)
        ]
        success = _success(sum(one.successes for one in own), sum(one.episodes for one in own))
        rows.append([agent, success, *figures, *_collisions(own)])
    return _table(["agent", *_headings(names, results)], rows, texts=1)


def scenarios_table(results: Sequence[Result]) -> list[str]:
    """Return the lines of a table of a task's scenarios: a row for each scenario and agent."""
    names = _metrics(results)
    rows = []
    for one in results:
        figures = [f"{one.figures[name].iqm:.3g}" for name in (*names, *OF_ACTIONS)]
        success = "yes" if one.successes else "no"
        rows.append(
            [one.entry.scenario, one.entry.vehicle, one.entry.agent, success, *figures, *_collisions([one])]
        )
    return _table(["scenario", "vehicle", "agent", *_headings(names, results)], rows, texts=3)


def _metrics(results: Sequence[Result]) -> list[str]:
    return [name for name in results[0].figures if name not in NOT_SHOWN]


def _headings(metrics: Iterable[str], results: Sequence[Result]) -> list[str]:
    hit = ["`collided`"] if _measures_collisions(results[0]) else []
    return ["success", *(f"`{name}`" for name in (*metrics, *OF_ACTIONS)), *hit]


def _measures_collisions(result: Result) -> bool:
    return result.score["collision_rate"] is not None


def _collisions(results: Sequence[Result]) -> list[str]:
    if not _measures_collisions(results[0]):
        return []
    count = round(sum(one.score["collision_rate"] * one.episodes for one in results))
    return [f"{count} of {sum(one.episodes for one in results)}"]


def _success(successes: int, episodes: int) -> str:
    low, high = wilson_interval(successes, episodes)
    return f"{successes} of {episodes} ({low:.1%} to {high:.1%})"


def _with_interval(figure: Interval) -> str:
    return f"{figure.iqm:.3g} ({figure.low:.3g} to {figure.high:.3g})"


def _table(heading: list[str], rows: Sequence[list[str]], *, texts: int) -> list[str]:
    """Return the lines of a table whose first columns are texts, and the others numbers."""
    ruler = ["---"] * texts + ["---:"] * (len(heading) - texts)
    return ["| " + " | ".join(row) + " |" for row in (heading, ruler, *rows)]
