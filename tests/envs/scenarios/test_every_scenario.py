"""The scenarios that ship: for each task, twenty that can be made and begun, and begin alike each time."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from support.sweeps import sweep

from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.registry import TaskDefinition, shipped_tasks, short_name
from dq_marine.envs.scenarios.environment import make_scenario
from dq_marine.envs.scenarios.files import FOLDER, read_scenarios, scenarios_of
from dq_marine.errors import UnsuitableVehicleWarning

LEAST = 20
PLAIN = [task for task in shipped_tasks() if short_name(task) in ("StationKeeping", "Encounter")]


def of_task(task: TaskDefinition):
    """The scenarios of a task; one that is new may still be without, which the skipped test says."""
    found = scenarios_of(task.id)
    if not found:
        pytest.skip(f"{short_name(task)} has no file in envs/scenarios; add one with {LEAST} scenarios")
    return found


def same(one: Observation, other: Observation) -> bool:
    if isinstance(one, dict):
        return all(np.array_equal(one[part], other[part]) for part in one)
    return np.array_equal(one, other)


@pytest.mark.parametrize("task", shipped_tasks(), ids=short_name)
def test_a_task_has_twenty_scenarios_of_different_names(task):
    found = of_task(task)
    assert len(found) >= LEAST, (
        f"{short_name(task)} has {len(found)} scenarios; {LEAST - len(found)} are missing"
    )
    assert len({one.name for one in found}) == len(found)
    assert len({one.description for one in found}) == len(found)


@pytest.mark.parametrize("task", sweep(shipped_tasks(), plain=PLAIN), ids=short_name)
def test_scenarios_begin_alike_each_time_and_otherwise_than_each_other(task):
    """Nothing is compiled: an episode begins in plain Python."""
    begun = []
    for scenario in of_task(task):
        with warnings.catch_warnings():
            warnings.simplefilter("error", UnsuitableVehicleWarning)  # a scenario's vehicle can do its task
            env = make_scenario(scenario)
        observation, info = env.reset()
        again, info_again = env.reset()
        assert same(observation, again), scenario.full_name
        assert np.array_equal(info["current_ned"], info_again["current_ned"])
        episode = env.unwrapped.episode
        for name, value in scenario.reset.items():
            if name == "position":
                assert np.allclose(env.unwrapped.position_ned, value, atol=1e-9), scenario.full_name
            if name == "velocity":
                assert np.allclose(env.unwrapped.velocity_body, value, atol=1e-9), scenario.full_name
        begun.append((scenario.keywords, episode.state.tobytes(), episode.memory.tobytes()))
    for number, one in enumerate(begun):
        assert one not in begun[:number]


def test_every_file_is_of_a_task_of_its_own():
    tasks = [read_scenarios(path)[0].definition.id for path in sorted(FOLDER.glob("*.toml"))]
    assert len(set(tasks)) == len(tasks)
    assert set(tasks) <= {task.id for task in shipped_tasks()}
