"""Rotation vectors: against SciPy, at both ends of the angle, and on both sides of the small-angle branch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dq_marine.agents.controllers.rotation import SMALL_SINE, crossed, quaternion_from_matrix, rotation_vector

AXES = [*np.eye(3), np.array([1.0, -2.0, 3.0]) / math.sqrt(14.0)]


def test_random_rotations_as_scipy() -> None:
    for rotation in Rotation.random(200, rng=np.random.default_rng(0)):
        np.testing.assert_allclose(rotation_vector(rotation.as_matrix()), rotation.as_rotvec(), atol=1e-12)


@pytest.mark.parametrize("axis", AXES)
def test_half_turn(axis: np.ndarray) -> None:
    """At 180 degrees both signs of the axis are right."""
    vector = rotation_vector(Rotation.from_rotvec(math.pi * axis).as_matrix())
    assert np.linalg.norm(vector) == pytest.approx(math.pi, abs=1e-7)
    assert abs(vector @ axis) == pytest.approx(math.pi, abs=1e-7)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("short_of_pi", [1e-3, 1e-6])
def test_close_to_half_turn(axis: np.ndarray, short_of_pi: float) -> None:
    vector = (math.pi - short_of_pi) * axis
    np.testing.assert_allclose(
        rotation_vector(Rotation.from_rotvec(vector).as_matrix()), vector, atol=1e-9, rtol=0.0
    )


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize(
    "angle", [0.0, 0.5 * SMALL_SINE, 2.0 * SMALL_SINE * 0.999, 2.0 * SMALL_SINE * 1.001, 1e-4]
)
def test_small_angles(axis: np.ndarray, angle: float) -> None:
    vector = angle * axis
    np.testing.assert_allclose(
        rotation_vector(Rotation.from_rotvec(vector).as_matrix()), vector, rtol=1e-6, atol=1e-16
    )


@pytest.mark.parametrize("axis", AXES)
def test_quaternion_has_unit_length_and_no_negative_scalar(axis: np.ndarray) -> None:
    for angle in np.linspace(-math.pi, math.pi, 25):
        rotation = Rotation.from_rotvec(angle * axis)
        q = quaternion_from_matrix(rotation.as_matrix())
        assert q[0] >= 0.0
        assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
        np.testing.assert_allclose(
            Rotation.from_quat(q, scalar_first=True).as_matrix(), rotation.as_matrix(), atol=1e-12
        )


def test_vector_products_have_numpys_bits():
    pairs = np.random.default_rng(7).normal(scale=1e3, size=(200, 2, 3))
    for a, b in pairs:
        assert np.array_equal(crossed(a, b), np.cross(a, b))
    assert crossed((1, 0, 0), [0, 1, 0]).tolist() == [0.0, 0.0, 1.0]
