"""Waves on a submerged body: closed forms, SciPy, and many bodies at once."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from support.sweeps import sweep

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import to_fossen
from dq_marine.physics.waves.submerged import stations, submerged_wave_term
from dq_marine.physics.weather import Jonswap, Sea, WaveLoads
from dq_marine.simulation.scene import Scene, batch_of
from dq_marine.vehicles import load_vehicle

UPRIGHT = (1.0, 0.0, 0.0, 0.0)
RHO = 1000.0


def sphere(radius=0.2, damping=0.0, drag=0.0):
    """A neutral sphere: added mass half its displacement."""
    volume = 4.0 / 3.0 * math.pi * radius**3
    mass, base = RHO * volume, load_vehicle("bluerov2_heavy")
    inertia = 0.4 * mass * radius**2
    return base.model_validate(
        base.model_dump()
        | {
            "rigid_body": {"mass": mass, "center_of_mass": (0.0, 0.0, 0.0), "inertia": (inertia,) * 3,
                           "inertia_about": "body_origin"},
            "buoyancy": {"volume": volume, "center": (0.0, 0.0, 0.0), "water_density": RHO},
            "added_mass": (0.5 * mass,) * 3 + (0.0,) * 3,
            "damping": {"linear": (damping,) * 3 + (0.0,) * 3, "quadratic": (drag,) * 3 + (0.0,) * 3},
            "dimensions": {"length": 2 * radius, "width": 2 * radius, "height": 2 * radius, "shape": "ellipsoid"},
            "limits": {"wrench": (mass,) * 3 + (0.0,) * 3},
            "thrusters": (),
        }
    )  # fmt: skip


def wave(direction=0.0, height=0.5, period=8.0, depth=None, seed=0):
    """A single regular wave."""
    return Sea(Jonswap(height, period), direction, components=1, depth=depth, seed=seed)


def force_on(vehicle, sea, position=(0.0, 0.0, 3.0), time=0.0, attitude=UPRIGHT):
    term = submerged_wave_term(sea, vehicle)
    return np.array(to_fossen(term.function(term.parameters, pose_from_parts(attitude, position), time)))


def test_the_force_on_a_small_sphere_is_one_and_a_half_times_that_on_its_water():
    """(rho V + m_A) a, m_A = rho V/2: 3/2 rho V omega^2 a e^{-kz} in each direction, a quarter period apart."""
    ball, sea = sphere(), wave()
    omega, k, a = float(sea.frequencies[0]), float(sea.wave_numbers[0]), float(sea.amplitudes[0])
    expected = 1.5 * RHO * ball.buoyancy.volume * omega**2 * a * math.exp(-k * 3.0)
    for time in (0.0, 1.3, 4.0):
        force = force_on(ball, sea, time=time)
        theta = omega * time + float(sea.phases[0])
        assert force[0] == pytest.approx(-expected * math.sin(theta), rel=1e-3, abs=1e-3 * expected)
        assert force[2] == pytest.approx(expected * math.cos(theta), rel=1e-3, abs=1e-3 * expected)
        assert np.abs(force[[1, 3, 4, 5]]).max() < 1e-12


@pytest.mark.parametrize(
    ("depth", "damping", "drag"),
    sweep([(None, 0.0, 0.0), (12.0, 20.0, 500.0)], plain=[(12.0, 20.0, 500.0)]),
)
def test_a_small_neutral_body_goes_round_with_the_water(depth, damping, drag):
    """Started with the water's velocity it stays with it: circles, or over a bottom ellipses, of known half axes."""
    sea = wave(height=0.05, depth=depth)
    omega, k, a = float(sea.frequencies[0]), float(sea.wave_numbers[0]), float(sea.amplitudes[0])
    z, phase = 3.0, float(sea.phases[0])
    if depth is None:
        across, down = a * math.exp(-k * z), a * math.exp(-k * z)
    else:
        across, down = (a * f(k * (depth - z)) / math.sinh(k * depth) for f in (math.cosh, math.sinh))
    body = Scene(sphere(damping=damping, drag=drag), step=0.02, weather=[sea]).stepper()
    start = np.array([across * math.sin(phase), 0.0, z - down * math.cos(phase)])
    body.reset(
        start, velocity_body=(across * omega * math.cos(phase), 0, down * omega * math.sin(phase), 0, 0, 0)
    )
    for _ in range(10):
        body.step(steps=round(2.0 * math.pi / omega / 10 / 0.02))
        theta = omega * body.time + phase
        expected = [across * math.sin(theta), 0.0, z - down * math.cos(theta)]
        np.testing.assert_allclose(body.position_ned, expected, atol=0.03 * a)


