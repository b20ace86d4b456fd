"""Added mass by the panel method against closed forms: spheres, ellipsoids (Lamb), a hemisphere at the surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.solids import ellipsoid

from dq_marine.meshes.potential_flow import PotentialFlow, untold
from dq_marine.meshes.surface import enclosed
from dq_marine.meshes.waterline import wet_part
from dq_marine.vehicles.analysis.lamb import added_mass_coefficients

pytest.importorskip("capytaine", reason="needs the extra `bem`")

DENSITY = 1025.0
NOWHERE = np.zeros(3)


def unbounded(panels: np.ndarray, reference: np.ndarray = NOWHERE, density: float = DENSITY) -> np.ndarray:
    return PotentialFlow(panels, reference, density, 9.81, False, untold).added_mass()


def afloat(panels: np.ndarray) -> PotentialFlow:
    return PotentialFlow(panels, NOWHERE, DENSITY, 9.81, True, untold)


@pytest.mark.parametrize("axes", [(1.0, 1.0, 1.0), (2.0, 0.5, 0.5), (1.5, 1.0, 0.6)])
def test_ellipsoids_have_lambs_added_mass(axes: tuple[float, float, float]) -> None:
    """Relative to what the panels displace, so that the error is the method's; it falls as panels get smaller."""
    along, about = added_mass_coefficients(*axes)
    errors = []
    for splits in (2, 3):
        corners = ellipsoid(*axes, splits)
        solid, added = enclosed(corners), unbounded(corners)
        displaced = DENSITY * np.concatenate(
            [np.full(3, solid.volume), solid.volume * np.diag(solid.squared_gyration)]
        )
        errors.append(np.abs(added.diagonal() / displaced - np.concatenate([along, about])).max())
        assert np.abs(added - np.diag(added.diagonal())).max() < 1e-3 * added.max()
    assert errors[1] < 0.02
    assert errors[1] < 0.6 * errors[0]


def test_turning_the_hull_turns_its_added_mass() -> None:
    """By a right-handed rotation R of the mesh, A becomes R A R^T; so do moments and couplings."""
    corners = ellipsoid(1.5, 1.0, 0.6) + np.array([0.2, -0.3, 0.1])
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.array(
        [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
    )
    both = np.kron(np.eye(2), turn)
    added, turned = unbounded(corners), unbounded(corners @ turn.T)
    np.testing.assert_allclose(turned, both @ added @ both.T, atol=2e-5 * added.max())


def test_another_reference_point_moves_moments_as_rigid_bodies_do() -> None:
    corners, shift = ellipsoid(1.5, 1.0, 0.6), np.array([0.4, -0.2, 0.3])
    lever = np.array([[0, -shift[2], shift[1]], [shift[2], 0, -shift[0]], [-shift[1], shift[0], 0]])
    # The velocity at the old point is v + omega x (old - new), and old - new is -shift.
    change = np.block([[np.eye(3), lever], [np.zeros((3, 3)), np.eye(3)]])
    added, moved = unbounded(corners), unbounded(corners, shift)
    np.testing.assert_allclose(moved, change.T @ added @ change, atol=2e-5 * added.max())


def test_added_mass_is_proportional_to_the_density_and_to_powers_of_the_length() -> None:
    corners = ellipsoid(1.5, 1.0, 0.6)
    added = unbounded(corners)
    np.testing.assert_allclose(unbounded(corners, density=2.0 * DENSITY), 2.0 * added, rtol=1e-6)
    powers = np.add.outer([0, 0, 0, 1, 1, 1], [3, 3, 3, 4, 4, 4])
    np.testing.assert_allclose(
        unbounded(2.0 * corners), 2.0**powers * added, rtol=1e-5, atol=1e-5 * added.max()
    )


def test_a_hemisphere_at_infinite_frequency_heaves_with_half_its_water() -> None:
    """The surface is at rest at zero pressure: heave is that of the whole sphere, by symmetry; sway is 0.2732 of it."""
    wet = wet_part(ellipsoid(1.0, 1.0, 1.0, 4))
    displaced = DENSITY * 0.5 * enclosed(ellipsoid(1.0, 1.0, 1.0, 4)).volume
    added = afloat(wet).added_mass() / displaced
    assert added[2, 2] == pytest.approx(0.5, rel=0.01)
    assert added[0, 0] == pytest.approx(0.2732, rel=0.02)
    assert added[1, 1] == pytest.approx(added[0, 0], rel=1e-3)


@pytest.mark.slow
def test_a_hemisphere_radiates_as_hulme_computed() -> None:
    """Hulme (1982), J. Fluid Mech. 121, 443, table 2: in surge at K a = 1, added mass 0.5740 and damping 0.3535."""
    corners = ellipsoid(1.0, 1.0, 1.0, 3)
    wet, displaced = wet_part(corners), DENSITY * 0.5 * enclosed(corners).volume
    omega = math.sqrt(9.81)
    added, damping = afloat(wet).by_frequency([omega])
    assert added[0, 0, 0] / displaced == pytest.approx(0.5740, rel=0.03)
    assert damping[0, 0, 0] / (displaced * omega) == pytest.approx(0.3535, rel=0.05)
    assert damping[0, 1, 1] == pytest.approx(damping[0, 0, 0], rel=1e-3)
