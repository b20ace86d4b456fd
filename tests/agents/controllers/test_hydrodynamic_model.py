"""A controller's model of a vehicle: Fossen's equations, written separately, and their derivatives by differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.fossen import coriolis

from dq_marine.agents.controllers.deviation import deviation_model, reference_wrench, sampled
from dq_marine.agents.controllers.hydrodynamic_model import HydrodynamicModel
from dq_marine.vehicles import load_vehicle

VEHICLES = ["bluerov2", "bluerov2_heavy", "rexrov"]
PERIOD = 0.1


def velocities(count):
    return np.random.default_rng(3).uniform(-1.0, 1.0, (count, 6))


@pytest.mark.parametrize("name", VEHICLES)
def test_the_wrench_is_that_of_fossens_equations(name):
    vehicle = load_vehicle(name)
    model = HydrodynamicModel(vehicle)
    for nu in velocities(5):
        drag = vehicle.linear_damping @ nu + vehicle.quadratic_damping * abs(nu) * nu
        for one in vehicle.damping.couplings:
            force, velocity, speed = one.indices
            magnitude = nu[speed] if one.signed else abs(nu[speed])
            drag[force] += one.coefficient * magnitude * nu[velocity]
        expected = -coriolis(vehicle.mass_matrix, nu) @ nu - drag
        np.testing.assert_allclose(model.wrench(nu), expected, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("name", VEHICLES)
def test_derivatives_are_those_of_differences(name):
    model = HydrodynamicModel(load_vehicle(name))
    at, step = velocities(4), 1e-6
    exact = model.jacobian(at)
    for axis, change in enumerate(step * np.eye(6)):
        slope = (model.wrench(at + change) - model.wrench(at - change)) / (2.0 * step)
        np.testing.assert_allclose(exact[..., axis], slope, rtol=1e-6, atol=1e-5)
    for axis, change in enumerate(step * np.eye(3)):
        ways = (Rotation.from_rotvec(sign * change).inv().apply((0.0, 0.0, 1.0)) for sign in (1.0, -1.0))
        up, down = (model.restoring(way) for way in ways)
        np.testing.assert_allclose(
            model.restoring_jacobian[:, axis], (up - down) / (2.0 * step), rtol=1e-6, atol=1e-5
        )


class Pursuit:
    """A vehicle beside a level reference whose velocity in its own, turning axes is constant; written separately."""

    def __init__(self, vehicle, reference):
        self.vehicle, self.model, self.reference = vehicle, HydrodynamicModel(vehicle), reference

    def seen_from(self, relative):
        """The reference's velocity in the axes of a body that is turned against it."""
        back = relative.inv()
        return np.concatenate([back.apply(self.reference[:3]), back.apply(self.reference[3:])])

    def rate(self, x, u):
        """How fast the deviation changes from x on, by central differences of where motion leads."""
        attitude = Rotation.from_rotvec(x[3:6])
        place, goal_nu = attitude.apply(x[:3]), self.seen_from(attitude)
        nu, down = x[6:] + goal_nu, attitude.inv().apply((0.0, 0.0, 1.0))
        keeping = reference_wrench(self.model, goal_nu, np.zeros(6))
        force = keeping + u + self.model.wrench(nu) + self.model.restoring(down)
        acceleration = np.linalg.solve(self.vehicle.mass_matrix, force)
        ends = []
        for h in (1e-5, -1e-5):
            goal_attitude, goal_place = Rotation.from_rotvec(h * self.reference[3:]), h * self.reference[:3]
            turned = attitude * Rotation.from_rotvec(h * nu[3:])
            away = place + h * attitude.apply(nu[:3]) - goal_place
            relative = goal_attitude.inv() * turned
            faster = nu + h * acceleration - self.seen_from(relative)
            ends.append(np.concatenate([turned.inv().apply(away), relative.as_rotvec(), faster]))
        return (ends[0] - ends[1]) / 2e-5


@pytest.mark.parametrize("name", VEHICLES)
def test_deviations_develop_as_the_linear_model_says(name):
    """The error falls with the square of the deviation."""
    pursuit = Pursuit(load_vehicle(name), np.array([0.6, 0.0, 0.1, 0.0, 0.0, 0.2]))
    linear = deviation_model(pursuit.model, pursuit.reference)
    random = np.random.default_rng(5)
    x, u = random.uniform(-1.0, 1.0, 12), random.uniform(-1.0, 1.0, 6)
    errors = []
    for size in (1e-2, 1e-3):
        rate = pursuit.rate(size * x, size * u)
        errors.append(np.abs(rate - size * (linear.state @ x + linear.wrench @ u)).max())
    assert errors[1] < 2e-2 * errors[0]


def test_a_reference_is_kept_by_its_wrench():
    pursuit = Pursuit(load_vehicle("rexrov"), np.array([0.6, 0.0, 0.1, 0.0, 0.0, 0.2]))
    np.testing.assert_allclose(pursuit.rate(np.zeros(12), np.zeros(6)), 0.0, atol=1e-8)


def test_sampling_is_exact_for_a_held_wrench():
    """Of two halves of a period, the second begins where the first ends; and models of many references are one each."""
    model = HydrodynamicModel(load_vehicle("bluerov2"))
    references = np.array([[0.3, 0.0, 0.0, 0.0, 0.0, 0.1], [0.8, 0.0, 0.1, 0.0, 0.0, -0.2]])
    whole, half = (sampled(deviation_model(model, references), period) for period in (PERIOD, PERIOD / 2.0))
    np.testing.assert_allclose(half.state @ half.state, whole.state, atol=1e-12)
    np.testing.assert_allclose(half.state @ half.wrench + half.wrench, whole.wrench, atol=1e-12)
    alone = sampled(deviation_model(model, references[1]), PERIOD)
    np.testing.assert_allclose(whole.state[1], alone.state, atol=1e-13)
