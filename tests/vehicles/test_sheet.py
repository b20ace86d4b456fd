"""A vehicle's sheet against closed forms and against motions of the integrator."""

import json
import math

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.physics.hydrostatics.restoring import natural_periods, restoring_frequencies
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, ellipsoid, load_vehicle, spheroid, vehicle_names, vehicle_sheet
from dq_marine.vehicles.analysis.munk import munk_growth_rate
from dq_marine.vehicles.coupling import asymmetry, largest_coupling

MUNK_RATE = 2.301752703506763
"""Of the neutral spheroid 0.5 x 0.125 m at 1 m/s [1/s]."""


def turned(vehicle, rotation):
    """A vehicle whose body axes are turned: M becomes R M R^T in both blocks."""
    both = np.kron(np.eye(2), rotation)
    content = vehicle.model_dump()
    content["added_mass"] = (both @ np.array(vehicle.added_mass) @ both.T).tolist()
    inertia = rotation @ np.array(vehicle.rigid_body.inertia) @ rotation.T
    content["rigid_body"] = content["rigid_body"] | {"inertia": inertia.tolist()}
    return Vehicle.model_validate(content)


# Munk


def test_the_spheroids_growth_rate_is_munks():
    assert munk_growth_rate(spheroid(0.5, 0.125)) == pytest.approx(MUNK_RATE, rel=1e-9)
    assert munk_growth_rate(spheroid(0.5, 0.125), 3.0) == pytest.approx(3.0 * MUNK_RATE, rel=1e-9)


def test_of_two_unstable_axes_the_faster_counts():
    vehicle = ellipsoid(0.5, 0.2, 0.1)
    m = np.diag(vehicle.mass_matrix)
    rates = [math.sqrt(m[0] * (m[i] - m[0]) / (m[i] * m[j])) for i, j in ((2, 4), (1, 5))]
    assert munk_growth_rate(vehicle) == pytest.approx(max(rates), rel=1e-12)


@pytest.mark.parametrize("axes", [(0.3, 0.3, 0.3), (0.1, 0.4, 0.4)])
def test_a_sphere_and_a_disc_ahead_have_no_growing_deviation(axes):
    assert munk_growth_rate(ellipsoid(*axes)) == 0.0
    assert vehicle_sheet(ellipsoid(*axes)).translation_step == math.inf


def test_turning_the_axes_about_x_changes_nothing():
    vehicle = load_vehicle("rexrov")
    assert munk_growth_rate(turned(vehicle, np.diag([1.0, -1.0, -1.0]))) == pytest.approx(
        munk_growth_rate(vehicle)
    )


def test_a_deviation_of_the_integrated_motion_grows_at_the_rate():
    """A coupled, undamped, neutral torpedo at 1 m/s, held by the wrench that balances its steady motion."""
    content = load_vehicle("remus100").model_dump()
    content["damping"] = content["damping"] | {"quadratic": (0.0,) * 6, "couplings": ()}
    content["rigid_body"] = content["rigid_body"] | {"center_of_mass": (0.0, 0.0, 0.0)}
    content["buoyancy"] = content["buoyancy"] | {"volume": 30.48 / 1030.0}
    vehicle = Vehicle.model_validate(content)
    body = Scene(vehicle, step=0.002).stepper()
    body.reset(velocity_body=(1.0, 1e-7, 0.0, 0.0, 0.0, 0.0))
    rate = munk_growth_rate(vehicle)
    sways = []
    for _ in range(2):
        body.step(steps=round(4.0 / rate / 0.002))
        sways.append(abs(body.velocity_body[1]))
    duration = 0.002 * round(4.0 / rate / 0.002)
    assert math.log(sways[1] / sways[0]) / duration == pytest.approx(rate, rel=2e-3)


# Roll and pitch


def test_periods_are_the_scenes_and_told_apart():
    vehicle = load_vehicle("npsauv")
    roll, pitch = natural_periods(vehicle)
    assert roll < pitch
    assert np.allclose(sorted((roll, pitch)), np.sort(2.0 * np.pi / Scene(vehicle).restoring_frequencies))
    heavy = load_vehicle("bluerov2_heavy")
    arm, m = heavy.restoring_arm[2], heavy.mass_matrix
    expected = [2.0 * math.pi * math.sqrt(m[i, i] / arm) for i in (3, 4)]
    assert np.allclose(natural_periods(heavy), expected, rtol=1e-12)


def test_without_a_righting_moment_there_is_no_period():
    sheet = vehicle_sheet(spheroid(0.5, 0.125))
    assert (sheet.roll_period, sheet.pitch_period, sheet.restoring_step) == (math.inf,) * 3
    assert sheet.largest_step == sheet.translation_step == pytest.approx(2.0 / MUNK_RATE)
    assert sheet.as_dict()["roll_period"] is None


