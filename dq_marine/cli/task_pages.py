"""The pages of the tasks: one for each, and an index, made of what the tasks declare and of what was flown."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Sequence
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

from dq_marine.cli.task_tables import (
    TextTable,
    action_table,
    keyword_table,
    level_table,
    observation_table,
    outcome_table,
    reward_table,
    scenario_conditions_table,
    suiting_vehicles,
)
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.registry import shipped_tasks, short_name
from dq_marine.envs.core.start import START_OPTIONS
from dq_marine.envs.scenarios.files import scenarios_of
from dq_marine.report.leaderboard import Result, read_results
from dq_marine.report.leaderboard_page import EXPLANATION, agents_table, seeded_table
from dq_marine.task.protocol import never
from dq_marine.vehicles import load_vehicle

INDEX = "README.md"
LEADERBOARD = "leaderboard.json"
"""Looked for beside the folder of the pages."""

MADE = "<!-- Made by `dq-marine tasks --pages docs/tasks`; a test compares. -->"

OF_PAGES = """\
Each page says what an agent is shown and what it commands, what it is rewarded for and what counts as success, the
keywords of `gym.make`, the options of `reset`, the levels of difficulty, and the scenarios: episodes that can be
repeated, by name."""

OF_ACTIONS = """\
Box(-1, 1): with `actuation="wrench"` the force and the moment along the axes that the vehicle drives, over their
limits; with `actuation="thrusters"` the commands of thrusters, azimuths and fins. The default is:"""

MEANINGS = {
    "position": "in NED [m]",
    "quaternion": "body to NED, scalar first",
    "velocity": "over ground, in Fossen's order [m/s, rad/s]",
    "current": "in NED [m/s]",
}
"""Of options of `reset`, by the last word of their names."""

OF_KEYWORDS = """\
Every task takes the keywords of `dq_marine.Settings` besides, such as `vehicle`, `current`, `weather` and `sensors`."""

OF_LEVELS = 'A level stands for keywords, over which those that are given win: `gym.make(..., level="easy")`.'

OF_SCENARIOS = """\
Episodes that can be repeated: `dq-marine fly --scenario NAME`. What keywords and options leave open, the seed fixes."""


def task_pages(leaderboard: Path | None = None) -> dict[str, str]:
    """Return the pages of all tasks that ship, and the index, by the names of their files.

    Args:
        leaderboard: file of figures that `dq-marine leaderboard` wrote; None or no file for none.

    Raises:
        InvalidInputError: the file of figures is there, and is none.
    """
    flown = read_results(leaderboard)[1] if leaderboard is not None and leaderboard.is_file() else []
    tasks = shipped_tasks()
    pages = {
        page_name(task): task_page(task, [one for one in flown if one.entry.task == task.id])
        for task in tasks
    }
    return {INDEX: index_page(tasks), **pages}


def page_name(task: TaskDefinition) -> str:
    """Return the name of a task's page."""
    return f"{short_name(task)}.md"


def picture_name(task: TaskDefinition) -> str:
    """Return the name of a task's picture, beside its page."""
    return f"{short_name(task)}.png"


def index_page(tasks: Sequence[TaskDefinition]) -> str:
    """Return the page that leads to all others."""
    rows = [
        (
            f"[{short_name(task)}]({page_name(task)})",
            task.summary,
            f"`{task.vehicle}`",
            str(len(suiting_vehicles(task))),
            str(len(scenarios_of(task.id))),
        )
        for task in tasks
    ]
    table = TextTable("tasks", ("task", "what it is", "default vehicle", "vehicles", "scenarios"), rows)
    return _joined([MADE, "# Tasks", OF_PAGES, table.markdown])


def task_page(task: TaskDefinition, flown: Sequence[Result]) -> str:
    """Return the page of a task.

    Args:
        task: whose page.
        flown: what agents achieved in it.
    """
    vehicle = load_vehicle(task.vehicle)
    return _joined(
        [
            MADE,
            f"# {short_name(task)}",
            task.summary,
            f"![The baseline controller in a scenario]({picture_name(task)})"
            if scenarios_of(task.id)
            else "",
            *_in_short(task, task.period_for(vehicle)),
            *_section("Action", action_table(task, vehicle), OF_ACTIONS),
            *_section("Observation", observation_table(task, vehicle)),
            *_section("Reward", reward_table(task), documented(type(task.weights))),
            *_section("Metrics and success", outcome_table(task), documented(task.task.metrics), _end(task)),
            *_section("Keywords", keyword_table(task, vehicle), *_keywords_said(task.settings), OF_KEYWORDS),
            *_section("Options of `reset`", options_table(task), "What is not given is drawn with the seed."),
            *(_section("Levels", level_table(task), OF_LEVELS) if task.levels else []),
            "## Vehicles that it suits",
            ", ".join(f"`{one}`" for one in suiting_vehicles(task)),
            *_scenarios(task),
            *_figures(flown),
        ]
    )


