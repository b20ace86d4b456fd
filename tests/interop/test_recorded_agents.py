"""What agents fly is read back from Minari's datasets, and flown again from them, step by step."""

import sys
from pathlib import Path

import numpy as np
import pytest
from support.command_line import assert_refused, run
from support.minari_child import needs_minari, printed_by

from dq_marine.agents.controllers.baselines import ZeroAgent
from dq_marine.agents.datasets.recorded_agents import Disturbed, record_agents
from dq_marine.errors import InvalidInputError

FLOWN = """
import os
import sys
from pathlib import Path

os.chdir(sys.argv[1])
import minari
import numpy as np

from dq_marine.agents import make_baseline, make_environment
from dq_marine.agents.datasets.dataset_folder import DatasetFolder
from dq_marine.agents.datasets.recorded_agents import record_agents
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords

env = make_environment(with_keywords(DEFAULT_ENVIRONMENT, current=0.2, max_episode_steps=6))
agents = {name: make_baseline(name, env, 0) for name in ("controller", "zero")}


class Interrupted(Exception):
    pass


def interrupt(name, episode):
    if episode.seed == 8:
        raise Interrupted


folder = Path("flights")
with DatasetFolder(folder) as datasets:
    scores = record_agents(env, agents, datasets, episodes=2, seed=7, noise=0.2)
    assert [(score.agent, score.episodes) for score in scores] == [("controller", 2), ("zero", 2)]
    try:
        record_agents(env, {"zero": agents["zero"]}, datasets, episodes=5, seed=7, after_episode=interrupt)
    except Interrupted:
        pass
names = ["controller-v0", "zero-v0", "zero-v1"]
assert datasets.written == {f"dq_marine/StationKeeping/BlueROV2-Heavy/{name}": 2 for name in names}
assert not [one for one in folder.iterdir() if one.name.startswith(".")]

os.environ["MINARI_DATASETS_PATH"] = str(folder)
for name in datasets.written:
    for seed, episode in zip((7, 8), minari.load_dataset(name).iterate_episodes(), strict=True):
        observation, _ = env.reset(seed=seed)
        np.testing.assert_array_equal(observation, episode.observations[0])
        for step, action in enumerate(episode.actions):
            observation, reward, *_ = env.step(action)
            np.testing.assert_array_equal(observation, episode.observations[step + 1])
            assert reward == episode.rewards[step]
        moved = np.abs(episode.actions).max()
        assert moved == 0.0 if name.endswith("zero-v1") else 0.0 < moved <= 1.0
print("flown again")
"""


@needs_minari
def test_what_is_recorded_into_a_relative_folder_flies_again_to_the_last_bit(tmp_path: Path) -> None:
    assert "flown again" in printed_by(FLOWN, str(tmp_path), datasets=str(tmp_path))


def test_noise_is_drawn_anew_in_each_period_and_alike_for_one_seed() -> None:
    first, second, other = (Disturbed(ZeroAgent(4), 0.3, seed) for seed in (5, 5, 6))
    flown = np.array([first.act(np.zeros(3)) for _ in range(500)])
    np.testing.assert_array_equal(flown, [second.act(np.zeros(3)) for _ in range(500)])
    assert not np.array_equal(flown[0], other.act(np.zeros(3)))
    assert flown.std() == pytest.approx(0.3, rel=0.1)
    assert np.abs(flown.mean(axis=0)).max() < 0.1


@pytest.mark.parametrize("noise", [-0.1, float("nan")])
def test_noise_that_is_none_is_refused_before_anything_is_flown(noise: float) -> None:
    with pytest.raises(InvalidInputError, match="noise"):
        record_agents(None, {"zero": None}, None, episodes=1, seed=0, noise=noise)


COMMAND = """
import sys

from dq_marine.cli.main import app

app(["record", sys.argv[1], "--set", "max_episode_steps=5", "--episodes", "2", "--noise", "0.1", *sys.argv[2:]])
"""


@needs_minari
def test_the_command_says_what_it_wrote_and_how_it_is_found(tmp_path: Path) -> None:
    folder = tmp_path / "flights"
    said = printed_by(COMMAND, str(folder), "--agent", "zero", "--agent", "random", datasets=str(tmp_path))
    for name in ("zero", "random"):
        identifier = f"dq_marine/StationKeeping/BlueROV2-Heavy/{name}-v0"
        assert f"Wrote {folder}: dataset {identifier}, episodes: 2" in said
        assert f'With MINARI_DATASETS_PATH={folder}, minari.load_dataset("{identifier}") finds it.' in said
        assert (folder / identifier).is_dir()


def test_the_command_names_the_extra_that_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "minari", None)
    assert_refused(run("record", tmp_path / "flights"), r"needs 'minari'.*dq-marine\[interop\]")
    assert not (tmp_path / "flights").exists()


def test_the_command_refuses_noise_without_end_before_it_makes_a_folder(tmp_path: Path) -> None:
    assert_refused(run("record", tmp_path / "flights", "--noise", "inf"), "--noise = inf is not finite")
    assert not (tmp_path / "flights").exists()
