"""Waves on a hull that floats: the limits of long waves, transfer functions from files, and the package's series."""

import json
import math

import numpy as np
import pytest
from support.bodies import make_body

from dq_marine.algebra.dual_quaternion import pose_from_parts, pose_position
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.algebra.spatial import Spatial, to_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.floating import HEADINGS, long_wave_rao
from dq_marine.physics.weather import (
    DriftCoefficients,
    ForceRAO,
    Jonswap,
    Radiation,
    Sea,
    SlowDrift,
    WaveLoads,
    Wind,
    Windage,
    read_force_rao,
)
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

RHO, G = 1000.0, 9.81
LENGTH, BEAM, DRAFT = 4.0, 1.0, 0.3
MASS = RHO * LENGTH * BEAM * DRAFT
CENTER = (0.2, 0.0, -0.1)
"""Of mass and, but for its depth, of buoyancy."""


def barge(radiates=1.0):
    """A box that floats, its body origin in the waterline, not amidships."""
    inertia = np.array([MASS * BEAM**2, MASS * LENGTH**2, MASS * LENGTH**2]) / 12.0
    base = load_vehicle("bluerov2_heavy")
    return base.model_validate(
        base.model_dump()
        | {
            "rigid_body": {"mass": MASS, "center_of_mass": CENTER, "inertia": inertia.tolist(),
                           "inertia_about": "center_of_mass"},
            "buoyancy": {"volume": MASS / RHO, "center": (CENTER[0], 0.0, 0.5 * DRAFT), "water_density": RHO},
            "added_mass": tuple(radiates * a for a in (0.1 * MASS, 0.6 * MASS, 1.1 * MASS, 20.0, 900.0, 500.0)),
            "damping": {"linear": tuple(radiates * b for b in (50.0, 200.0, 2000.0, 50.0, 2000.0, 500.0))},
            "limits": {"wrench": (MASS,) * 6},
            "dimensions": {"length": LENGTH, "width": BEAM, "height": 1.0, "shape": "ellipsoid"},
            "thrusters": (),
        }
    )  # fmt: skip


def stiffness():
    """Of the waterplane, rho g A_w, and the metacentric heights of a box, moved from amidships to the body origin."""
    area, x = LENGTH * BEAM, CENTER[0]
    buoyancy = RHO * G * LENGTH * BEAM * DRAFT
    lever = CENTER[2] - 0.5 * DRAFT
    heave = RHO * G * area
    roll = RHO * G * LENGTH * BEAM**3 / 12.0 + buoyancy * lever
    pitch = RHO * G * BEAM * LENGTH**3 / 12.0 + buoyancy * lever + x**2 * heave
    return np.array([[heave, 0.0, -x * heave], [0.0, roll, 0.0], [-x * heave, 0.0, pitch]])


def regular(period, depth=None):
    """A single wave of about the period, its height in keeping with it."""
    return Sea(Jonswap(0.002 * period**2, period), components=1, depth=depth)


def answer(sea, vehicle, radiation=None):
    """Complex motion per wave amplitude at all headings, from the linear equations, shape (headings, 6)."""
    omega = float(sea.frequencies[0])
    restoring = np.zeros((6, 6))
    restoring[2:5, 2:5] = stiffness()
    impedance = restoring + 1j * omega * vehicle.linear_damping - omega**2 * vehicle.mass_matrix
    transfer = long_wave_rao(sea, vehicle, stiffness(), radiation).transfer[0]
    return np.linalg.solve(impedance, transfer.T).T


@pytest.mark.parametrize("depth", [None, 30.0])
def test_in_very_long_waves_a_hull_goes_with_the_water(depth):
    """It heaves with the surface, tilts with its slope and is carried along with the water."""
    sea = regular(60.0, depth)
    k, omega = float(sea.wave_numbers[0]), float(sea.frequencies[0])
    motion = answer(sea, barge())
    across = G * k / omega**2
    cosine, sine = np.cos(HEADINGS), np.sin(HEADINGS)
    np.testing.assert_allclose(motion[:, 2], -1.0, atol=0.01)
    np.testing.assert_allclose(motion[:, 3], 1j * k * sine, atol=0.02 * k)
    np.testing.assert_allclose(motion[:, 4], -1j * k * cosine, atol=0.02 * k)
    np.testing.assert_allclose(motion[:, 0], -1j * across * cosine, atol=0.02 * across)
    np.testing.assert_allclose(motion[:, 1], -1j * across * sine, atol=0.02 * across)
    np.testing.assert_allclose(motion[:, 5], -across * k * cosine * sine, atol=0.02 * across * k)


