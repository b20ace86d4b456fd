"""Scenario files: what is read, what is refused and how, and that what is written is read back."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import dq_marine
from dq_marine.envs.scenarios.environment import ScenarioStart, make_scenario
from dq_marine.envs.scenarios.files import load_scenario, read_scenarios, scenario_names, scenarios_of
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles.loading import catalogue_file

TASK = "dq_marine/StationKeeping-v0"
FILE = """
task = "StationKeeping"

[[scenario]]
name = "one"
description = "The first."
keywords.current = [0.1, 0.0, 0.0]
reset.position = [1.0, 2.0, 6.0]

[[scenario]]
name = "two"
description = "The second."
seed = 7
[scenario.reset]
goal_position = [0.0, 1.0, 5.0]
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(FILE)
    return path


def test_a_file_is_read_as_it_says(file):
    one, two = read_scenarios(file)
    assert (one.name, one.seed, one.keywords, one.reset) == (
        "one",
        0,
        {"current": [0.1, 0.0, 0.0]},
        {"position": [1.0, 2.0, 6.0]},
    )
    assert (two.name, two.seed, two.definition.id) == ("two", 7, TASK)
    assert load_scenario(f"{file}:two") == two
    with pytest.raises(
        InvalidInputError, match=r"one, two, and none is asked for; give one of them, as in .*:one"
    ):
        load_scenario(file)
    with pytest.raises(InvalidInputError, match="'three' is asked for"):
        load_scenario(f"{file}:three")


def test_a_scenario_begins_as_it_says_each_time(file):
    env = dq_marine.make_scenario(f"{file}:one")
    for _ in range(2):
        _, info = env.reset()
        assert env.unwrapped.position_ned == pytest.approx([1.0, 2.0, 6.0])
        assert info["current_ned"].tolist() == [0.1, 0.0, 0.0]


def test_what_is_given_to_reset_wins(file):
    env = make_scenario(f"{file}:one")
    first = env.reset()[0]
    assert not np.array_equal(env.reset(seed=5)[0], first)  # the attitude is drawn
    assert env.unwrapped.position_ned == pytest.approx([1.0, 2.0, 6.0])
    env.reset(options={"position": (0.0, 0.0, 5.0)})
    assert env.unwrapped.position_ned == pytest.approx([0.0, 0.0, 5.0])
    assert np.array_equal(env.reset()[0], first)
    with pytest.raises(InvalidInputError, match="give a dictionary, or None"):
        env.reset(options="here")


def test_what_is_given_to_make_wins(file):
    env = make_scenario(f"{file}:one", current=[0.0, 0.2, 0.0], max_episode_steps=12)
    assert env.reset()[1]["current_ned"].tolist() == [0.0, 0.2, 0.0]
    assert env.spec.max_episode_steps == 12


def test_an_environment_is_what_plain_gymnasium_makes_of_the_same(file):
    scenario = load_scenario(f"{file}:two")
    plain = gym.make(TASK, **scenario.keywords)
    expected = plain.reset(seed=scenario.seed, options=scenario.reset)[0]
    assert np.array_equal(make_scenario(scenario).reset()[0], expected)


def test_the_environment_is_made_again_from_its_spec(file):
    env = make_scenario(f"{file}:two")
    assert np.array_equal(gym.make(env.spec).reset()[0], env.reset()[0])
    assert pickle.loads(pickle.dumps(env.scenario)) == env.scenario


def test_a_start_needs_an_environment_of_its_task(file):
    with pytest.raises(InvalidInputError, match=r"make it with dq_marine\.make_scenario"):
        ScenarioStart(gym.make("dq_marine/WaypointTracking-v0"), load_scenario(f"{file}:one"))


def test_a_vehicle_is_found_beside_the_file(file):
    shutil.copy(catalogue_file("bluerov2"), file.parent / "my_rov.toml")
    text = 'task = "StationKeeping"\n[[scenario]]\nname = "a"\ndescription = "b"\nkeywords.vehicle = "my_rov.toml"\n'
    file.write_text(text)
    assert load_scenario(file).keywords["vehicle"] == str((file.parent / "my_rov.toml").resolve())
    assert make_scenario(file).unwrapped.vehicle.name == dq_marine.load_vehicle("bluerov2").name