def _in_short(task: TaskDefinition, period: float) -> list[str]:
    """Return what is said at the top of a page: the id, times, and commands to begin with."""
    name, scenarios = short_name(task), scenarios_of(task.id)
    times = (
        f"`{task.id}`, by default with `{task.vehicle}`: an action every {period:g} s, for which the integrator takes "
        f"{task.substeps} steps, and at most {task.max_episode_steps} actions, {period * task.max_episode_steps:g} s. "
        "The tables are for this vehicle."
    )
    flight = f"--scenario {scenarios[0].full_name}" if scenarios else f"--task {name}"
    commands = (
        f"dq-marine fly {flight} --live",
        f"dq-marine evaluate --task {name} --agent controller --agent zero --episodes 20",
    )
    python = (
        f'gymnasium.make("{task.id}")'
        if not scenarios
        else f'dq_marine.make_scenario("{scenarios[0].full_name}")'
    )
    return [_wrapped(times), "\n".join(["```", *commands, "```"]), f"In Python: `{python}`."]


def _section(title: str, table: TextTable, *texts: str) -> list[str]:
    return [f"## {title}", *texts, table.markdown]


def _end(task: TaskDefinition) -> str:
    """Say when an episode ends before its time."""
    ends = task.task.terminated
    if ends is never:
        return "An episode does not end before its time."
    reason = inspect.cleandoc(ends.__doc__ or "").partition("\n")[0].removeprefix("Whether ")
    return _wrapped(f"An episode ends before its time where {reason}")


def _scenarios(task: TaskDefinition) -> list[str]:
    if not scenarios_of(task.id):
        return []
    return ["## Scenarios", OF_SCENARIOS, scenario_conditions_table(task).markdown]


def _figures(flown: Sequence[Result]) -> list[str]:
    """Return what agents achieved, as the leaderboard has it; nothing where nothing was flown."""
    seeded = [one for one in flown if not one.entry.scenario]
    named = [one for one in flown if one.entry.scenario]
    parts = ["## What agents achieve", EXPLANATION] if flown else []
    if seeded:
        parts += ["\n".join(seeded_table(seeded))]
    if named:
        parts += ["All scenarios together, each flown once:", "\n".join(agents_table(named))]
    return parts


def options_table(task: TaskDefinition) -> TextTable:
    """Return the options of `reset` that a task takes."""
    sizes = {**START_OPTIONS, **task.options}
    rows = [
        (f"`{name}`", str(size), MEANINGS.get(name.rpartition("_")[2], "")) for name, size in sizes.items()
    ]
    return TextTable("options", ("option", "numbers", "meaning"), rows)


def _keywords_said(settings: type[Any]) -> list[str]:
    """Return what is said of keywords: the task's own, and those that it shares with other tasks."""
    return [documented(one) for one in settings.__mro__ if is_dataclass(one)]


def documented(thing: Any) -> str:
    """Return what a docstring says, as Markdown: its attributes as a list."""
    text = inspect.cleandoc(thing.__doc__ or "")
    before, _, attributes = text.partition("Attributes:\n")
    listed: list[str] = []
    for line in textwrap.dedent(attributes).splitlines():
        if line.startswith(" "):
            listed[-1] += " " + line.strip()
        elif line.strip():
            name, _, meaning = line.partition(": ")
            listed.append(f"- `{name}`: {meaning.strip()}")
    paragraphs = [_wrapped(" ".join(one.split())) for one in before.split("\n\n") if one.strip()]
    return _joined([*paragraphs, "\n".join(_wrapped(one, "  ") for one in listed)]).strip()


def _joined(parts: Sequence[str]) -> str:
    """Return the text of paragraphs and tables; empty ones are left out."""
    return "\n\n".join(part for part in parts if part) + "\n"


def _wrapped(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
