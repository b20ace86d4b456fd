"""A network that reads numbered things alike: their numbers do not count, and it trains and exports as any other."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from pydantic import ValidationError
from rich.console import Console
from support.sweeps import sweep
from support.trainings import ALGORITHMS, tiny

from dq_marine.agents.deployment.export import export_policy
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import EnvironmentSettings, NetworkSettings, TrainingSettings
from dq_marine.agents.training.learners import environments_of, make_model
from dq_marine.agents.training.numbered_things import things_of
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.set_extractor import SetExtractor
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training
from dq_marine.agents.tuning.tuning import plan_of
from dq_marine.envs.core.definition import Observed
from dq_marine.errors import InvalidInputError

READING = NetworkSettings(layers=(8,), activation="tanh", set_layers=(6, 5))


def observed(*names_and_sizes: tuple[str, int]) -> list[Observed]:
    return [Observed(name, "m", size, 1.0, "something") for name, size in names_and_sizes]


def encounters(tmp_path: Path, algorithm: str = "ppo") -> TrainingSettings:
    where = EnvironmentSettings(id="dq_marine/Encounter-v0", keywords={"max_episode_steps": 30})
    return tiny(tmp_path, algorithm, 64).model_copy(update={"environment": where, "network": READING})


def test_things_are_found_by_the_numbers_in_their_names() -> None:
    shown = observed(
        ("to_go", 1),
        ("ship_1_place", 2),
        ("ship_2_place", 2),
        ("buoy_1_x", 1),
        ("ship_1_on", 1),
        ("ship_2_on", 1),
    )
    alone, kinds = things_of(shown)
    assert alone == [0, 5], "a single thing of a kind is read as it is"
    assert kinds == [[[1, 2, 6], [3, 4, 7]]]


def test_every_number_of_an_encounter_is_read_once() -> None:
    env = marine(gym.make("dq_marine/Encounter-v0"))
    alone, (vessels,) = things_of(env.observations)
    assert len(vessels) == 3
    assert sorted([*alone, *(place for one in vessels for place in one)]) == list(
        range(*env.observation_space.shape)
    )
    env.close()


def test_exchanging_things_changes_nothing() -> None:
    space, rng = gym.spaces.Box(-1.0, 1.0, (11,), np.float32), np.random.default_rng(0)
    vessels = [[2, 3, 8], [4, 5, 9], [6, 7, 10]]
    reader = SetExtractor(space, [0, 1], [vessels], (6, 5), torch.nn.Tanh)
    assert reader.features_dim == 2 + 2 * 5
    seen = rng.uniform(-1.0, 1.0, (40, 11)).astype(np.float32)
    exchanged, other = seen.copy(), seen.copy()
    exchanged[:, [*vessels[0], *vessels[1]]] = seen[:, [*vessels[1], *vessels[0]]]
    other[:, vessels[2]] += 0.5
    read = [reader(torch.as_tensor(one)).detach().numpy() for one in (seen, exchanged, other)]
    np.testing.assert_allclose(read[1], read[0], rtol=0.0, atol=1e-6)
    assert np.abs(read[2] - read[0])[:, 2:].max(axis=1).min() > 1e-3
    np.testing.assert_array_equal(read[0][:, :2], seen[:, :2])


@pytest.mark.parametrize("algorithm", sweep(list(ALGORITHMS), plain=["ppo", "sac"]))
def test_it_trains_and_what_is_exported_does_the_same(algorithm: str, tmp_path: Path) -> None:
    run = RunFolder(tmp_path / "run")
    begin_training(run, encounters(tmp_path, algorithm), seed=1, console=Console(file=io.StringIO()))
    exported = export_policy(run, [tmp_path / "policy.onnx"], episodes=1, seed=5)
    own, flown = TrainedPolicy(run), OnnxPolicy(exported.files[0])
    env: Any = gym.make("dq_marine/Encounter-v0", max_episode_steps=30)
    observation, _ = env.reset(seed=2)
    for agent in (own, flown):
        agent.reset(env)
    for _ in range(30):
        action = own.act(observation)
        np.testing.assert_allclose(flown.act(observation), action, rtol=0.0, atol=1e-5)
        observation, *_ = env.step(action)
    env.close()


def test_actor_and_critic_read_apart(tmp_path: Path) -> None:
    model = make_model(encounters(tmp_path), 0, tmp_path)
    assert isinstance(model.policy.pi_features_extractor, SetExtractor)
    assert model.policy.vf_features_extractor is not model.policy.pi_features_extractor
    environments_of(model).close()


def test_what_shows_nothing_numbered_is_refused(tmp_path: Path) -> None:
    settings = tiny(tmp_path, "ppo", 64).model_copy(update={"network": READING})
    with pytest.raises(InvalidInputError, match=r"network\.set_layers.*shows none; leave set_layers out"):
        make_model(settings, 0, tmp_path)


def test_it_is_refused_before_anything_is_written_or_replaced(tmp_path: Path) -> None:
    folder, console = RunFolder(tmp_path / "run"), Console(file=io.StringIO())
    settings = tiny(tmp_path, "ppo", 64)
    begin_training(folder, settings, seed=1, console=console)
    before = {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()}
    reading = settings.model_copy(update={"network": READING})
    with pytest.raises(InvalidInputError, match=r"network\.set_layers.*shows none; leave set_layers out"):
        begin_training(folder, reading, force=True, console=console)
    assert {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()} == before
    with pytest.raises(InvalidInputError, match=r"network\.set_layers.*shows none; leave set_layers out"):
        begin_training(RunFolder(tmp_path / "other"), reading, console=console)
    assert not (tmp_path / "other").exists()
    with pytest.raises(InvalidInputError, match=r"network\.set_layers.*shows none; leave set_layers out"):
        plan_of(reading, seed=0)


def test_things_that_are_shown_differently_are_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"each ship alike, and 1, 2 are shown differently"):
        things_of(observed(("ship_1_place", 2), ("ship_2_course", 2)))


def test_observations_of_parts_are_refused(tmp_path: Path) -> None:
    space = gym.spaces.Dict({"observation": gym.spaces.Box(-1.0, 1.0, (4,))})
    with pytest.raises(
        InvalidInputError, match=r"set_layers read observations of one part.*leave set_layers out"
    ):
        SetExtractor(space, [0], [[[1, 2], [3]]], (5,), torch.nn.Tanh)
    with pytest.raises(ValidationError, match=r"privileged_critic = .*leave one of them out"):
        TrainingSettings(**{**dict(encounters(tmp_path)), "privileged_critic": ("current",)})
