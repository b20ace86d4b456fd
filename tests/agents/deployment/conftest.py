"""Tiny runs of some algorithms, each exported in both formats with its card."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import pytest
from rich.console import Console
from support.trainings import tiny

from dq_marine.agents.deployment.export import Exported, export_policy
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training

EPISODES, SEED = 2, 5


@dataclass(frozen=True)
class Trained:
    """A run, and what was exported from it: policy.onnx, policy.pt and README.md."""

    run: RunFolder
    exported: Exported

    @property
    def onnx(self) -> Path:
        return self.exported.files[0]

    @property
    def torchscript(self) -> Path:
        return self.exported.files[1]

    @property
    def card(self) -> Path:
        return self.exported.files[2]


@pytest.fixture(scope="session")
def ppo(tmp_path_factory: pytest.TempPathFactory) -> Trained:
    return _trained("ppo", tmp_path_factory.mktemp("ppo"))


@pytest.fixture(scope="session")
def sac(tmp_path_factory: pytest.TempPathFactory) -> Trained:
    return _trained("sac", tmp_path_factory.mktemp("sac"))


@pytest.fixture(scope="session")
def recurrent_ppo(tmp_path_factory: pytest.TempPathFactory) -> Trained:
    return _trained("recurrent_ppo", tmp_path_factory.mktemp("recurrent_ppo"))


def _trained(algorithm: str, folder: Path) -> Trained:
    run = RunFolder(folder / algorithm)
    begin_training(run, tiny(folder, algorithm, 128), seed=1, console=Console(file=io.StringIO()))
    targets = [folder / "station" / f"policy{ending}" for ending in (".onnx", ".pt")]
    return Trained(run, export_policy(run, targets, episodes=EPISODES, seed=SEED))
