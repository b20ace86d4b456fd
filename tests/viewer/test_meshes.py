"""Meshes are closed, have the right size, and face outwards; placements move them rightly."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from dq_marine.viewer import meshes
from dq_marine.viewer.meshes import Mesh
from dq_marine.viewer.placement import Placement, rotation_between

SQUARE_RING = [(1.0, -0.5), (2.0, -0.5), (2.0, 0.5), (1.0, 0.5), (1.0, -0.5)]

SOLIDS = {
    "cuboid": (meshes.cuboid(1.0, 2.0, 3.0), 6.0, 1e-12),
    "cylinder": (meshes.cylinder(1.0, 2.0), 2 * math.pi, 0.03),
    "cone": (meshes.cylinder(1.0, 3.0, top_radius=0.0), math.pi, 0.03),
    "sphere": (meshes.sphere(2.0), 4 / 3 * math.pi * 8, 0.04),
    "tetrahedron": (meshes.tetrahedron(2.0), 8 / (9 * math.sqrt(3)) * 2.0**3, 1e-12),
    "ring": (meshes.revolved(SQUARE_RING), 3 * math.pi, 0.03),
    "ellipsoid": (meshes.rounded_block(2.0, 4.0, 6.0, roundness=1.0), 8 * math.pi, 0.04),
    "plate": (meshes.plate([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)], 0.1), 0.2, 1e-12),
}


def _corners(mesh: Mesh) -> np.ndarray:
    """The corners of all triangles that are not degenerate, shape (m, 3, 3)."""
    corners = mesh.vertices[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return corners[area > 1e-9]


@pytest.mark.parametrize("name", SOLIDS)
def test_enclosed_volume(name: str) -> None:
    mesh, volume, tolerance = SOLIDS[name]
    a, b, c = _corners(mesh).transpose(1, 0, 2)
    # Divergence theorem: wrong way round, the volume would be negative; not closed, it would depend on the origin.
    for origin in (np.zeros(3), np.array([5.0, -3.0, 2.0])):
        enclosed = np.sum((a - origin) * np.cross(b - origin, c - origin)) / 6
        assert enclosed == pytest.approx(volume, rel=tolerance)


@pytest.mark.parametrize("name", SOLIDS)
def test_normals_point_outwards(name: str) -> None:
    mesh = SOLIDS[name][0]
    assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-12)
    corners = mesh.vertices[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(across, axis=1)
    mean_normal = mesh.normals[mesh.triangles].mean(axis=1)
    agreement = np.sum(across * mean_normal, axis=1)[area > 1e-9] / area[area > 1e-9]
    assert agreement.min() > 0.8


def test_sphere_and_its_normals() -> None:
    ball = meshes.sphere(2.0)
    assert_allclose(np.linalg.norm(ball.vertices, axis=1), 2.0)
    along = np.sum(ball.normals * ball.vertices, axis=1) / 2.0
    assert along.min() > 0.99


def test_joined_meshes_keep_their_triangles() -> None:
    first, second = meshes.cuboid(1.0, 1.0, 1.0), meshes.sphere(1.0)
    both = meshes.joined([first, second])
    assert_allclose(
        both.vertices[both.triangles],
        np.concatenate([first.vertices[first.triangles], second.vertices[second.triangles]]),
    )


def test_placed_mesh() -> None:
    quarter_about_z = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    moved = meshes.cuboid(4.0, 2.0, 6.0).placed(Placement((10.0, 20.0, 30.0), quarter_about_z, 0.5))
    assert_allclose(moved.vertices.min(axis=0), [9.5, 19.0, 28.5])
    assert_allclose(moved.vertices.max(axis=0), [10.5, 21.0, 31.5])


def test_matrix_agrees_with_scipy() -> None:
    w, x, y, z = quaternion = (0.5, -0.1, 0.7, math.sqrt(1 - 0.25 - 0.01 - 0.49))
    matrix = np.array(Placement((1.0, 2.0, 3.0), quaternion, 2.0).matrix_by_columns()).reshape(4, 4).T
    assert_allclose(matrix[:3, :3], 2.0 * Rotation.from_quat([x, y, z, w]).as_matrix(), atol=1e-15)
    assert_allclose(matrix[:, 3], [1.0, 2.0, 3.0, 1.0])
    assert_allclose(matrix[3], [0.0, 0.0, 0.0, 1.0])


@pytest.mark.parametrize("seed", range(20))
def test_rotation_between_random_directions(seed: int) -> None:
    start, end = np.random.default_rng(seed).normal(size=(2, 3))
    turn = Placement(quaternion=rotation_between(tuple(start), tuple(end))).rotation_matrix()
    assert_allclose(turn @ start / np.linalg.norm(start), end / np.linalg.norm(end), atol=1e-12)


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, -3.0), (1.0, 1.0, 0.1)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rotation_between_parallel_directions(axis: tuple[float, float, float], sign: float) -> None:
    start = np.array(axis)
    turn = Placement(quaternion=rotation_between(axis, tuple(sign * start))).rotation_matrix()
    assert_allclose(turn @ start, sign * start, atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1.0)
