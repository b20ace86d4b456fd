"""An exported graph decides as Stable-Baselines3 does: `predict(deterministic=True)` behind `VecNormalize`."""

from __future__ import annotations

import io
from typing import Any

import gymnasium as gym
import numpy as np
import onnxruntime
import pytest
import torch
from sb3_contrib import TQC, CrossQ, RecurrentPPO
from stable_baselines3 import DQN, PPO, SAC, TD3
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize
from support.sweeps import sweep

from dq_marine.agents.deployment.description import METADATA_KEY
from dq_marine.agents.deployment.formats import onnx_bytes, torchscript_bytes
from dq_marine.agents.deployment.graph import PolicyGraph
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.training.symlog import SymlogNormalize
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.errors import InvalidInputError

ROUND_OFF = 1e-6
"""Of actions in [-1, 1] from single precision: some units in the last place of tanh, stretched over the space."""


def scattered(rng: np.random.Generator, size: int, count: int = 4000) -> np.ndarray:
    """Return observations from far within what normalisation passes to far beyond, shape (count, size)."""
    scales = np.exp(rng.uniform(-5.0, 8.0, (count, 1)))
    return (scales * rng.standard_normal((count, size))).astype(np.float32)


@pytest.mark.parametrize("algorithm", ["ppo", "sac"])
def test_actions_are_those_of_the_run(algorithm: str, request: pytest.FixtureRequest) -> None:
    made = request.getfixturevalue(algorithm)
    own, exported = TrainedPolicy(made.run), OnnxPolicy(made.onnx)
    observations = scattered(np.random.default_rng(0), own.model.observation_space.shape[0])
    normalised = own.normalisation.normalize_obs(observations)
    clip = own.normalisation.clip_obs
    assert 0.1 < (np.abs(normalised) == clip).any(axis=1).mean() < 0.9
    expected = own.act(observations)
    actions = exported.act(observations)
    assert actions.dtype == np.float32
    np.testing.assert_allclose(actions, expected, rtol=0.0, atol=ROUND_OFF)
    singles = np.array([exported.act(one) for one in observations[:500]])
    np.testing.assert_allclose(singles, actions[:500], rtol=0.0, atol=ROUND_OFF)

    extra = {METADATA_KEY: ""}
    with pytest.deprecated_call():  # of TorchScript, by torch itself
        traced = torch.jit.load(str(made.torchscript), _extra_files=extra)
    for count in (1, 7, 4000):
        np.testing.assert_allclose(
            traced(torch.as_tensor(observations[:count])).detach(), expected[:count], rtol=0.0, atol=ROUND_OFF
        )
    assert extra[METADATA_KEY].decode() == exported.description.model_dump_json()


