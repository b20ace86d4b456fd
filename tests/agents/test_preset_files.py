"""Presets: the shipped ones are valid, and mistakes are named by file, field and value."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.trainings import ALGORITHMS

from dq_marine.agents.preset_files import PRESET_FOLDER, preset_names, read_environment, read_settings
from dq_marine.agents.settings import (
    AutopilotSettings,
    AvoidanceSettings,
    ControllerSettings,
    TrainingSettings,
)
from dq_marine.errors import InvalidInputError


def edited(tmp_path: Path, preset: str, old: str, new: str) -> Path:
    """A copy of a shipped preset with one thing changed."""
    text = (PRESET_FOLDER / f"{preset}.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


def test_shipped_presets_are_valid() -> None:
    assert preset_names() == [
        "Berthing",
        "DepthHeading",
        "Docking",
        "DynamicPositioning",
        "Encounter",
        "FormationKeeping",
        "ObstacleAvoidance",
        "PathFollowing",
        "PathFollowing_otter",
        "PipelineInspection",
        "Rendezvous",
        "StationKeeping",
        "TerrainFollowing",
        "TrajectoryTracking",
        "WaypointTracking",
        "autopilot",
        "autopilot_by_orders",
        "avoidance",
        "crossq",
        "dp_controller",
        "over_ground",
        "ppo",
        "recurrent_ppo",
        "sac",
        "td3",
        "tqc",
        "trajectory",
    ]
    read_settings("dp_controller", ControllerSettings)
    read_settings("autopilot", AutopilotSettings)
    read_settings("autopilot_by_orders", AutopilotSettings)
    read_settings("avoidance", AvoidanceSettings)
    for name in ALGORITHMS:
        assert read_settings(name, TrainingSettings).algorithm.name == name


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("gamma = 0.98", "gama = 0.98", r"mine\.toml.*\n(.*\n)*.*gama = 0\.98: unknown key"),
        ("gamma = 0.98", "", r"mine\.toml.*\n.*gamma: missing; add it"),
        ("gamma = 0.98", "gamma = 1.5", r"gamma = 1\.5: .*less than or equal to 1"),
        ("gamma = 0.98", 'gamma = "high"', r"gamma = 'high': .*number"),
        ("gamma = 0.98", "gamma = nan", r"gamma = nan: .*finite"),
        ("gamma = 0.98", "gamma = true", r"gamma = True: .*number"),
        ("n_epochs = 6", "n_epochs = true", r"n_epochs = True: .*integer"),
        ("observation = true", 'observation = "no"', r"observation = 'no': .*boolean"),
        ("[network]", "[networks]", r"network: missing(.*\n)*.*networks = .*unknown key"),
        ('name = "ppo"', 'name = "dqn"', r"algorithm = .*'dqn'.*'ppo'"),
        ("minibatches = 4", "minibatches = 5", r"minibatches = 5 does not cut .* = 4096 .*change one"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = edited(tmp_path, "ppo", old, new)
    with pytest.raises(InvalidInputError, match=message):
        read_settings(path, TrainingSettings)


def test_controller_mistakes_are_named(tmp_path: Path) -> None:
    path = edited(tmp_path, "dp_controller", "bandwidth = 2.0 ", "bandwidth = -2.0 ")
    with pytest.raises(
        InvalidInputError, match=r"mine\.toml.*\n.*position\.bandwidth = -2\.0: .*greater than 0"
    ):
        read_settings(path, ControllerSettings)


def test_a_preset_based_on_another_gives_only_what_differs(tmp_path: Path) -> None:
    (tmp_path / "middle.toml").write_text(
        'based_on = "ppo"\n[algorithm]\ngamma = 0.99\n[environment]\nid = "dq_marine/Docking-v0"\nkeywords = '
        '{level = "easy"}',
        encoding="utf-8",
    )
    mine = tmp_path / "mine.toml"
    mine.write_text(
        f'based_on = "{(tmp_path / "middle.toml").as_posix()}"\nenvs = 8\ntorch_threads = 2', encoding="utf-8"
    )
    shipped, derived = read_settings("ppo", TrainingSettings), read_settings(mine, TrainingSettings)
    assert derived.environment == read_environment(mine)
    assert (derived.environment.id, derived.environment.keywords) == (
        "dq_marine/Docking-v0",
        {"level": "easy"},
    )
    assert (derived.envs, derived.torch_threads, derived.algorithm.gamma) == (8, 2, 0.99)
    as_shipped = {"envs": 32, "torch_threads": 1, "environment": shipped.environment}
    assert (
        derived.model_copy(
            update={
                **as_shipped,
                "algorithm": derived.algorithm.model_copy(update={"gamma": 0.98}),
            }
        )
        == shipped
    )


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('based_on = "mine.toml"', r"mine\.toml: based_on = .* leads back to it"),
        ('based_on = "ddpg"', "no preset or file 'ddpg'"),
        ("based_on = 3", "based_on = 3; give the name of a preset or a file's path"),
    ],
)
def test_what_a_preset_cannot_be_based_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(line, encoding="utf-8")
    with pytest.raises(InvalidInputError, match=message):
        read_settings("mine.toml", TrainingSettings)


def test_what_is_no_preset(tmp_path: Path) -> None:
    with pytest.raises(
        InvalidInputError,
        match="no preset or file 'ddpg'; the presets are Berthing, DepthHeading, Docking, DynamicPositioning, "
        "Encounter, FormationKeeping, ObstacleAvoidance, PathFollowing, PathFollowing_otter, PipelineInspection, "
        "Rendezvous, StationKeeping, TerrainFollowing, TrajectoryTracking, WaypointTracking, autopilot, "
        "autopilot_by_orders, avoidance, crossq, dp_controller, over_ground, ppo, recurrent_ppo, sac, td3, tqc, "
        "trajectory",
    ):
        read_settings("ddpg", TrainingSettings)
    path = tmp_path / "mine.toml"
    path.write_text("gamma = = 1", encoding="utf-8")
    with pytest.raises(InvalidInputError, match=r"mine\.toml: not a TOML file"):
        read_settings(path, TrainingSettings)
