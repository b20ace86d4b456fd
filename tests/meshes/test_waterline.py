"""Hydrostatics of hulls afloat against closed forms; cutting at the waterline; panels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.solids import box, ellipsoid

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.panels import MOST_PANELS, panels_of
from dq_marine.meshes.repair import closed_surface
from dq_marine.meshes.surface import area_vectors
from dq_marine.meshes.waterline import draft_of_mass, flotation, wet_part

DOWN = np.diag([1.0, -1.0, -1.0])
L, B, T = 10.0, 4.0, 1.0


def barge() -> np.ndarray:
    """A barge of 2 m height afloat at a draft of 1 m, its middle 3 m ahead of and 1 m to starboard of the origin."""
    return box(L, B, 2.0, keel=-T) @ DOWN.T + np.array([3.0, 1.0, 0.0])


def test_a_box_barge_has_the_hydrostatics_of_the_textbook() -> None:
    plane = flotation(wet_part(barge()))
    assert plane.volume == pytest.approx(L * B * T, rel=1e-13)
    np.testing.assert_allclose(plane.center, [3.0, 1.0, 0.5 * T], rtol=1e-13)
    assert plane.area == pytest.approx(L * B, rel=1e-13)
    np.testing.assert_allclose(plane.first_moments, [3.0 * L * B, L * B], rtol=1e-13)
    expected = np.array([[L**3 * B / 12 + 9 * L * B, 3 * L * B], [3 * L * B, L * B**3 / 12 + L * B]])
    np.testing.assert_allclose(plane.second_moments, expected, rtol=1e-13)


def test_the_stiffness_is_weight_times_metacentric_height() -> None:
    plane = flotation(wet_part(barge() - np.array([3.0, 1.0, 0.0])))
    specific, weight = 9810.0, 9810.0 * L * B * T
    stiffness = plane.stiffness(weight, np.array([0.0, 0.0, -0.3]), specific)
    above = -0.3 - 0.5 * T  # of the centre of mass, below that of buoyancy
    heights = B**2 / (12 * T) + above, L**2 / (12 * T) + above
    np.testing.assert_allclose(
        stiffness, np.diag([specific * L * B, *(weight * h for h in heights)]), atol=1e-6
    )


def test_heave_and_trim_are_coupled_as_the_moved_barge_shows() -> None:
    """The stiffness is the derivative of force and moment of buoyancy and weight, by differences."""
    specific = 9810.0
    center = np.array([3.0, 1.0, 0.2])
    plane = flotation(wet_part(barge()))
    weight = specific * plane.volume
    stiffness = plane.stiffness(weight, center, specific)

    def forces(heave: float, roll: float, pitch: float) -> np.ndarray:
        turn = np.array([[1.0, 0.0, pitch], [0.0, 1.0, -roll], [-pitch, roll, 1.0]])
        moved = flotation(wet_part(barge() @ turn.T + [0.0, 0.0, heave]))
        mass = turn @ center
        lift = -specific * moved.volume
        return np.array(
            [
                weight + lift,
                weight * mass[1] + lift * moved.center[1],
                -weight * mass[0] - lift * moved.center[0],
            ]
        )

    step = 1e-5
    for column, move in enumerate(np.eye(3) * step):
        slope = (forces(*move) - forces(*-move)) / (2 * step)
        np.testing.assert_allclose(-slope, stiffness[:, column], rtol=1e-4, atol=1e-4 * specific)


def test_half_a_sphere_tends_to_half_a_sphere() -> None:
    errors = []
    for splits in (2, 3, 4):
        plane = flotation(wet_part(ellipsoid(1.0, 1.0, 1.0, splits)))
        exact = np.array([2 / 3 * math.pi, 3 / 8, math.pi, math.pi / 4])
        found = np.array([plane.volume, plane.center[2], plane.area, plane.second_moments[0, 0]])
        errors.append(np.abs(found / exact - 1.0).max())
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (ratios > 3.5).all(), "the error falls with the square of the edges"
    assert errors[-1] < 0.02


def test_the_draft_is_that_of_the_mass() -> None:
    surface, _ = closed_surface(box(L, B, 2.0) @ DOWN.T, "barge")
    assert draft_of_mass(surface, 0.37 * L * B, "barge") == pytest.approx(0.37, rel=1e-12)
    with pytest.raises(InvalidInputError, match="cannot float: it encloses 80"):
        draft_of_mass(surface, 81.0, "barge")


def test_panels_are_many_and_even_and_the_same_surface() -> None:
    corners = wet_part(barge())
    panels = panels_of(corners, 500, "barge")
    assert 500 <= len(panels) <= MOST_PANELS
    areas = np.linalg.norm(area_vectors(panels), axis=1)
    assert areas.max() < 4.0 * areas.mean()
    assert areas.sum() == pytest.approx(np.linalg.norm(area_vectors(corners), axis=1).sum(), rel=1e-12)
    assert flotation(panels).volume == pytest.approx(L * B * T, rel=1e-12)


def test_too_many_panels_are_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"8,192 wet triangles, more than 5,000 panels"):
        panels_of(ellipsoid(1.0, 1.0, 1.0, 5), 100, "sphere")
