"""Every vehicle of the catalogue: its published numbers, and that it can be simulated, trained with and drawn."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from dq_marine.envs.view import shape_of
from dq_marine.report.case_bodies import Rexrov, remus_100
from dq_marine.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.viewer import save_replay
from dq_marine.viewer.snapshot import at_rest

ID = "dq_marine/StationKeeping-v0"


def test_the_catalogue():
    assert vehicle_names() == ["bluerov2", "bluerov2_heavy", "npsauv", "remus100", "rexrov"]


def test_bluerov2_has_the_published_numbers():
    """Wu 2018: weight 112.8 N, buoyancy 114.8 N, z_G = 0.02 m."""
    vehicle = load_vehicle("bluerov2")
    m = vehicle.mass_matrix
    assert np.allclose(np.diag(m), (17.0, 24.2, 26.07, 0.28, 0.28, 0.28))
    assert (m[0, 4], m[1, 3]) == pytest.approx((0.23, -0.23))
    assert vehicle.weight == pytest.approx(112.8, abs=0.05)
    assert vehicle.buoyant_force == pytest.approx(114.8, abs=0.05)


def test_rexrov_and_remus_are_those_of_the_report():
    assert np.allclose(load_vehicle("rexrov").mass_matrix, Rexrov().mass_matrix, rtol=1e-12)
    assert np.allclose(load_vehicle("remus100").mass_matrix, remus_100(), rtol=1e-12)


def test_npsauv_has_the_published_numbers():
    """Healey & Lienard 1993, from the dimensionless derivatives with L = 5.3 m and 1025 kg/m^3."""
    vehicle = load_vehicle("npsauv")
    m = vehicle.mass_matrix
    half, length = 0.5 * 1025.0, 5.3
    derivatives = {
        (0, 0): (7.6e-3, 3),
        (1, 1): (5.5e-2, 3),
        (2, 2): (2.4e-1, 3),
        (1, 3): (-1.2e-4, 4),
        (1, 5): (-1.2e-3, 4),
        (2, 4): (6.8e-3, 4),
        (3, 3): (1.0e-3, 5),
        (3, 5): (3.4e-5, 5),
        (4, 4): (1.7e-2, 5),
        (5, 5): (3.4e-3, 5),
    }
    added = np.zeros((6, 6))
    for (i, j), (value, power) in derivatives.items():
        added[i, j] = added[j, i] = value * half * length**power
    assert np.allclose(vehicle.added_mass, added, rtol=1e-9, atol=1e-9)
    assert m[0, 4] == pytest.approx(332.04892966360853)
    assert np.allclose(
        m[3:, 3:] - added[3:, 3:], [[2038, 13.58, 13.58], [13.58, 13587, 13.58], [13.58, 13.58, 13587]]
    )
    assert vehicle.weight == pytest.approx(53400.0)
    assert Scene(vehicle).terms == (
        "righting moment",
        "diagonal linear and quadratic damping",
        "damping couplings",
        "cross-flow drag",
    )


@pytest.mark.parametrize("name", vehicle_names())
def test_a_minute_of_random_wrenches_is_finite(name):
    """Drawn anew each half second, up to the limits, in a current; no step is refused, or it would raise."""
    vehicle = load_vehicle(name)
    body = Scene(vehicle, current=(0.3, -0.1, 0.0), step=0.02).stepper()
    rng = np.random.default_rng(0)
    for _ in range(120):
        body.step(rng.uniform(-1.0, 1.0, 6) * vehicle.wrench_limits, 25)
        assert np.isfinite(body.get_state()).all()
    assert body.time == pytest.approx(60.0)


@pytest.mark.parametrize("name", vehicle_names())
def test_the_environment_takes_it(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gym.make(ID, vehicle=name)
        check_env(env.unwrapped, skip_render_check=True)
    assert env.action_space.shape == (np.count_nonzero(load_vehicle(name).wrench_limits),)
    env.close()


@pytest.mark.parametrize("name", vehicle_names())
def test_it_is_drawn(name, tmp_path):
    vehicle = load_vehicle(name)
    shape = shape_of(vehicle)
    assert shape.kind == vehicle.dimensions.shape
    save_replay(tmp_path / "page.html", [at_rest(10.0)], shape, title=vehicle.name)
    assert vehicle.name in (tmp_path / "page.html").read_text(encoding="utf-8")
