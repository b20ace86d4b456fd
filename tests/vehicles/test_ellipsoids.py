"""Ellipsoids as vehicles: closed forms of their mass matrices, options, refusals."""

import math

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import ellipsoid, spheroid

NEUTRAL_SPHEROID = (35.39387824, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877)


def test_the_neutral_spheroid_has_its_closed_form():
    vehicle = spheroid(0.5, 0.125)
    assert np.allclose(vehicle.mass_matrix, np.diag(NEUTRAL_SPHEROID), rtol=1e-8, atol=1e-14)
    assert Scene(vehicle).terms == ()


def test_a_sphere_carries_half_the_water_it_displaces():
    vehicle = spheroid(0.3, 0.3, mass=50.0, water_density=1025.0)
    displaced = 1025.0 * 4.0 / 3.0 * math.pi * 0.3**3
    inertia = 0.4 * 50.0 * 0.3**2
    expected = [50.0 + displaced / 2.0] * 3 + [inertia] * 3
    assert np.allclose(np.diag(vehicle.mass_matrix), expected, rtol=1e-12)
    assert vehicle.buoyant_force == pytest.approx(displaced * 9.81)


def test_a_triaxial_ellipsoid_has_the_tabulated_coefficients():
    vehicle = ellipsoid(0.3, 0.2, 0.1)
    displaced = 1000.0 * 4.0 / 3.0 * math.pi * 0.3 * 0.2 * 0.1
    along = np.diag(vehicle.added_mass)[:3] / displaced
    about = np.diag(vehicle.added_mass)[3:] / np.diag(vehicle.rigid_body.inertia)
    assert np.allclose(along, (0.185256, 0.364543, 1.361527), atol=1e-6)
    assert np.allclose(about, (0.383267, 0.708236, 0.059900), atol=1e-6)


def test_an_ellipsoid_of_revolution_is_the_spheroid():
    assert np.array_equal(ellipsoid(0.5, 0.2, 0.2).mass_matrix, spheroid(0.5, 0.2).mass_matrix)


def test_options_reach_the_model():
    damping = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    damping[0, 4] = 0.5
    vehicle = ellipsoid(
        0.5,
        0.2,
        0.1,
        center_of_mass=(0.0, 0.0, 0.01),
        linear_damping=damping,
        quadratic_damping=(1, 2, 3, 4, 5, 6),
        wrench_limits=(10, 0, 0, 0, 0, 1),
        name="Egg",
    )
    assert vehicle.name == "Egg"
    assert np.array_equal(vehicle.linear_damping, damping)
    assert np.array_equal(vehicle.quadratic_damping, np.arange(1.0, 7.0))
    assert np.array_equal(vehicle.wrench_limits, (10, 0, 0, 0, 0, 1))
    assert np.allclose(vehicle.restoring_arm, (0.0, 0.0, vehicle.weight * 0.01))
    assert np.array_equal(spheroid(1, 1, linear_damping=[1] * 6).linear_damping, np.eye(6))


def test_full_action_gives_unit_acceleration_unless_told():
    vehicle = ellipsoid(0.5, 0.2, 0.1)
    assert np.allclose(np.linalg.solve(vehicle.mass_matrix, vehicle.wrench_limits), 1.0)


def test_a_released_sphere_accelerates_with_its_added_mass():
    """By F/(m + m_A), not F/m."""
    displaced = 1000.0 * 4.0 / 3.0 * math.pi * 0.2**3
    vehicle = spheroid(0.2, 0.2, mass=0.5 * displaced)
    body = Scene(vehicle, step=0.01).stepper()
    body.step(steps=10)
    assert body.velocity_body[2] == pytest.approx(-0.1 * 9.81 * 0.5 / (0.5 + 0.5), rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "keywords", "message"),
    [
        ((0.0, 1.0, 1.0), {}, "a = 0 is not finite and above 0"),
        ((1.0, -1.0, 1.0), {}, "b = -1"),
        ((1.0, 1.0, "wide"), {}, "c = 'wide' is not numeric"),
        ((1.0, 1.0, 1.0), {"mass": -1.0}, "mass = -1"),
        ((1.0, 1.0, 1.0), {"mass": 1e9}, r"is refused:\n  rigid_body.mass = .*mean density"),
        ((1.0, 1.0, 1.0), {"water_density": math.nan}, "water_density = nan"),
        ((1.0, 1.0, 1.0), {"water_density": 1.0}, "no water has a density"),
        ((1.0, 1.0, 1.0), {"center_of_mass": (0.0, 1.0)}, r"center_of_mass has shape \(2,\)"),
        ((1.0, 1.0, 1.0), {"center_of_mass": (0.0, 0.0, 5.0)}, "center_of_mass"),
        ((1.0, 1.0, 1.0), {"linear_damping": [1.0, 2.0]}, r"linear_damping has shape \(2,\)"),
        ((1.0, 1.0, 1.0), {"linear_damping": "much"}, "linear_damping = 'much' is not numeric"),
        ((1.0, 1.0, 1.0), {"linear_damping": [-1.0] * 6}, "feeds energy in"),
        ((1.0, 1.0, 1.0), {"quadratic_damping": [-1.0] * 6}, "must not be negative"),
        ((1.0, 1.0, 1.0), {"wrench_limits": [0.0] * 6}, "no axis is actuated"),
        ((1.0, 1.0, 1e-4), {}, "added_mass"),
    ],
)
def test_impossible_ellipsoids_are_refused(arguments, keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        ellipsoid(*arguments, **keywords)


def test_an_impossible_spheroid_is_refused():
    with pytest.raises(InvalidInputError, match="b = inf"):
        spheroid(1.0, math.inf)