def test_in_waves_half_as_long_as_the_hull_the_heave_force_of_head_seas_vanishes():
    """Two whole waves along a box: pressure adds up to nothing; from abeam it does not."""
    period = 2.0 * math.pi / math.sqrt(G * 2.0 * math.pi / (0.5 * LENGTH))
    sea = Sea(Jonswap(0.01, period, gamma=20.0), components=400)
    rao = long_wave_rao(sea, barge(radiates=1e-6), stiffness())
    near = np.abs(sea.wave_numbers * LENGTH - 4.0 * math.pi).argmin()
    ahead, abeam = np.abs(HEADINGS - math.pi).argmin(), np.abs(HEADINGS - 0.5 * math.pi).argmin()
    assert abs(rao.transfer[near, ahead, 2]) < 0.02 * abs(rao.transfer[near, abeam, 2])


def test_added_mass_and_damping_by_frequency_replace_the_vehicles():
    vehicle, sea = barge(), Sea(Jonswap(0.2, 4.0), components=6)
    added, damping = (
        np.stack([matrix] * 2) for matrix in (np.array(vehicle.added_mass), vehicle.linear_damping)
    )
    same = Radiation(np.array([0.1, 9.0]), added, damping)
    own = long_wave_rao(sea, vehicle, stiffness()).transfer
    np.testing.assert_allclose(long_wave_rao(sea, vehicle, stiffness(), same).transfer, own, rtol=1e-12)
    more = Radiation(same.frequencies, 2.0 * same.added_mass, same.damping)
    assert not np.allclose(long_wave_rao(sea, vehicle, stiffness(), more).transfer, own, rtol=1e-3)


COEFFICIENTS = DriftCoefficients(np.array([0.3, 4.0]), np.array([[5.0, 40.0, 3.0], [7.0, 70.0, 1.0]]))


# The formulas


def some_rao(seed=0, orders=3, steps=24):
    """Transfer functions that are a series in the heading, with random numbers."""
    random = np.random.default_rng(seed)
    frequencies, headings = np.array([0.5, 1.0, 2.0, 8.0]), np.arange(steps) * (2.0 * math.pi / steps)
    c = random.normal(size=(4, orders, 2, 6)) + 1j * random.normal(size=(4, orders, 2, 6))
    n = np.arange(orders)
    by_cosine = np.einsum("jni,nm->jmi", c[:, :, 0], np.cos(np.outer(n, headings)))
    by_sine = np.einsum("jni,nm->jmi", c[:, :, 1], np.sin(np.outer(n, headings)))
    return ForceRAO(frequencies, headings, by_cosine + by_sine)


@pytest.mark.parametrize("spreading", [None, 2.0])
@pytest.mark.parametrize("heading", [0.0, 0.8, -2.5])
def test_the_force_is_the_sum_of_all_components_forces(heading, spreading):
    """Re(a F(omega, beta) e^{i theta}), summed by NumPy with F by interpolation at a heading that is given."""
    rao = some_rao(steps=360 if spreading else 24)
    sea = Sea(Jonswap(1.0, 5.0), heading + math.radians(75.0), components=12, spreading=spreading)
    term = WaveLoads(sea, rao=rao).terms(barge(), np.zeros(3))[0]
    position, time = (3.0, -4.0, 0.2), 7.0
    pose = pose_from_parts((math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading)), position)
    own = np.array(to_fossen(term.function(term.parameters, pose, time)))
    values, expected = rao.at(sea.frequencies), np.zeros(6)
    for j, (omega, k, direction) in enumerate(
        zip(sea.frequencies, sea.wave_numbers, sea.directions, strict=True)
    ):
        beta = (direction - heading) % (2.0 * math.pi)
        nearest = np.abs(np.angle(np.exp(1j * (rao.headings - beta)))).argmin()
        theta = omega * time + sea.phases[j] - k * (math.cos(direction) * 3.0 - math.sin(direction) * 4.0)
        expected += sea.amplitudes[j] * np.real(values[j, nearest] * np.exp(1j * theta))
    tolerance = 1e-12 if spreading is None else 0.02
    np.testing.assert_allclose(own, expected, atol=tolerance * np.abs(expected).max())


def float_upright(parameters, pose, time):
    """Linear restoring, of small angles: -C (z, roll, pitch)."""
    down, z = world_down_in_body(pose.real), pose_position(pose)[2]
    c, roll, pitch = parameters, down[1], -down[0]
    heave = c[0] * z + c[1] * pitch
    return Spatial((-c[2] * roll, -(c[1] * z + c[3] * pitch), 0.0), (0.0, 0.0, -heave))