class Somewhere(gym.Env[Any, Any]):
    """Observations of a space, and actions whose limits are neither 1 nor symmetric."""

    action_space = gym.spaces.Box(np.array([-1.0, -0.5], np.float32), np.array([1.0, 2.0], np.float32))

    def __init__(self, goals: bool) -> None:
        boxes = {
            name: gym.spaces.Box(-1e6, 1e6, (size,), np.float32)
            for name, size in (("observation", 5), ("achieved_goal", 3), ("desired_goal", 2))
        }
        self.observation_space = gym.spaces.Dict(boxes) if goals else boxes["observation"]

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        return self.observation_space.sample(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        return self.observation_space.sample(), 0.0, False, False, {}


GAINS = {PPO: 500.0, SAC: 60.0, TD3: 60.0, TQC: 60.0, CrossQ: 60.0}
KINDS = [(kind, gain, goals) for kind, gain in GAINS.items() for goals in (False, True)]
KINDS.remove((CrossQ, GAINS[CrossQ], True))  # which has no policy for goals


@pytest.mark.parametrize(
    ("normaliser", "normalised"),
    sweep(
        [(VecNormalize, False), (VecNormalize, True), (SymlogNormalize, True)],
        plain=[(SymlogNormalize, True)],
    ),
)
@pytest.mark.parametrize(
    ("kind", "gain", "goals"), sweep(KINDS, plain=[(PPO, 500.0, True), (SAC, 60.0, True)])
)
def test_goals_limits_and_raw_observations(
    normaliser: Any, normalised: bool, kind: Any, gain: float, goals: bool, ppo: Any
) -> None:
    rng = np.random.default_rng(1)
    envs = normaliser(DummyVecEnv([lambda: Somewhere(goals)]), norm_obs=normalised, clip_obs=5.0)
    policy = "MultiInputPolicy" if goals else "MlpPolicy"
    model = kind(policy, envs, seed=0, device="cpu", policy_kwargs={"net_arch": [64, 64]})
    last = model.policy.action_net if kind is PPO else model.policy.actor.mu
    last = last[-2] if kind is TD3 else last
    with torch.no_grad():  # an untrained network asks for little; here the limits are to be reached
        last.weight.mul_(gain)
    spaces = envs.observation_space.spaces if goals else {"observation": envs.observation_space}
    share = 0.02 if normalised else 0.002  # what a network is to be given as it comes is of order one
    inputs = {
        name: np.float32(share) * scattered(rng, space.shape[0], 1000) for name, space in spaces.items()
    }
    if normalised:
        running = envs.obs_rms if goals else {"observation": envs.obs_rms}
        for name, one in running.items():
            one.update(rng.normal(3.0, 20.0, (50, *spaces[name].shape)))
    given = envs.normalize_obs(inputs if goals else inputs["observation"])
    expected, _ = model.predict(given, deterministic=True)
    low, high = envs.action_space.low, envs.action_space.high
    at_limits = np.minimum(np.abs(expected - low), np.abs(expected - high)) < 1e-3
    assert 0.02 < at_limits.mean() < 0.98

    graph = PolicyGraph(model, envs)
    sizes = {name: space.shape[0] for name, space in spaces.items()}
    assert dict(zip(graph.input_names, graph.sizes, strict=True)) == sizes
    session = onnxruntime.InferenceSession(onnx_bytes(graph, OnnxPolicy(ppo.onnx).description))
    (actions,) = session.run(["action"], inputs)
    np.testing.assert_allclose(actions, expected, rtol=0.0, atol=5.0 * ROUND_OFF)
    assert (actions >= low).all()
    assert (actions <= high).all()


class Choosing(Somewhere):
    """Actions that are chosen from a list."""

    action_space = gym.spaces.Discrete(2)  # type: ignore[assignment]


def test_what_this_package_does_not_train_is_refused() -> None:
    envs = VecNormalize(DummyVecEnv([lambda: Choosing(False)]))
    with pytest.raises(InvalidInputError, match="DQNPolicy cannot be exported; export one of ppo, sac, td3"):
        PolicyGraph(DQN("MlpPolicy", envs, device="cpu", buffer_size=10), envs)


@pytest.mark.parametrize("goals", [False, True])
def test_what_remembers_is_given_its_memory_and_gives_it_back(goals: bool, ppo: Any) -> None:
    rng, count, steps = np.random.default_rng(2), 3, 40
    envs = SymlogNormalize(DummyVecEnv([lambda: Somewhere(goals)]), clip_obs=5.0)
    policy = "MultiInputLstmPolicy" if goals else "MlpLstmPolicy"
    network = {"net_arch": [16], "lstm_hidden_size": 8}
    model = RecurrentPPO(policy, envs, seed=0, device="cpu", policy_kwargs=network)
    with torch.no_grad():  # so that what is remembered counts, and limits are reached
        model.policy.action_net.weight.mul_(500.0)
        model.policy.lstm_actor.weight_hh_l0.mul_(3.0)
    spaces = envs.observation_space.spaces if goals else {"observation": envs.observation_space}
    graph = PolicyGraph(model, envs)
    assert graph.input_names == (*spaces, "memory")
    description = OnnxPolicy(ppo.onnx).description.model_copy(update={"memory": graph.memory_size})
    session = onnxruntime.InferenceSession(onnx_bytes(graph, description))
    with pytest.deprecated_call():
        traced = torch.jit.load(io.BytesIO(torchscript_bytes(graph, description)))
    state: Any = None
    memory = in_script = np.zeros((count, 16), np.float32)
    acted = []
    for step in range(steps):
        inputs = {name: scattered(rng, space.shape[0], count) for name, space in spaces.items()}
        given = envs.normalize_obs(inputs if goals else inputs["observation"])
        begun = np.full(count, step == 0)
        expected, state = model.predict(given, state=state, episode_start=begun, deterministic=True)
        actions, memory = session.run(["action", "new_memory"], {**inputs, "memory": memory})
        np.testing.assert_allclose(actions, expected, rtol=0.0, atol=20.0 * ROUND_OFF)
        with torch.no_grad():
            tensors = [torch.as_tensor(one) for one in (*inputs.values(), in_script)]
            scripted, in_script = (one.numpy() for one in traced(*tensors))
        np.testing.assert_allclose(scripted, expected, rtol=0.0, atol=20.0 * ROUND_OFF)
        forgotten = session.run(["action"], {**inputs, "memory": np.zeros_like(memory)})[0]
        acted.append(np.abs(forgotten - actions).max())
    assert np.max(acted[1:]) > 0.1  # so it does remember


@pytest.mark.parametrize("write", [onnx_bytes, torchscript_bytes])
def test_files_do_not_tell_of_the_machine_that_wrote_them(write: Any, ppo: Any) -> None:
    own = TrainedPolicy(ppo.run)
    content = write(PolicyGraph(own.model, own.normalisation), OnnxPolicy(ppo.onnx).description)
    for private in (b"site-packages", b"/graph.py", str(ppo.run.path).encode()):
        assert private not in content
