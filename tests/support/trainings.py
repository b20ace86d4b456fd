"""Trainings with tiny networks, which end within a second."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings

COMMON = """
timesteps = {timesteps}
envs = 2
torch_threads = 1
checkpoint_every = 64
[environment]
id = "dq_marine/StationKeeping-v0"
[environment.keywords]
start_radius = 1.0
max_episode_steps = 30
[network]
layers = [8]
activation = "tanh"
[normalisation]
observation = true
reward = {normalise_reward}
clip = 10.0
[evaluation]
every = 128
episodes = 2
[algorithm]
learning_rate = 1e-3
final_learning_rate = 1e-4
gamma = 0.98
"""

ROLLOUT = """
n_steps = 16
minibatches = 2
n_epochs = 2
gae_lambda = 0.95
clip_range = 0.2
ent_coef = 0.0
vf_coef = 0.5
max_grad_norm = 0.5
log_std_init = -0.5
"""

REPLAY = """
buffer_size = 2000
learning_starts = 50
batch_size = 16
train_freq = 1
gradient_steps = 1
"""

ALGORITHMS = {
    "ppo": ROLLOUT,
    "recurrent_ppo": ROLLOUT + "lstm_hidden_size = 8",
    "sac": REPLAY + 'tau = 0.01\nent_coef = "auto"',
    "td3": REPLAY + """
tau = 0.01
policy_delay = 2
target_policy_noise = 0.2
target_noise_clip = 0.5
exploration_noise = 0.1
""",
    "tqc": REPLAY + """
tau = 0.01
ent_coef = "auto"
n_quantiles = 5
n_critics = 2
top_quantiles_to_drop_per_net = 1
""",
    "crossq": REPLAY + 'ent_coef = "auto"\npolicy_delay = 3\nrenorm_warmup_steps = 20',
}  # fmt: skip

REMEMBERING = tuple(name for name, own in ALGORITHMS.items() if REPLAY in own)
"""Those with a replay buffer."""


def preset(tmp_path: Path, algorithm: str, timesteps: int = 256) -> Path:
    path = tmp_path / f"tiny_{algorithm}.toml"
    normalise = str(algorithm not in REMEMBERING).lower()
    common = COMMON.format(timesteps=timesteps, normalise_reward=normalise)
    path.write_text(f'{common}name = "{algorithm}"{ALGORITHMS[algorithm]}\n', encoding="utf-8")
    return path


def tiny(tmp_path: Path, algorithm: str, timesteps: int = 256) -> TrainingSettings:
    return read_settings(preset(tmp_path, algorithm, timesteps), TrainingSettings)


def parameters_of(model: Any) -> np.ndarray:
    """Return all numbers that a model's policy has learned, one after the other."""
    from torch.nn.utils import parameters_to_vector  # here: tests of settings need no torch

    return parameters_to_vector(model.policy.parameters()).detach().numpy()
