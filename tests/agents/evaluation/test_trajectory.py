"""Trajectories: what is in the columns, and that CSV and Parquet hold the same numbers."""

from __future__ import annotations

import csv
import math
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, marine
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.trajectory import write_columns
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.vehicles import Vehicle, load_vehicle

NAMES = [
    *("time_s", "north_m", "east_m", "down_m", "q_scalar", "q_x", "q_y", "q_z"),
    *("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s", "roll_deg", "pitch_deg", "heading_deg"),
    *(f"action_{axis}" for axis in ("surge", "sway", "heave", "roll", "pitch", "yaw")),
    *("reward", "position_error_m", "attitude_error_deg"),
]


@pytest.fixture(scope="module")
def episode() -> Episode:
    env = make_environment(DEFAULT_ENVIRONMENT, max_episode_steps=12)
    return fly_episode(env, make_baseline("random", env, seed=3), seed=5, track=True)


def test_columns_are_what_was_flown(episode: Episode) -> None:
    columns = episode.columns()
    assert [name for name in columns if not name.startswith("reward/")] == NAMES
    assert {len(column) for column in columns.values()} == {13}
    env = make_environment(DEFAULT_ENVIRONMENT, max_episode_steps=12)
    _, info = env.reset(seed=5)
    inner = marine(env)
    for index in range(12):
        place = [columns[name][index] for name in ("north_m", "east_m", "down_m")]
        np.testing.assert_array_equal(place, inner.position_ned)
        assert columns["q_x"][index] == inner.quaternion_body_to_ned[1]
        assert columns["r_rad_s"][index] == inner.velocity_body[5]
        assert columns["position_error_m"][index] == info["position_error"]
        assert columns["attitude_error_deg"][index] == math.degrees(info["attitude_error"])
        _, reward, _, _, info = env.step(episode.actions[index].astype(np.float32))
        assert columns["reward"][index] == reward
        assert columns["action_yaw"][index] == episode.actions[index, 5]


def test_what_belongs_to_periods_is_missing_at_the_last_instant(episode: Episode) -> None:
    columns = episode.columns()
    for name, column in columns.items():
        period = name.startswith(("action_", "reward"))
        assert np.isnan(column[-1]) == period, name
        assert np.isfinite(column[:-1]).all()


def test_angles_are_those_of_the_attitude() -> None:
    for angles in ((0.1, -0.2, 3.0), (-2.0, 1.2, -0.5), (0.0, 0.0, 0.0)):
        np.testing.assert_allclose(attitude_angles(quaternion_from_euler(*angles)), angles, atol=1e-12)


def test_csv_is_read_back_bit_for_bit(episode: Episode, tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    write_columns(episode.columns(), path)
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for name, column in episode.columns().items():
        read = [float(row[name]) if row[name] else math.nan for row in rows]
        np.testing.assert_array_equal(read, column)
    assert rows[-1]["reward"] == ""


def test_parquet_holds_the_same(episode: Episode, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "flight.parquet"
    write_columns(episode.columns(), path)
    table = parquet.read_table(path)
    assert table.column_names == list(episode.columns())
    for name, column in episode.columns().items():
        np.testing.assert_array_equal(table[name].to_numpy(), column)
    assert table["reward"].null_count == 1
    assert table["time_s"].null_count == 0


def test_wrong_paths_are_refused(episode: Episode, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    columns = episode.columns()
    with pytest.raises(InvalidInputError, match=r"\.csv, \.parquet"):
        write_columns(columns, tmp_path / "flight.xlsx")
    with pytest.raises(InvalidInputError, match="does not exist"):
        write_columns(columns, tmp_path / "no" / "flight.csv")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(MissingDependencyError, match=r'pip install "dq-marine\[parquet\]"'):
        write_columns(columns, tmp_path / "flight.parquet")
    assert not list(tmp_path.iterdir())


def test_a_flight_that_leaves_what_the_vehicles_numbers_hold_for_says_so() -> None:
    content = load_vehicle("bluerov2_heavy").model_dump()
    slow = Vehicle.model_validate(content | {"validity": {"speed": 0.01, "source": "a towing tank"}})
    env = gym.make(DEFAULT_ENVIRONMENT.id, vehicle=slow, max_episode_steps=12)
    (note,) = fly_episode(env, make_baseline("random", env, seed=3), seed=5).notes
    assert "its numbers hold up to 0.01 m/s (a towing tank)" in note