@pytest.mark.parametrize("scenario", scenarios_of(), ids=lambda one: one.full_name)
def test_what_is_exported_is_read_back(scenario, tmp_path):
    path = tmp_path / "again.toml"
    path.write_text(scenario.toml)
    assert load_scenario(path) == scenario


VALUES = st.recursive(
    st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(min_size=1), inner, max_size=3),
    max_leaves=6,
)


@given(st.integers(0, 2**32 - 1), VALUES, VALUES, st.text("aé\"'\\ #=[]", min_size=1).filter(str.strip))
def test_any_values_are_written_so_that_they_are_read_back(
    tmp_path_factory, seed, current, position, description
):
    scenario = Scenario(
        name="any",
        description=description,
        task=TASK,
        seed=seed,
        keywords={"current": current},
        reset={"position": position},
    )
    path = tmp_path_factory.mktemp("written") / "any.toml"
    path.write_text(scenario.toml, encoding="utf-8")
    assert load_scenario(path) == scenario


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "one"', 'name = "One Two"', r"scenario.0.name = 'One Two': give a name in snake case"),
        ('name = "two"', 'name = "one"', r"the names \['one'\] stand there more than once"),
        ('description = "The first."', 'description = ""', "scenario.0.description = '': give one line"),
        ('description = "The first."', "", "scenario.0.description: missing; add it"),
        ("seed = 7", "seed = -1", "scenario.1.seed = -1"),
        ("seed = 7", "seed = 1.5", "scenario.1.seed = 1.5"),
        ("seed = 7", "level = 3", "scenario.1.level = 3: unknown key"),
        ("seed = 7", 'task = "Docking"', "a file has one task, above its tables"),
        ("keywords.current", "keywords.curent", r"no keyword 'curent' \(did you mean current\?\)"),
        ("reset.position", "reset.place", r"reset has no options \['place'\]; .* takes position, quaternion"),
        ('task = "StationKeeping"', 'task = "Sailing"', "there is no task 'Sailing'"),
        ('task = "StationKeeping"', 'task = "no_such_module:my/Task-v0"', "No module named 'no_such_module'"),
        ('task = "StationKeeping"', "", "task: missing; add it"),
        ('task = "StationKeeping"', "task = ", "not a TOML file"),
    ],
)
def test_a_wrong_file_is_refused_with_field_value_and_remedy(file, old, new, message):
    assert old in FILE
    file.write_text(FILE.replace(old, new, 1))
    with pytest.raises(InvalidInputError, match=message):
        read_scenarios(file)


@pytest.mark.parametrize(
    "content", ["", "task = 3", 'task = "StationKeeping"\nscenario = []', "\x00", "scenario = 1"]
)
def test_a_file_without_scenarios_is_refused(file, content):
    file.write_text(content)
    with pytest.raises(InvalidInputError, match=r"mine\.toml"):
        read_scenarios(file)


@pytest.mark.parametrize(
    ("name", "task", "message"),
    [
        ("calm", None, "may be any of Berthing/calm, .*; give one of these"),
        ("sunny", None, "there is no scenario 'sunny'; there are those that `dq-marine scenarios` lists"),
        ("StationKeeping/sunny", None, "there are StationKeeping/calm, "),
        ("Sailing/calm", None, "there is no task 'Sailing'"),
        ("StationKeeping/calm", "Docking", "is of dq_marine/StationKeeping-v0, not of 'Docking'"),
        ("nowhere.toml", None, "there is no file 'nowhere.toml'"),
        (3, None, "scenario = 3; give a name"),
        ("", None, "there is no scenario ''"),
    ],
)
def test_a_name_that_means_nothing_is_refused(name, task, message):
    with pytest.raises(InvalidInputError, match=message):
        load_scenario(name, task=task)


def test_a_name_is_found_by_its_last_part_where_that_leaves_no_doubt():
    assert load_scenario("imazu_07").full_name == "Encounter/imazu_07"
    assert load_scenario("calm", task="Docking").full_name == "Docking/calm"
    assert load_scenario(f"{TASK}/calm") == load_scenario("stationkeeping/calm")
    assert scenario_names("Docking")[0] == "Docking/calm"


def test_a_wrong_value_is_refused_when_the_environment_is_made(file):
    file.write_text(FILE.replace("[1.0, 2.0, 6.0]", "[1.0, 2.0]"))
    with pytest.raises(InvalidInputError, match=r"options\['position'\]"):
        make_scenario(f"{file}:one")
