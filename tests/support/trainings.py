"""Trainings with tiny networks, which end within a second."""

from __future__ import annotations

from pathlib import Path

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

PPO = """
name = "ppo"
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

SAC = """
name = "sac"
buffer_size = 2000
learning_starts = 50
batch_size = 16
tau = 0.01
train_freq = 1
gradient_steps = 1
ent_coef = "auto"
"""


def preset(tmp_path: Path, algorithm: str, timesteps: int = 256) -> Path:
    path = tmp_path / f"tiny_{algorithm}.toml"
    common = COMMON.format(timesteps=timesteps, normalise_reward=str(algorithm == "ppo").lower())
    path.write_text(common + {"ppo": PPO, "sac": SAC}[algorithm], encoding="utf-8")
    return path


def tiny(tmp_path: Path, algorithm: str, timesteps: int = 256) -> TrainingSettings:
    return read_settings(preset(tmp_path, algorithm, timesteps), TrainingSettings)
