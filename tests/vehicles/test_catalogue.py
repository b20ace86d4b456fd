"""Every vehicle of the catalogue: its published numbers, and that it can be simulated, trained with and drawn."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from support.sweeps import sweep

from dq_marine.envs.core.view import shape_of
from dq_marine.errors import UnsuitableVehicleWarning
from dq_marine.physics.hydrostatics.restoring import floating_periods
from dq_marine.report.case_bodies import Rexrov, remus_100
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_names, vehicle_sheet
from dq_marine.vehicles.coupling import asymmetry
from dq_marine.viewer import save_replay
from dq_marine.viewer.snapshot import at_rest

ID = "dq_marine/StationKeeping-v0"
DRIVEN = [name for name in vehicle_names() if load_vehicle(name).channels]
FLOATING = ["kvlcc2", "kvlcc2_l7", "mariner", "osv83", "otter", "supply_vessel", "tanker"]


def test_the_catalogue():
    submerged = ["bluerov2", "bluerov2_heavy", "npsauv", "remus100", "rexrov"]
    assert vehicle_names() == sorted([*submerged, *FLOATING])
    assert [name for name in vehicle_names() if load_vehicle(name).hydrostatics] == FLOATING


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


def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def moved(matrix, r):
    """H(r)^T A H(r): a matrix about a point, about one from which that point is at r (Fossen)."""
    h = np.eye(6)
    h[:3, 3:] = -skew(r)
    return h.T @ matrix @ h


def test_otter_has_the_published_numbers():
    """By the formulas of the Python Vehicle Simulator, from its main particulars."""
    vehicle = load_vehicle("otter")
    length, beam, hull, payload = 2.0, 1.08, 55.0, 25.0
    r_p = np.array([0.05, 0.0, -0.35])
    r_g = (hull * np.array([0.2, 0.0, -0.2]) + payload * r_p) / (hull + payload)
    radii = np.array([0.4 * beam, 0.25 * length, 0.25 * length])
    inertia = hull * (np.diag(radii**2) - skew(r_g) @ skew(r_g)) - payload * skew(r_p) @ skew(r_p)
    rigid = np.zeros((6, 6))
    rigid[:3, :3], rigid[3:, 3:] = (hull + payload) * np.eye(3), inertia
    factors = (0.1 * hull, 1.5 * hull, hull, *(np.array([0.2, 0.8, 1.7]) * np.diag(inertia)))
    m = moved(rigid, r_g) + np.diag(factors)
    assert np.allclose(vehicle.mass_matrix, m, rtol=1e-9, atol=1e-9)

    pontoon, y, cw, rho, g = 0.25, 0.395, 0.75, 1025.0, 9.81
    volume = (hull + payload) / rho
    draft = volume / (2.0 * 0.4 * pontoon * length)
    area = cw * length * pontoon
    transverse = 2.0 / 12.0 * length * pontoon**3 * 6.0 * cw**3 / ((1.0 + cw) * (1.0 + 2.0 * cw))
    below = (2.5 * draft - 0.5 * volume / (length * pontoon)) / 3.0 - (draft - r_g[2])
    gm_t = (transverse + 2.0 * area * y**2) / volume + below
    gm_l = 0.8 * 2.0 / 12.0 * pontoon * length**3 / volume + below
    at_flotation = rho * g * np.diag([0.0, 0.0, 2.0 * area, volume * gm_t, volume * gm_l, 0.0])
    stiffness = moved(at_flotation, np.array([-0.2, 0.0, 0.0]))
    assert np.allclose(vehicle.waterplane_stiffness, stiffness[2:5, 2:5], rtol=1e-9)

    natural = np.sqrt(np.diag(at_flotation)[2:5] / np.diag(m)[2:5])
    relative = 2.0 * np.array([0.3, 0.2, 0.4]) * natural * np.diag(m)[2:5]
    linear = (24.4 * g / 3.0864, m[1, 1], *relative, m[5, 5])
    assert np.allclose(np.diag(vehicle.linear_damping), linear, rtol=1e-8)
    assert vehicle.quadratic_damping[5] == pytest.approx(10.0 * m[5, 5])
    assert [(payload.mass, payload.position) for payload in vehicle.payloads] == [(25.0, (0.05, 0.0, -0.35))]


def test_osv83_has_the_published_numbers():
    """By the formulas of MSS's osv.m, from its main particulars."""
    vehicle = load_vehicle("osv83")
    length, beam, draft, cb, cw, rho = 83.0, 18.0, 5.0, 0.65, 0.8, 1025.0
    volume, area = cb * length * beam * draft, cw * length * beam
    assert vehicle.rigid_body.mass == pytest.approx(rho * volume)
    radii = np.array([0.35 * beam, 0.25 * length, 0.25 * length])
    rigid = rho * volume * np.diag([1.0, 1.0, 1.0, *radii**2])
    m = moved(rigid, np.array([-4.5, 0.0, -1.2])) + np.array(vehicle.added_mass)
    assert np.allclose(vehicle.mass_matrix, m, rtol=1e-12, atol=1e-3)

    bg = draft - (2.5 * draft - volume / area) / 3.0 + 1.2
    gm_t = 6.0 * cw**3 / ((1.0 + cw) * (1.0 + 2.0 * cw)) * beam**3 * length / 12.0 / volume - bg
    gm_l = 0.7 * length**3 * beam / 12.0 / volume - bg
    at_flotation = rho * 9.81 * np.diag([0.0, 0.0, area, volume * gm_t, volume * gm_l, 0.0])
    stiffness = moved(at_flotation, np.array([-0.5, 0.0, 0.0]))[2:5, 2:5]
    assert np.allclose(vehicle.waterplane_stiffness, stiffness, rtol=1e-9)

    masses = np.diag(m)
    natural = np.sqrt(np.diag(stiffness) / masses[2:5])
    relative = 2.0 * np.array([0.2, 0.15, 0.3]) * natural * masses[2:5]
    linear = (0.0, masses[1] / 100.0, *relative, masses[5])  # surge: test_osv83.py
    assert np.allclose(np.diag(vehicle.linear_damping), linear, rtol=1e-8)
    assert vehicle_sheet(vehicle).terminal_speed["surge"] == pytest.approx(7.7, rel=1e-3)


