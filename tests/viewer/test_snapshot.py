"""Snapshots and shapes take copies, and refuse what cannot be drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from viewer.samples import ROV, snapshot

from dq_marine.errors import InvalidInputError
from dq_marine.task.things import Beam
from dq_marine.viewer.snapshot import Shape, Thrust, Thruster


def test_arrays_are_read_only_copies() -> None:
    position = np.array([1.0, 2.0, 3.0])
    taken = snapshot(position_ned=position)
    position[0] = 99.0
    assert taken.position_ned.tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match="read-only"):
        taken.position_ned[0] = 99.0


def test_single_precision_and_lists_become_doubles() -> None:
    taken = snapshot(current_ned=np.array([0.5, 0.0, 0.0], dtype=np.float32), wrench_body=[1] * 6)
    assert taken.current_ned.dtype == taken.wrench_body.dtype == np.float64


@pytest.mark.parametrize(
    ("field", "value", "complaint"),
    [
        ("time", float("nan"), "time is nan"),
        ("position_ned", [0.0, 1.0], "position_ned has shape"),
        ("position_ned", None, "position_ned"),
        ("position_ned", [0.0, 1.0, float("inf")], "position_ned.*finite"),
        ("wrench_body", [float("nan")] * 6, "wrench_body.*finite"),
        ("quaternion_body_to_ned", [1.0, 0.1, 0.0, 0.0], "quaternion_body_to_ned.*unit"),
        ("goal_position_ned", [0.0, float("nan"), 0.0], "goal_position_ned.*finite"),
        ("goal_quaternion_body_to_ned", [0.0] * 4, "goal_quaternion_body_to_ned.*unit"),
        ("wind_ned", [1.0, 2.0], "wind_ned has shape"),
        ("thrusts", ([1.0, 0.0, 0.0],), r"thrusts\[0\] is"),
        ("beams", ([1.0, 0.0, 0.0],), r"beams\[0\] is"),
        ("beams", (Beam((1.0, 0.1, 0.0), 1.0, 2.0),), r"beams\[0\].direction_body has length 1.00499"),
        ("beams", (Beam((1.0, 0.0, 0.0), 2.1, 2.0),), r"beams\[0\].distance = 2.1"),
        ("beams", (Beam((1.0, 0.0, 0.0), float("nan"), 2.0),), r"beams\[0\].distance"),
        ("beams", (Beam((1.0, 0.0, 0.0), 0.0, 0.0),), r"beams\[0\].reach"),
    ],
)
def test_bad_snapshots_are_refused(field: str, value: Any, complaint: str) -> None:
    with pytest.raises(InvalidInputError, match=complaint):
        snapshot(**{field: value})


@pytest.mark.parametrize("field", ["length", "width", "height", "max_force", "max_thrust"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_sizes_must_be_positive(field: str, value: float) -> None:
    sizes = {"length": 1.0, "width": 1.0, "height": 1.0, "max_force": 1.0, field: value}
    with pytest.raises(InvalidInputError, match=f"shape {field} is"):
        Shape(**sizes)


def test_unknown_kind_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="open_frame, torpedo, ellipsoid"):
        Shape(1.0, 1.0, 1.0, kind="glider")  # type: ignore[arg-type]


def test_a_thrust_needs_finite_vectors() -> None:
    with pytest.raises(InvalidInputError, match=r"force_body.*finite"):
        Thrust(np.zeros(3), np.array([0.0, float("nan"), 0.0]))


def test_thruster_needs_a_direction() -> None:
    with pytest.raises(InvalidInputError, match="direction"):
        Thruster(np.zeros(3), np.zeros(3))


def test_size_is_the_largest_dimension() -> None:
    assert ROV.size == 0.457
    assert Shape(1.0, 3.0, 2.0).size == 3.0
