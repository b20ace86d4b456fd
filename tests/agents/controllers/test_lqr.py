"""The regulator: it solves the Riccati equation, stabilises, and costs what its Riccati matrix says."""

from __future__ import annotations

import numpy as np
import pytest
from support.regulated import regulated

from dq_marine.agents.controllers.deviation import LinearModel
from dq_marine.agents.controllers.lqr import regulator
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle

VEHICLES = ["bluerov2", "bluerov2_heavy", "rexrov"]


@pytest.mark.parametrize("name", VEHICLES)
@pytest.mark.parametrize("speed", [0.0, 0.8])
def test_the_closed_loop_decays(name, speed):
    model, _, found = regulated(name, speed)
    closed = model.state - model.wrench @ found.gain
    assert np.abs(np.linalg.eigvals(closed)).max() < 0.99


@pytest.mark.parametrize("name", VEHICLES)
def test_it_solves_the_riccati_equation(name):
    """In Joseph's form, P = (A - B K)^T P (A - B K) + K^T R K + Q, which holds for the best K alone besides (1)."""
    model, weights, found = regulated(name)
    a, b, k, p = model.state, model.wrench, found.gain, found.cost
    closed, q, r = a - b @ k, np.diag(weights.state), np.diag(weights.wrench)
    joseph = closed.T @ p @ closed + k.T @ r @ k + q
    np.testing.assert_allclose(joseph, p, rtol=1e-8, atol=1e-9 * np.abs(p).max())
    driven = weights.wrench > 0.0
    stationary = (r @ k - b.T @ p @ closed)[driven]
    np.testing.assert_allclose(stationary, 0.0, atol=1e-9 * np.abs(b.T @ p @ a).max())


@pytest.mark.parametrize("name", VEHICLES)
def test_what_a_deviation_costs_is_what_the_riccati_matrix_says(name):
    model, weights, found = regulated(name)
    x = np.random.default_rng(1).uniform(-0.1, 0.1, 12)
    expected, total = x @ found.cost @ x, 0.0
    for _ in range(2000):
        u = -found.gain @ x
        total += weights.state @ x**2 + weights.wrench @ u**2
        x = model.state @ x + model.wrench @ u
    assert total == pytest.approx(expected, rel=1e-9)


def test_an_axis_that_nothing_drives_is_left_alone():
    vehicle = load_vehicle("bluerov2")
    assert vehicle.wrench_limits[4] == 0.0
    _, weights, found = regulated("bluerov2")
    assert weights.wrench[4] == 0.0
    assert not found.gain[4].any()
    assert found.gain[[0, 1, 2, 3, 5]].any(axis=1).all()


def test_what_cannot_be_stabilised_is_refused():
    model, weights, _ = regulated("bluerov2_heavy")
    growing = LinearModel(1.5 * np.eye(12), 0.0 * model.wrench)
    with pytest.raises(
        InvalidInputError, match=r"no stabilising solution with the driven axes .* give a vehicle"
    ):
        regulator(growing, weights)
