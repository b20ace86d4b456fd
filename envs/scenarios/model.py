"""What a scenario is: checked, frozen models of the tables in scenario files."""

from __future__ import annotations

import re
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.keywords import check_known, writable_keywords
from dq_marine.envs.core.registry import short_name, task_imported
from dq_marine.envs.core.start import START_OPTIONS
from dq_marine.util.toml_text import toml_text

LARGEST_SEED = 2**32 - 1
"""Larger ones are no seeds of NumPy's global generator, which learning libraries seed, too."""

LONGEST_NAME, LONGEST_DESCRIPTION = 40, 120
"""Characters."""


def _snake_case(name: str) -> str:
    if not re.fullmatch("[a-z][a-z0-9_]*", name) or len(name) > LONGEST_NAME:
        raise ValueError(
            f"give a name in snake case of at most {LONGEST_NAME} characters, such as cross_current"
        )
    return name


def _one_line(text: str) -> str:
    if not text.strip() or not text.isprintable() or len(text) > LONGEST_DESCRIPTION:
        raise ValueError(
            f"give one line of at most {LONGEST_DESCRIPTION} characters, which says what is hard about it"
        )
    return text


class Table(BaseModel):
    """A table of a scenario file: frozen, without unknown keys, without infinities."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, strict=True)


class Scenario(Table):
    """An episode that can be repeated.

    Attributes:
        name: in snake case; unique in its file.
        description: one line for people: what is hard about it.
        task: name or id of a task; MODULE:ID imports a module first, which registers it.
        seed: of the environment's reset: fixes what nothing else fixes.
        keywords: of `gym.make`.
        reset: options of the environment's reset, in NED and SI units.
    """

    name: Annotated[str, AfterValidator(_snake_case)]
    description: Annotated[str, AfterValidator(_one_line)]
    task: str
    seed: Annotated[int, Field(ge=0, le=LARGEST_SEED)] = 0
    keywords: dict[str, Any] = Field(default_factory=dict)
    reset: dict[str, Any] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _names_are_known(self) -> Self:
        definition = self.definition
        check_known(definition.id, self.keywords, writable_keywords(definition))
        options = (*START_OPTIONS, *definition.options)
        unknown = sorted(set(self.reset) - set(options))
        if unknown:
            raise ValueError(f"reset has no options {unknown}; {definition.id} takes {', '.join(options)}")
        return self

    @property
    def definition(self) -> TaskDefinition:
        """The task."""
        return task_imported(self.task)

    @property
    def full_name(self) -> str:
        """The name behind that of the task, as in "StationKeeping/calm"."""
        return f"{short_name(self.definition)}/{self.name}"

    @property
    def toml(self) -> str:
        """The text of a file with this scenario alone."""
        own = {name: value for name, value in self.model_dump().items() if value != {} and name != "task"}
        table = toml_text({"scenario": own}).replace("[scenario]", "[[scenario]]", 1)
        return toml_text({"task": self.task}) + "\n" + table


class ScenarioFile(Table):
    """A scenario file.

    Attributes:
        task: of all scenarios in the file.
        scenario: the tables.
    """

    task: str
    scenario: Annotated[tuple[Scenario, ...], Field(min_length=1, strict=False)]

    @model_validator(mode="before")
    @classmethod
    def _tables_have_the_task(cls, content: Any) -> Any:
        tables = content.get("scenario")
        if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
            return content
        if any("task" in one for one in tables):
            raise ValueError(
                "a file has one task, above its tables; put scenarios of another task into another file"
            )
        return {**content, "scenario": [{"task": content.get("task"), **one} for one in tables]}

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        names = [one.name for one in self.scenario]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"the names {twice} stand there more than once; rename all but one of each")
        return self
