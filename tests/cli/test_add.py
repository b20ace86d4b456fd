"""Adding a task, a force, a sensor, a reward term or a vehicle: what command and page say is true, and works."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.command_line import assert_refused, run
from support.sweeps import sweep

from dq_marine.cli.add import Kind
from dq_marine.cli.additions import ADDITIONS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/architecture.md").read_text()
BEGIN, END = "<!-- dq-marine add --markdown -->\n", "<!-- end of dq-marine add -->"
EXAMPLES = dict(re.findall(r"`(\w+\.(?:py|toml))`:\n\n```(?:python|toml)\n(.*?)```", PAGE, re.DOTALL))

FLIGHT = """
import gymnasium as gym
import numpy as np
from altimeter import Altimeter
from calm import CALM
from tether import TETHER

keywords = dict(
    vehicle="my_vehicle.toml",
    forces=[TETHER],
    sensors=[Altimeter(noise=0.1, rate=5.0, seabed=50.0)],
    extra_rewards=[CALM],
    deepest=6.0,
)
env = gym.make("depth_keeping:my/DepthKeeping-v0", **keywords)
inner = env.unwrapped
assert inner.vehicle.name == "My vehicle"
assert "tether" in inner.scene.terms
names = [part.name for part in inner.observations]
assert names[0] == "depth_error" and names[-2:] == ["altimeter_age", "altimeter_0"], names

env.reset(seed=0)
_, _, _, _, info = env.step(env.action_space.sample())
rate = inner.velocity_body[3:]
assert np.isclose(info["reward/calm"], -0.1 * rate @ rate)
print("flown")
"""

LANES = """
envs = gym.make_vec("depth_keeping:my/DepthKeeping-v0", num_envs=3, max_episode_steps=6, **keywords)
together, _ = envs.reset(seed=0)
singles = [gym.make("my/DepthKeeping-v0", **keywords) for _ in range(3)]
alone = [env.reset(seed=seed)[0] for seed, env in enumerate(singles)]
assert np.array_equal(together, alone)
depth = singles[0].unwrapped.position_ned[2]
assert 0.0 < abs(alone[0][-1] - (50.0 - depth)) < 1.0
for _ in range(5):
    actions = envs.action_space.sample()
    together, rewards, _, _, infos = envs.step(actions)
    stepped = [env.step(action) for env, action in zip(singles, actions, strict=True)]
    assert np.array_equal(together, [one[0] for one in stepped])
    assert rewards.tolist() == [one[1] for one in stepped]
    assert infos["reward/calm"].tolist() == [one[4]["reward/calm"] for one in stepped]
print("flown")
"""


def test_the_page_says_what_the_command_says():
    begin, end = PAGE.index(BEGIN) + len(BEGIN), PAGE.index(END)
    printed = run("add", "--markdown").stdout
    assert PAGE[begin:end] == f"\n{printed}\n", "paste what `dq-marine add --markdown` prints"


def test_every_kind_can_be_named():
    assert [kind.value for kind in Kind] == list(ADDITIONS)


@pytest.mark.parametrize("addition", ADDITIONS.values(), ids=lambda addition: addition.name)
def test_the_files_exist(addition):
    assert [change.path for change in addition.inside if not (ROOT / change.path).exists()] == []


@pytest.mark.parametrize("addition", ADDITIONS.values(), ids=lambda addition: addition.name)
def test_the_command_shows_files_template_and_result(addition):
    printed = run("add", addition.name).stdout
    assert addition.text in printed
    assert addition.result in printed
    assert all(change.path in printed for change in addition.inside)
    assert run("add", addition.name, "--template").stdout == addition.text


def test_the_overview_names_all_files():
    printed = re.sub(r"\s", "", run("add").stdout)
    assert all(change.path in printed for one in ADDITIONS.values() for change in one.inside)


def test_a_template_of_nothing_is_refused():
    assert_refused(run("add", "--template"), "name it: task, force")


def test_the_places_that_are_edited_are_there():
    assert "present = (" in (ROOT / "dq_marine/simulation/scene.py").read_text()
    assert "\nKINDS: " in (ROOT / "dq_marine/task/sensors/build.py").read_text()
    assert "class Rewards(" in (ROOT / "envs/tasks/station_keeping.py").read_text()
    assert '"dq_marine.physics.wind",' in (ROOT / "pyproject.toml").read_text()


@pytest.fixture
def written(tmp_path):
    """The examples of the page, in a folder of their own."""
    assert sorted(EXAMPLES) == sorted(addition.template for addition in ADDITIONS.values())
    for name, content in EXAMPLES.items():
        (tmp_path / name).write_text(content)
    return tmp_path


def completed(*command, folder, environment=None):
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment, timeout=1800)


@pytest.mark.parametrize("program", sweep([FLIGHT, FLIGHT + LANES], plain=[FLIGHT]), ids=["alone", "lanes"])
def test_the_examples_of_the_page_fly_together(written, program):
    result = completed(sys.executable, "-W", "error", "-c", program, folder=written)
    assert result.returncode == 0, result.stderr
    assert result.stdout.split() == ["flown"] * program.count("flown")


@pytest.mark.parametrize("name", ["force", "sensor", "reward", "vehicle"])
def test_the_command_that_shows_the_result_works(written, name):
    """The one of the task flies an episode and is left to the flight above, which makes the same task."""
    programs = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    result = completed("/bin/sh", "-c", ADDITIONS[name].result, folder=written, environment=programs)
    assert result.returncode == 0, result.stderr
    shown = {"force": "tether", "sensor": "altimeter_0", "reward": "reward/calm", "vehicle": "My vehicle"}
    assert shown[name] in result.stdout