@pytest.mark.parametrize("speed", [-1.0, 0.0, 2.0])
def test_the_frequency_of_encounter_comes_of_itself(speed):
    """Ahead with u against or along the waves: omega_e = omega - k u."""
    ball, sea = sphere(), wave()
    omega, k = float(sea.frequencies[0]), float(sea.wave_numbers[0])
    times = np.linspace(0.0, 60.0, 4001)
    forces = [force_on(ball, sea, (speed * t, 0.0, 3.0), t)[2] for t in times.tolist()]
    basis = lambda w: np.stack([np.cos(w * times), np.sin(w * times)], axis=1)  # noqa: E731
    left = np.linalg.lstsq(basis(omega - k * speed), np.array(forces), rcond=None)[1]
    assert left[0] < 1e-20 * np.square(forces).sum()


def test_a_vehicle_that_turns_feels_the_same_waves():
    """The wrench turns with the body: force in NED does not depend on a sphere's attitude."""
    ball, sea = sphere(0.02), Sea(Jonswap(1.0, 6.0), 0.4, components=10)
    q = Rotation.from_euler("xyz", [0.3, -0.5, 1.1]).as_quat()
    attitude = (float(q[3]), *q[:3].tolist())
    turned = Rotation.from_quat(q).apply(force_on(ball, sea, attitude=attitude)[:3])
    np.testing.assert_allclose(turned, force_on(ball, sea)[:3], rtol=5e-4)


def test_a_long_hull_is_carried_by_what_it_feels_along_its_length():
    """Stations against the integral along the hull of the force per length, in waves as long as the hull."""
    vehicle = load_vehicle("npsauv")
    length = vehicle.dimensions.length
    sea = Sea(Jonswap(0.2, 2.0 * math.pi / math.sqrt(9.81 * 2.0 * math.pi / length)), 0.3, components=1)
    k, direction = float(sea.wave_numbers[0]), 0.3
    omega, a, phase = float(sea.frequencies[0]), float(sea.amplitudes[0]), float(sea.phases[0])
    term = submerged_wave_term(sea, vehicle)
    own = np.array(to_fossen(term.function(term.parameters, pose_from_parts(UPRIGHT, (0.0, 0.0, 4.0)), 0.0)))
    centre = np.array(vehicle.buoyancy.center)
    x = (np.arange(4000) + 0.5) / 4000.0 * length - 0.5 * length
    theta = phase - k * math.cos(direction) * (x + centre[0]) - k * math.sin(direction) * centre[1]
    size = a * omega * math.exp(-k * (4.0 + centre[2]))
    e = np.array([math.cos(direction), math.sin(direction), 0.0])
    down = np.array([0.0, 0.0, 1.0])
    velocity = size * (np.outer(np.cos(theta), e) + np.outer(np.sin(theta), down))
    acceleration = size * omega * (np.outer(-np.sin(theta), e) + np.outer(np.cos(theta), down))
    added = np.array(vehicle.added_mass)
    added = 0.5 * (added + added.T)
    mass = vehicle.buoyancy.water_density * vehicle.buoyancy.volume
    water = np.array([[0, -centre[2], centre[1]], [centre[2], 0, -centre[0]], [-centre[1], centre[0], 0]])
    rows = mass * np.vstack([np.eye(3), water]) + added[:, :3]
    each = acceleration @ rows.T + velocity @ vehicle.linear_damping[:, :3].T
    expected = each.mean(axis=0)
    expected[4] += np.mean(-x * each[:, 2])
    expected[5] += np.mean(x * each[:, 1])
    np.testing.assert_allclose(own, expected, atol=2e-3 * np.abs(expected).max())