def test_a_hull_in_a_regular_sea_moves_as_the_linear_equations_say():
    """Simulated until start-up has died away; amplitude and phase of heave, roll and pitch."""
    vehicle, c = barge(), stiffness()
    sea = Sea(Jonswap(0.02, 4.0), 0.9, components=1)
    omega, a = float(sea.frequencies[0]), float(sea.amplitudes[0])
    restoring = ForceTerm("floats", float_upright, (c[0, 0], c[0, 2], c[1, 1], c[2, 2]))
    terms = (restoring, *WaveLoads(sea, stiffness=c).terms(vehicle, np.zeros(3)))
    body = make_body(vehicle.mass_matrix, 0.02, linear=vehicle.linear_damping, forces=terms)
    body.step(steps=12_000)
    times, measured, places, headings = [], [], [], []
    for _ in range(200):
        body.step(steps=5)
        q = body.quaternion_body_to_ned
        times.append(body.time)
        down = world_down_in_body(tuple(q.tolist()))
        measured.append([body.position_ned[2], down[1], -down[0]])
        places.append(body.position_ned[:2])
        headings.append(2.0 * q[3])
    basis = np.stack([np.cos(omega * np.array(times)), -np.sin(omega * np.array(times))], axis=1)
    parts = np.linalg.lstsq(basis, np.array(measured), rcond=None)[0]
    # Start-up left the hull somewhere else, on another heading.
    travelled = float(sea.wave_numbers[0]) * np.mean(places, axis=0) @ [math.cos(0.9), math.sin(0.9)]
    own = (parts[0] + 1j * parts[1]) * np.exp(1j * (travelled - float(sea.phases[0]))) / a
    beta = 0.9 - np.mean(headings)
    both = np.concatenate([answer(sea, vehicle)[:, 2:5].real, answer(sea, vehicle)[:, 2:5].imag], axis=1)
    expected = np.array([np.interp(beta, HEADINGS, column) for column in both.T])
    np.testing.assert_allclose(
        own, expected[:3] + 1j * expected[3:], rtol=0.015
    )  # 1 % is the series in the heading


@pytest.mark.sweep  # tests/physics/hydrostatics/test_hull.py has boxes in lanes
def test_hulls_in_lanes_have_the_bits_of_a_single_one():
    """In all that weather can do to them: waves from all sides, their slow drift, and gusts."""
    sea = Sea(Jonswap(0.5, 4.0), components=5, spreading=1.0)
    gusts = Wind(12.0, 2.0, Windage(0.4, 1.1, 2.0, 10.0), gusts=True, components=7)
    weather = [WaveLoads(sea, rao=some_rao()), SlowDrift(sea, COEFFICIENTS), gusts]
    scene = Scene(barge(), weather=weather, current=(0.2, 0.1, 0.0))
    batch, single = scene.batch(3), scene.stepper()
    for body in (batch, single):
        body.reset((1.0, 2.0, 0.0), (0.8, 0.0, 0.0, 0.6))
        body.step(steps=20)
    assert np.array_equal(batch.get_state()[2], single.get_state())
    assert np.abs(single.velocity_body).max() > 1e-6


@pytest.mark.sweep
def test_a_vessel_of_the_catalogue_rides_a_long_swell():
    """Its own hydrostatics are found; it rises and falls with the surface where it is, wind or not."""
    swell = Sea(Jonswap(0.3, 12.0), 0.7, components=1)
    scene = Scene("otter", weather=[swell, SlowDrift(swell), Wind(3.0, 0.7)])
    assert {"waves", "slow drift", "wind", "waterplane restoring"} <= set(scene.terms)
    body = scene.stepper()
    body.step(steps=2000)
    heights, surface = [], []
    for _ in range(48):
        body.step(steps=25)
        north, east, down = body.position_ned
        heights.append(-down)
        surface.append(float(swell.elevation(body.time, north, east)))
    heights, surface = np.array(heights) - np.mean(heights), np.array(surface) - np.mean(surface)
    assert np.abs(heights - surface).max() < 0.05 * surface.max()


# Transfer functions


def test_few_harmonics_follow_what_a_few_can_say():
    rao = some_rao(orders=4)
    series = np.array(rao.series(np.array([0.5, 1.0]), np.ones(2)))
    assert series.shape == (2, 4, 2, 6)
    beta, n = np.arange(24) * math.radians(15.0), np.arange(4)
    again = np.einsum("jni,nm->jmi", series[:, :, 0], np.cos(np.outer(n, beta)))
    again += np.einsum("jni,nm->jmi", series[:, :, 1], np.sin(np.outer(n, beta)))
    np.testing.assert_allclose(again, rao.transfer[:2], atol=1e-12)


