"""Slow drift: its mean, its slow beat, and its signs."""

import math

import numpy as np
import pytest
from support.sweeps import sweep

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import to_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.slow_drift import reflected_drift
from dq_marine.physics.weather import DriftCoefficients, Jonswap, Sea, SlowDrift
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

VEHICLE = load_vehicle("bluerov2_heavy")
FREQUENCIES = np.array([0.3, 0.9, 1.2, 4.0])
VALUES = np.array([[5.0, 40.0, 3.0], [8.0, 60.0, 4.0], [9.0, 80.0, 6.0], [7.0, 70.0, 1.0]])
ALIKE = DriftCoefficients(FREQUENCIES, VALUES)
CROSSING = DriftCoefficients(FREQUENCIES, VALUES * np.array([[-1.0], [-1.0], [1.0], [1.0]]))


def forces(drift, times, heading=0.0):
    term = drift.terms(VEHICLE, np.zeros(3))[0]
    pose = pose_from_parts((math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading)), (3.0, 1.0, 0.0))
    return np.array([to_fossen(term.function(term.parameters, pose, t)) for t in np.asarray(times).tolist()])


@pytest.mark.parametrize("coefficients", [ALIKE, CROSSING])
@pytest.mark.parametrize("beta", sweep([0.0, 0.5 * math.pi, 0.25 * math.pi, -2.0], plain=[-2.0]))
def test_the_mean_is_that_of_all_components(coefficients, beta):
    sea = Sea(Jonswap(2.0, 7.0), direction=beta + 0.4, components=30, seed=2)
    mean = forces(SlowDrift(sea, coefficients), np.arange(0.0, 40_000.0, 7.3), heading=0.4).mean(axis=0)
    values = (sea.amplitudes[:, None] ** 2 * coefficients.at(sea.frequencies)).sum(axis=0)
    c, s = math.cos(beta), math.sin(beta)
    expected = np.array([c * abs(c), s * abs(s), math.sin(2.0 * beta)]) * values
    scale = (sea.amplitudes[:, None] ** 2 * np.abs(coefficients.at(sea.frequencies))).sum(axis=0)
    np.testing.assert_allclose(mean[[0, 1, 5]], expected, atol=0.1 * scale.max())
    assert np.all(mean[[2, 3, 4]] == 0.0)


def test_two_waves_beat_at_the_difference_of_their_frequencies():
    """F = a^2 (D_1 + D_2 + 2 sqrt(D_1 D_2) cos((omega_1 - omega_2) t + ...)): a parabola between 0 and the most."""
    sea = Sea(Jonswap(2.0, 7.0), components=2)
    omega, a = sea.frequencies, float(sea.amplitudes[0])
    d = ALIKE.at(omega)[:, 0]
    times = np.linspace(0.0, 4.0 * math.pi / (omega[1] - omega[0]), 2000)
    surge = forces(SlowDrift(sea, ALIKE), times)[:, 0]
    assert surge.max() == pytest.approx(a**2 * (math.sqrt(d[0]) + math.sqrt(d[1])) ** 2, rel=1e-4)
    assert surge.min() == pytest.approx(a**2 * (math.sqrt(d[0]) - math.sqrt(d[1])) ** 2, rel=1e-3, abs=1e-3)
    beat = np.stack(
        [np.ones_like(times), *(f((omega[1] - omega[0]) * times) for f in (np.cos, np.sin))], axis=1
    )
    assert np.linalg.lstsq(beat, surge, rcond=None)[1][0] < 1e-18 * np.square(surge).sum()


def test_waves_that_are_thrown_back_push_as_hard_as_waves_can():
    """Maruo's bound, 1/2 rho g a^2 L, for short waves on the side; hardly anything for long ones."""
    k = np.array([1e-4, 1e3])
    drift = reflected_drift(np.sqrt(9.81 * k), k, VEHICLE, draft=0.2)
    assert drift.coefficients[1, 1] == pytest.approx(0.5 * 1000.0 * 9.81 * VEHICLE.dimensions.length)
    assert drift.coefficients[1, 0] == pytest.approx(0.5 * 1000.0 * 9.81 * VEHICLE.dimensions.width)
    assert drift.coefficients[0].max() < 1e-4 * drift.coefficients[1].max()


@pytest.mark.sweep  # with waves and wind: test_floating
def test_vessels_in_lanes_have_the_bits_of_a_single_one():
    scene = Scene(weather=[SlowDrift(Sea(Jonswap(1.0, 5.0), 1.0, components=7), ALIKE)])
    batch, single = scene.batch(3), scene.stepper()
    for body in (batch, single):
        body.reset((1.0, 2.0, 0.0), (0.8, 0.0, 0.0, 0.6))
        body.step(steps=40)
    assert np.array_equal(batch.get_state()[2], single.get_state())
    assert single.velocity_body[:2].any()


def test_what_does_not_fit_together_is_refused():
    sea = Sea(Jonswap(1.0, 5.0))
    with pytest.raises(InvalidInputError, match="submerged"):
        Scene(weather=[SlowDrift(sea)])
    with pytest.raises(InvalidInputError, match="shape"):
        DriftCoefficients(FREQUENCIES, np.zeros((4, 2)))
    with pytest.raises(InvalidInputError, match="rise"):
        DriftCoefficients(FREQUENCIES[::-1], np.zeros((4, 3)))
    with pytest.raises(InvalidInputError, match="finite"):
        DriftCoefficients(FREQUENCIES, np.full((4, 3), math.nan))
