"""The trajectory of an episode, written as CSV or Parquet: a row for each instant, units in the names of columns."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dq_marine.agents.evaluation.metrics import Array
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed
from dq_marine.util.files import check_folder, replacing_file

ENDINGS = (".csv", ".parquet")

VECTOR_COLUMNS = {
    "position_ned": ("north_m", "east_m", "down_m"),
    "quaternion_body_to_ned": ("q_scalar", "q_x", "q_y", "q_z"),
    "velocity_body": ("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"),
}
"""Columns of a trajectory's vectors, as in the series of manoeuvres."""


@dataclass
class Track:
    """Where the vehicle was at each instant.

    Attributes:
        position_ned: of the body origin [m], shape (3,) each.
        quaternion_body_to_ned: scalar first, shape (4,) each.
        velocity_body: over ground, Fossen's order [m/s, rad/s], shape (6,) each.
    """

    position_ned: list[Array] = field(default_factory=list)
    quaternion_body_to_ned: list[Array] = field(default_factory=list)
    velocity_body: list[Array] = field(default_factory=list)

    def add(self, env: MarineEnv) -> None:
        """Keep where the vehicle is now."""
        self.position_ned.append(env.position_ned)
        self.quaternion_body_to_ned.append(env.quaternion_body_to_ned)
        self.velocity_body.append(env.velocity_body)

    def columns(self) -> dict[str, Array]:
        """Return the vectors' components and the Euler angles, the heading continuous, each of shape (n + 1,)."""
        vectors = {
            name: column
            for vector, names in VECTOR_COLUMNS.items()
            for name, column in zip(names, np.array(getattr(self, vector)).T, strict=True)
        }
        angles = np.array([attitude_angles(one.tolist()) for one in self.quaternion_body_to_ned])
        angles[:, 2] = np.unwrap(angles[:, 2])
        names = ("roll_deg", "pitch_deg", "heading_deg")
        return vectors | dict(zip(names, np.degrees(angles).T, strict=True))


def check_trajectory_path(path: Path) -> None:
    """Check that a trajectory can be written to a path.

    Raises:
        InvalidInputError: its ending is neither of `ENDINGS`, or its folder does not exist.
        MissingDependencyError: it ends in .parquet and pyarrow is not installed.
    """
    if path.suffix not in ENDINGS:
        raise InvalidInputError(
            f"{path} has no ending that trajectories have; give one of {', '.join(ENDINGS)}"
        )
    check_folder(path)
    if path.suffix == ".parquet":
        with extra_needed("writing Parquet", "parquet"):
            import pyarrow.parquet  # noqa: F401 - to say that it is missing before anything is flown


def made_folder(folder: Path) -> Path:
    """Return a folder for trajectories, made if need be.

    Raises:
        InvalidInputError: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(f"{folder} cannot be made: {error.strerror}; give another folder") from error
    return folder


def write_columns(columns: Mapping[str, Array], path: Path) -> None:
    """Write columns of one length as CSV or Parquet, by the path's ending; NaN is an empty field, or null.

    Numbers in a CSV file are read back bit for bit.

    Raises:
        InvalidInputError: see `check_trajectory_path`; or the file cannot be written.
        MissingDependencyError: see `check_trajectory_path`.
    """
    check_trajectory_path(path)
    if path.suffix == ".parquet":
        _write_parquet(columns, path)
        return
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    with replacing_file(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(["" if value != value else value for value in row] for row in rows)


def _write_parquet(columns: Mapping[str, Array], path: Path) -> None:
    with extra_needed("writing Parquet", "parquet"):
        import pyarrow
        from pyarrow import parquet
    arrays = {name: pyarrow.array(column, from_pandas=True) for name, column in columns.items()}
    with replacing_file(path) as temporary:
        parquet.write_table(pyarrow.table(arrays), temporary)