def test_short_waves_have_more_harmonics():
    """A hull is as long as half a long wave, and as five short ones, which turn with it."""
    sea = Sea(Jonswap(0.05, 2.2, gamma=1.0), components=20)
    series = long_wave_rao(sea, barge(), stiffness()).series(sea.frequencies, sea.amplitudes)
    harmonics = [len(one) for one in series]
    assert harmonics[0] < harmonics[-1]
    assert all(one.shape[1:] == (2, 6) for one in series)


def test_a_symmetric_hull_is_told_by_one_side():
    full = long_wave_rao(Sea(Jonswap(0.2, 4.0), components=3), barge(), stiffness())
    half = ForceRAO(full.frequencies, full.headings[:37], full.transfer[:, :37])
    again = half.mirrored()
    np.testing.assert_allclose(again.headings, full.headings, atol=1e-12)
    np.testing.assert_allclose(again.transfer, full.transfer, atol=1e-9 * np.abs(full.transfer).max())


def test_files_say_the_same(tmp_path):
    rao = some_rao()
    parts = {
        "frequencies": rao.frequencies,
        "headings": rao.headings,
        "real": rao.transfer.real,
        "imaginary": rao.transfer.imag,
    }
    np.savez(tmp_path / "rao.npz", **parts)
    (tmp_path / "rao.json").write_text(json.dumps({name: part.tolist() for name, part in parts.items()}))
    lines = ["frequency,heading,axis,amplitude,phase"]
    for (j, m, i), value in np.ndenumerate(rao.transfer):
        frequency, heading = float(rao.frequencies[j]), float(rao.headings[m])
        lines.append(
            f"{frequency!r},{heading!r},{'XYZKMN'[i]},{float(abs(value))!r},{float(np.angle(value))!r}"
        )
    (tmp_path / "rao.csv").write_text("\n".join(lines))
    for name in ("rao.npz", "rao.json", "rao.csv"):
        again = read_force_rao(tmp_path / name)
        np.testing.assert_allclose(again.transfer, rao.transfer, atol=1e-12)
        assert np.array_equal(again.headings, rao.headings)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("rao.csv", "frequency,heading\n1,0\n", "columns"),
        ("rao.csv", "frequency,heading,axis,amplitude,phase\n1,0,Q,1,0\n", "axis = 'Q'"),
        ("rao.csv", "frequency,heading,axis,amplitude,phase\n1,0,X,1,0\n2,1,X,1,0\n", "all headings"),
        ("rao.csv", "frequency,heading,axis,amplitude,phase\n1,0,X,many,0\n", "many"),
        ("rao.json", "{}", "entries"),
        ("rao.json", "{", "cannot be read"),
        ("rao.txt", "", "is no"),
        ("rao.npz", "nothing", "cannot be read"),
        ("rao.npz", "", "cannot be read.*whole file"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(InvalidInputError, match=message):
        read_force_rao(tmp_path / name)


def test_what_is_no_transfer_function_is_refused():
    rao, sea = some_rao(), Sea(Jonswap(0.5, 4.0), components=3)
    with pytest.raises(InvalidInputError, match="shape"):
        ForceRAO(rao.frequencies, rao.headings, rao.transfer[:2])
    with pytest.raises(InvalidInputError, match="rise"):
        ForceRAO(rao.frequencies[::-1], rao.headings, rao.transfer)
    with pytest.raises(InvalidInputError, match="less than a turn"):
        ForceRAO(rao.frequencies, rao.headings * 2.0, rao.transfer)
    with pytest.raises(InvalidInputError, match="gap"):
        ForceRAO(rao.frequencies, rao.headings[:13], rao.transfer[:, :13]).term(sea)
    with pytest.raises(InvalidInputError, match="nothing else"):
        WaveLoads(sea, rao=rao, stiffness=np.eye(3))
    with pytest.raises(InvalidInputError, match="3 x 3"):
        WaveLoads(sea, stiffness=np.zeros((3, 3)))
    with pytest.raises(InvalidInputError, match="draft"):
        WaveLoads(Sea(Jonswap(0.1, 4.0), depth=0.2), stiffness=stiffness()).terms(barge(), np.zeros(3))
    with pytest.raises(InvalidInputError, match=r"added_mass.*shape"):
        Radiation(np.array([1.0, 2.0]), np.zeros((3, 6, 6)), np.zeros((2, 6, 6)))
    with pytest.raises(InvalidInputError, match="frequencies"):
        Radiation(np.array([1.0, np.nan]), np.zeros((2, 6, 6)), np.zeros((2, 6, 6)))