@pytest.mark.parametrize("name", vehicle_names())
def test_the_largest_restoring_step_is_where_a_scene_refuses(name):
    limit = vehicle_sheet(load_vehicle(name)).restoring_step
    assert limit == pytest.approx(2.0 / restoring_frequencies(load_vehicle(name)).max())
    Scene(name, step=0.999 * limit)
    with pytest.raises(InvalidInputError, match="too large for the restoring forces"):
        Scene(name, step=1.001 * limit)


# Speeds


def test_terminal_speed_of_a_known_case():
    """Linear 13.7, quadratic 141, F = 40 N: 0.4862530975891999 m/s; without one of the two, and without both."""

    def surge(linear, quadratic, limit=40.0):
        rest = [0.0] * 5
        vehicle = spheroid(
            0.3,
            0.1,
            linear_damping=[linear, *rest],
            quadratic_damping=[quadratic, *rest],
            wrench_limits=[limit, *rest[1:], 1.0],
        )
        return vehicle_sheet(vehicle).terminal_speed["surge"]

    assert surge(13.7, 141.0) == pytest.approx(0.4862530975891999, rel=1e-14)
    assert surge(0.0, 141.0) == pytest.approx(0.5326236412913075, rel=1e-14)
    assert surge(10.0, 0.0) == pytest.approx(4.0, rel=1e-14)
    assert surge(0.0, 0.0) == math.inf
    assert surge(13.7, 141.0, limit=0.0) == 0.0


def test_the_integrated_vehicle_reaches_its_terminal_rate():
    """In yaw, which neither its net weight nor its righting moment disturbs."""
    vehicle = load_vehicle("bluerov2_heavy")
    body = Scene(vehicle, step=0.02).stepper()
    body.step((0, 0, 0, 0, 0, vehicle.wrench_limits[5]), 250)
    assert body.velocity_body[5] == pytest.approx(vehicle_sheet(vehicle).terminal_speed["yaw"], rel=1e-6)


# Coupling


def test_coupling_is_free_of_units():
    vehicle = load_vehicle("rexrov")
    m = vehicle.mass_matrix
    size = np.diag([1.0, 1.0, 1.0, 100.0, 100.0, 100.0])
    assert largest_coupling(m).value == pytest.approx(largest_coupling(size @ m @ size).value)
    sheet = vehicle_sheet(vehicle)
    assert sheet.coupled == ("sway", "roll")
    assert sheet.coupling == pytest.approx(m[1, 3] / math.sqrt(m[1, 1] * m[3, 3]))
    assert vehicle_sheet(load_vehicle("bluerov2_heavy")).coupled == ()


def test_the_asymmetry_of_a_published_matrix_is_told():
    vehicle = load_vehicle("rexrov")
    assert np.array_equal(vehicle.mass_matrix, vehicle.mass_matrix.T)
    told = asymmetry(np.array(vehicle.added_mass), vehicle.mass_matrix)
    assert (told.row, told.column) == (2, 5)
    assert vehicle_sheet(vehicle).added_mass_asymmetry == told.value == pytest.approx(4.4e-7, rel=0.02)
    for exact in ("npsauv", "remus100"):
        assert vehicle_sheet(load_vehicle(exact)).added_mass_asymmetry == 0.0


# The sheet itself


@pytest.mark.parametrize("name", vehicle_names())
def test_every_sheet_is_json_and_consistent(name):
    vehicle = load_vehicle(name)
    sheet = vehicle_sheet(vehicle, speed=0.5)
    content = json.loads(json.dumps(sheet.as_dict(), allow_nan=False))
    assert content["dry_mass"] == vehicle.rigid_body.mass
    assert content["speed"] == 0.5
    assert content["condition_number"] >= content["unit_free_condition_number"] >= 1.0
    assert 0.0 <= content["coupling"] < 1.0
    assert content["largest_step"] == min(sheet.restoring_step, sheet.translation_step)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan])
def test_a_sheet_needs_a_speed(speed):
    with pytest.raises(InvalidInputError, match="speed"):
        vehicle_sheet(load_vehicle("rexrov"), speed=speed)
    with pytest.raises(InvalidInputError, match="speed"):
        munk_growth_rate(spheroid(1.0, 1.0), speed)


def test_terminal_speeds_of_a_ship_by_polynomials_are_balances_of_its_force():
    """About the vertical axis alone, where u' is held at -0.6; in surge: test_whole_ship_steering.py."""
    vehicle = load_vehicle("mariner")
    sheet, length = vehicle_sheet(vehicle), 160.93
    assert sheet.service_speed == 7.7175
    speed, u = 7.7175 / 0.6, -0.6
    r = sheet.terminal_speed["yaw"] * length / speed
    moment = -166e-5 * (1.0 + u) * r + 3e-5 * (1.0 + u) ** 2
    assert -0.5 * 1025.0 * length**3 * speed**2 * moment == pytest.approx(vehicle.wrench_limits[5], rel=1e-9)
    assert sheet.terminal_speed["sway"] == 0.0
    assert json.loads(json.dumps(sheet.as_dict()))["service_speed"] == 7.7175
    assert vehicle_sheet(load_vehicle("otter")).as_dict()["service_speed"] is None