def test_a_hull_is_cut_as_finely_as_the_waves_ask():
    assert len(stations(wave(period=12.0), 0.4)[0]) == 1
    places, shares = stations(wave(period=2.0, height=0.1), 5.0)
    assert len(places) > 3
    assert shares.sum() == pytest.approx(1.0)
    assert (shares * places**2).sum() == pytest.approx(25.0 / 12.0)


def test_a_damped_body_in_a_sea_is_what_scipy_says():
    """M v' = (rho V + m_A) a + D (u - v), with the sea written again; second order in the step."""
    sea = Sea(Jonswap(1.0, 5.0), 0.5, components=7, seed=3, spreading=1.0)
    ball = sphere(0.05, damping=0.5)
    total = 1.5 * ball.rigid_body.mass
    k, omega, e = sea.wave_numbers, sea.frequencies, sea.directions

    def rate(t, y):
        theta = omega * t + sea.phases - k * (np.cos(e) * y[0] + np.sin(e) * y[1])
        size = sea.amplitudes * omega * np.exp(-k * y[2])
        u = np.array([
            (size * np.cos(theta) * np.cos(e)).sum(), (size * np.cos(theta) * np.sin(e)).sum(),
            (size * np.sin(theta)).sum(),
        ])  # fmt: skip
        du = np.array([
            (-size * omega * np.sin(theta) * np.cos(e)).sum(), (-size * omega * np.sin(theta) * np.sin(e)).sum(),
            (size * omega * np.cos(theta)).sum(),
        ])  # fmt: skip
        return np.concatenate([y[3:], du + 0.5 * (u - y[3:]) / total])

    reference = solve_ivp(
        rate, (0.0, 8.0), [0, 0, 4.0, 0.3, 0, 0], method="DOP853", rtol=1e-11, atol=1e-12
    ).y[:3, -1]
    measured = []
    for step in (0.1, 0.05):
        body = Scene(ball, step=step, weather=[sea]).stepper()
        body.reset((0, 0, 4.0), velocity_body=(0.3, 0, 0, 0, 0, 0))
        body.step(steps=round(8.0 / step))
        measured.append(np.linalg.norm(body.position_ned - reference))
    assert measured[1] < 2e-4
    assert math.log2(measured[0] / measured[1]) == pytest.approx(2.0, abs=0.3)


@pytest.mark.sweep
def test_bodies_in_lanes_have_the_bits_of_a_single_one():
    """Of different vehicles, too: the sea is one for all."""
    sea = Sea(Jonswap(1.0, 5.0), 0.5, components=9, seed=3)
    names = ["bluerov2_heavy", "bluerov2_heavy", "bluerov2_heavy"]
    positions = np.array([[0.0, 0.0, 3.0], [5.0, 1.0, 2.0], [-3.0, 2.0, 8.0]])
    scenes = [
        Scene(name, weather=[WaveLoads(sea)], current=(0.1 * i, 0.2, 0.0)) for i, name in enumerate(names, 1)
    ]
    batch = batch_of(scenes)
    batch.reset(positions)
    batch.step((5.0, 1.0, 0.0, 0.0, 0.1, 0.2), 100)
    for index, scene in enumerate(scenes):
        single = scene.stepper()
        single.reset(positions[index])
        single.step((5.0, 1.0, 0.0, 0.0, 0.1, 0.2), 100)
        assert np.array_equal(batch.get_state()[index], single.get_state())
    assert np.abs(batch.position_ned - positions).max() > 0.05


def test_a_scene_says_that_there_are_waves_and_without_them_is_as_before():
    assert "waves" in Scene(weather=[wave()]).terms
    assert Scene(weather=()).composition == Scene().composition
