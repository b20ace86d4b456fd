"""Surfaces that are closed with their outside out: mended where that is possible, else refused."""

from __future__ import annotations

import numpy as np
import pytest
from support.solids import box, ellipsoid

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.repair import MOST_TRIANGLES, closed_surface, winding_numbers
from dq_marine.meshes.surface import enclosed, mirror_planes


def test_a_box_has_the_volume_centre_and_inertia_of_a_box() -> None:
    surface, turned = closed_surface(box(4.0, 2.0, 1.0) + np.array([1.0, 2.0, 3.0]), "box")
    solid = enclosed(surface.corners)
    assert (turned, len(surface.vertices), solid.volume) == (0, 8, pytest.approx(8.0, rel=1e-14))
    np.testing.assert_allclose(solid.center, [1.0, 2.0, 3.5], rtol=1e-13)
    expected = np.diag([2.0**2 + 1.0, 4.0**2 + 1.0, 4.0**2 + 2.0**2]) / 12.0
    np.testing.assert_allclose(solid.squared_gyration, expected, atol=1e-13)


@pytest.mark.parametrize("wrong", [range(12), [0], [3, 7, 8], range(1, 12)])
def test_triangles_that_are_inside_out_are_turned_back(wrong: list[int]) -> None:
    corners = box(4.0, 2.0, 1.0)
    corners[list(wrong)] = corners[list(wrong)][:, ::-1]
    surface, turned = closed_surface(corners, "box")
    assert turned == len(wrong)
    assert enclosed(surface.corners).volume == pytest.approx(8.0, rel=1e-14)


def test_two_hulls_are_one_vehicle_and_each_is_turned_by_itself() -> None:
    port, starboard = (
        box(4.0, 0.5, 1.0) + np.array([0.0, 1.0, 0.0]),
        box(4.0, 0.5, 1.0) - np.array([0.0, 1.0, 0.0]),
    )
    surface, turned = closed_surface(np.concatenate([port, starboard[:, ::-1]]), "catamaran")
    assert (turned, enclosed(surface.corners).volume) == (12, pytest.approx(4.0, rel=1e-14))
    assert mirror_planes(surface) == (True, True)


def test_mirror_images_are_noticed() -> None:
    for shift, planes in (([1e-3, 0.0, 0.0], (False, True)), ([0.0, 0.1, 5.0], (True, False))):
        assert mirror_planes(closed_surface(box(4.0, 2.0, 1.0) + shift, "box")[0]) == planes


def test_points_within_are_surrounded_once() -> None:
    sphere = ellipsoid(1.0, 1.0, 1.0)
    points = np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 0.5], [2.0, 0.0, 0.0]])
    np.testing.assert_allclose(winding_numbers(points, sphere), [1.0, 1.0, 0.0], atol=1e-12)


CUBE = box(1.0, 1.0, 1.0)
FLAT = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0], [1, 0, 0]]], dtype=np.float64)


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        (CUBE[1:], "not closed: 3 edges have a triangle on one side only"),
        (np.concatenate([CUBE, FLAT[:1] + 0.5]), "not closed"),
        (np.concatenate([CUBE, box(1.0, 1.0, 1.0) + np.array([1.0, 0.0, 0.0])]), "have more than two"),
        (np.concatenate([CUBE, 0.5 * CUBE + np.array([0.0, 0.0, 0.25])]), "one reaches into another"),
        (np.concatenate([CUBE, CUBE + np.array([0.5, 0.4, 0.3])]), "one reaches into another"),
        (FLAT, "encloses nothing"),
        (np.zeros((4, 3, 3)), "no triangle with an area"),
        (np.ones((MOST_TRIANGLES + 1, 3, 3)), "20,001 triangles, more than 20,000"),
    ],
)
def test_meshes_that_enclose_no_hull_are_refused(corners: np.ndarray, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        closed_surface(corners, "hull.stl")


def test_a_surface_without_an_outside_is_refused() -> None:
    """Six corners, each two of which share an edge: the projective plane, in which one cannot tell left from right."""
    rng = np.random.default_rng(0)
    points = rng.normal(size=(6, 3))
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)]
    faces += [(1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]
    with pytest.raises(InvalidInputError, match="has no outside"):
        closed_surface(points[np.array(faces)], "plane.stl")
