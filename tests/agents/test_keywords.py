"""Keywords of environments: which there are, and settings that are changed by them."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.keywords import differences, known_keywords, with_changes
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.registry import register_task, task_named, unregister_task
from dq_marine.errors import InvalidInputError


@dataclasses.dataclass(frozen=True)
class Own:
    """Keywords of a task that is registered from outside."""

    width: float = 1.0


def settings(**keywords: Any) -> EnvironmentSettings:
    return EnvironmentSettings(id=DEFAULT_ENVIRONMENT.id, keywords=keywords)


@pytest.fixture
def other_task() -> Iterator[str]:
    """The id of a task that is registered from outside, with a keyword of its own."""
    definition = dataclasses.replace(task_named(DEFAULT_ENVIRONMENT.id), id="tests/Other-v0", settings=Own)
    register_task(definition)
    yield definition.id
    unregister_task(definition.id)


def test_known_keywords_are_those_of_settings_and_task() -> None:
    known = known_keywords(DEFAULT_ENVIRONMENT.id)
    assert {"vehicle", "current", "actuation", "weather", "sensors", "max_episode_steps"} <= set(known)
    assert {"reward", "start_radius", "gravity"} <= set(known)
    assert not {"task", "settings", "render_mode", "record", "forces", "extra_rewards"} & set(known)
    assert list(known) == sorted(known)


def test_another_task_has_other_keywords(other_task: str) -> None:
    known = known_keywords(other_task)
    assert {"vehicle", "width"} <= set(known)
    assert "start_radius" not in known


def test_a_module_may_register_the_task(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "my_task.py").write_text(
        "import dataclasses\n"
        "from dq_marine.envs.core.registry import register_task, task_named\n"
        "mine = dataclasses.replace(task_named('dq_marine/StationKeeping-v0'), id='my/Task-v0')\n"
        "register_task(mine)\n",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(tmp_path)
    try:
        assert "start_radius" in known_keywords("my_task:my/Task-v0")
        exported = EnvironmentSettings(id="my/Task-v0", keywords={"current": 0.3})
        named = with_changes(exported, {}, identifier="my_task:my/Task-v0")
        assert named == EnvironmentSettings(id="my_task:my/Task-v0", keywords={"current": 0.3})
    finally:
        sys.modules.pop("my_task", None)
    unregister_task("my/Task-v0")


@pytest.mark.parametrize("identifier", ["Nothing-v0", "no_such_module:Mine-v0"])
def test_unknown_environments_are_refused(identifier: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"environment id = '{identifier}'"):
        known_keywords(identifier)


@pytest.mark.parametrize("name", ["WaypointTracking", "waypointtracking", "dq_marine/WaypointTracking-v0"])
def test_a_task_is_known_by_its_short_name(name: str) -> None:
    changed = with_changes(settings(start_radius=3.0), {}, identifier=name)
    assert changed == EnvironmentSettings(id="dq_marine/WaypointTracking-v0")


def test_environments_of_others_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="'CartPole-v1' is not one of dq_marine"):
        known_keywords("CartPole-v1")


def test_unknown_keywords_are_refused_with_those_there_are() -> None:
    with pytest.raises(
        InvalidInputError, match=r"no keyword 'curent' \(did you mean current\?\); it takes .*actuation, "
    ):
        with_changes(DEFAULT_ENVIRONMENT, {"curent": 0.3})
    with pytest.raises(InvalidInputError, match=r"no keyword 'xyzzy'; it takes "):
        with_changes(DEFAULT_ENVIRONMENT, {"xyzzy": 0.3})


def test_changes_reach_into_tables_and_null_takes_the_default() -> None:
    before = settings(current=0.3, reward={"effort": 0.1, "attitude": 0.2})
    after = with_changes(before, {"current": None, "reward": {"effort": 0.5}, "substeps": 2})
    assert after.keywords == {"reward": {"effort": 0.5, "attitude": 0.2}, "substeps": 2}
    assert before.keywords == {"current": 0.3, "reward": {"effort": 0.1, "attitude": 0.2}}


def test_another_task_begins_without_keywords(other_task: str) -> None:
    changed = with_changes(settings(current=0.3), {"width": 2.0}, identifier=other_task)
    assert changed == EnvironmentSettings(id=other_task, keywords={"width": 2.0})


def test_differences_name_both_values() -> None:
    one, other = settings(current=0.3, substeps=2), settings(current=0.5, scheme="newton")
    assert differences(one, other) == {
        "current": (0.3, 0.5),
        "scheme": (None, "newton"),
        "substeps": (2, None),
    }
    assert differences(one, one) == {}
    assert "id" in differences(one, EnvironmentSettings(id="Other-v0", keywords=one.keywords))