def test_the_data_ships_have_the_published_matrices():
    """M_RB and C of MSS's vessel data, from what the files say of them."""
    supply = load_vehicle("supply_vessel")
    rigid = supply.rigid_body_matrix
    assert rigid[0, 4] == pytest.approx(-8270870.5, rel=1e-6)
    assert rigid[1, 5] == pytest.approx(-34266343.459, rel=1e-9)
    assert np.diag(rigid)[3:] == pytest.approx((298059260.0, 2921450770.8585, 2910698770.8585))
    assert supply.mass_matrix[1, 3] == pytest.approx(8270870.5 + (3494043.4026 + 3067235.2) / 2.0, rel=1e-6)
    assert asymmetry(np.array(supply.added_mass), supply.mass_matrix).value == pytest.approx(
        0.01454, rel=1e-3
    )
    tanker = load_vehicle("tanker")
    rigid = tanker.rigid_body_matrix
    assert (rigid[0, 4], rigid[2, 4]) == pytest.approx((-236550525.0, -371857425.3))
    assert np.diag(rigid)[3:] == pytest.approx((27409620280.88, 387080076077.14, 417428070207.44))
    # Of uncoupled heave, roll and pitch, 2 pi sqrt(M_ii/C_ii): couplings change them by a few per cent.
    for vehicle, periods in ((supply, (7.066, 10.408, 6.360)), (tanker, (10.533, 12.556, 9.348))):
        alone = (
            2.0 * np.pi * np.sqrt(np.diag(vehicle.mass_matrix)[2:5] / np.diag(vehicle.waterplane_stiffness))
        )
        assert alone == pytest.approx(periods, abs=1e-3)
        assert floating_periods(vehicle) == pytest.approx(periods, rel=0.05)


def random_hour(body, act):
    """Act anew each half second for an hour; no step is refused, or it would raise."""
    for _ in range(7200):
        act()
        assert np.isfinite(body.get_state()).all()
    assert body.time == pytest.approx(3600.0)


@pytest.mark.parametrize("name", sweep(vehicle_names(), plain=("bluerov2_heavy", "otter")))
def test_an_hour_of_random_wrenches_is_finite(name):
    vehicle = load_vehicle(name)
    body = Scene(vehicle, current=(0.3, -0.1, 0.0), step=0.02).stepper()
    rng = np.random.default_rng(0)
    random_hour(body, lambda: body.step(rng.uniform(-1.0, 1.0, 6) * vehicle.wrench_limits, 25))


@pytest.mark.sweep
@pytest.mark.parametrize("name", DRIVEN)
def test_an_hour_of_random_commands_is_finite(name):
    vehicle = load_vehicle(name)
    body = Scene(vehicle, current=(0.3, -0.1, 0.0), step=0.02, actuation="thrusters").stepper()
    rng = np.random.default_rng(0)
    low, high = (np.array([getattr(channel, end) for channel in vehicle.channels]) for end in ("low", "high"))
    random_hour(body, lambda: body.actuate(rng.uniform(low, high), 25))


@pytest.mark.parametrize("name", sweep(vehicle_names(), plain=("bluerov2_heavy",)))
@pytest.mark.parametrize("actuation", sweep(["wrench", "thrusters"], plain=["wrench"]))
def test_an_hour_in_lanes_is_finite(name, actuation):
    """Eight of a kind, each by its own random wrenches or commands; none is refused a step."""
    vehicle = load_vehicle(name)
    batch = Scene(vehicle, current=(0.3, -0.1, 0.0), step=0.02, actuation=actuation).batch(8)
    rng, most = np.random.default_rng(0), vehicle.wrench_limits
    low, high = (np.array([getattr(channel, end) for channel in vehicle.channels]) for end in ("low", "high"))
    for _ in range(7200):
        if actuation == "wrench":
            batch.step(rng.uniform(-1.0, 1.0, (8, 6)) * most, 25)
        else:
            batch.actuate(rng.uniform(low, high, (8, low.size)), 25)
        assert not batch.refusals
        assert np.isfinite(batch.get_state()).all()
    batch.close()


@pytest.mark.parametrize("name", sweep(vehicle_names(), plain=("bluerov2_heavy", "otter")))
def test_the_environment_takes_it(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UnsuitableVehicleWarning)
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
