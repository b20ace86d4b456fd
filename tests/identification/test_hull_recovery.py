"""An MMG hull's polynomials are found from the motion of a ship model: towed and pushed, or steered by its rudder."""

from __future__ import annotations

import numpy as np
import pytest
from identification.logs import written

from dq_marine import Scene, load_vehicle
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.identification import Conditions, fit_vehicle, read_log
from dq_marine.identification.parameters import parameters_of, quantities_of, vehicle_with

GROUPS = ("manoeuvring",)
STEP, PERIOD = 0.1, 0.2
MOTION = (
    *("time_s", "roll_deg", "pitch_deg", "heading_deg"),
    *("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"),
)
WRENCH = ("X_N", "Y_N", "Z_N", "K_N_m", "M_N_m", "N_N_m")
COMMANDS = ("command_propeller_rad_s", "command_rudder_rad")
SMALL = ("hull, surge, X'_vr", "hull, surge, X'_vv", "hull, sway, Y'_rrr", "hull, yaw, N'_vvv")
"""What a short log does not tell: held, and the others are right if these are."""

ON_A_FREE_COURSE = ("hull, sway, Y'_vvr", "hull, yaw, N'_rrr")
SHARP_IN_TEN_MINUTES = (
    *("hull, surge, R'_0", "hull, sway, Y'_v", "hull, sway, Y'_r"),
    *("hull, yaw, N'_v", "hull, yaw, N'_r", "hull, yaw, N'_vvr", "hull, yaw, N'_vrr", "hull, yaw, N'_rrr"),
)
LOW = {"wrench": (36.0, -400.0, 0.0, 0.0, 0.0, -700.0), "thrusters": (40.0, -0.61)}
HIGH = {"wrench": (96.0, 400.0, 0.0, 0.0, 0.0, 700.0), "thrusters": (74.0, 0.61)}


def rows_of(vehicle, seconds, actuation):
    """Anew every ten seconds: forces ahead and across and a moment; or the shaft's speed and the rudder."""
    rng = np.random.default_rng(1)
    body = Scene(vehicle, step=STEP, actuation=actuation).stepper()
    body.reset((0.0, 0.0, vehicle.equilibrium_depth), velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    for k in range(round(seconds / PERIOD) + 1):
        if k % 50 == 0:
            drive = rng.uniform(LOW[actuation], HIGH[actuation])
        angles = np.degrees(attitude_angles(body.quaternion_body_to_ned)) + rng.normal(0.0, 0.1, 3)
        velocity = body.velocity_body + np.repeat([0.005, 0.001], 3) * rng.normal(size=6)
        yield (k * PERIOD, *angles, *velocity, *drive)
        (body.step if actuation == "wrench" else body.actuate)(drive, round(PERIOD / STEP))


def changed_hull(nominal, as_filed):
    """Return the ship with each coefficient changed by up to 30 % but those of some labels."""
    parameters = [one for one in parameters_of(nominal, GROUPS) if one.label not in as_filed]
    theta = np.random.default_rng(3).uniform(-0.3, 0.3, len(parameters))
    return vehicle_with(nominal, parameters, theta)


def fitted(tmp_path, seconds, actuation, as_filed):
    """Return the fit, and how far each number is off as a share; in standard errors it is as they say."""
    nominal = load_vehicle("kvlcc2_l7")
    true = changed_hull(nominal, as_filed)
    columns = MOTION + (WRENCH if actuation == "wrench" else COMMANDS)
    path = written(tmp_path / "run.csv", rows_of(true, seconds, actuation), columns)
    fit = fit_vehicle(nominal, read_log(path, nominal), Conditions(GROUPS, step=STEP))
    expected = {one.label: one.value for one in quantities_of(true, parameters_of(nominal, GROUPS))}
    off = {one.label: one.value - expected[one.label] for one in fit.estimates}
    scores = [off[one.label] / one.standard_error for one in fit.estimates]
    assert np.abs(scores).max() < 3.5, scores
    assert 0.4 < np.sqrt(np.mean(np.square(scores))) < 1.7, scores
    return fit, {label: abs(value / expected[label]) for label, value in off.items()}


@pytest.mark.sweep  # tests/identification/test_fit_command.py recovers a vehicle
@pytest.mark.parametrize("seconds", [200.0, 600.0])
def test_a_model_that_is_pushed_about_tells_its_polynomials(tmp_path, seconds):
    """Up to 30 degrees of drift and r' = 2; X'_vr, a tenth of a per cent of the resistance, is not told, and held."""
    small = SMALL if seconds < 600.0 else ()
    fit, errors = fitted(tmp_path, seconds, "wrench", small)
    sharp = {one.label for one in fit.estimates if one.standard_error < 0.007 * abs(one.value)}
    if seconds == 600.0:
        assert set(SHARP_IN_TEN_MINUTES) <= sharp
    for label in sharp | {"hull, sway, Y'_v", "hull, yaw, N'_v", "hull, yaw, N'_r"}:
        assert errors[label] < 0.02, label
    held = {label for label, _ in fit.held}
    assert "hull, surge, X'_vr" in held
    unchanged = fit.vehicle.manoeuvring.hull.surge.vr, fit.nominal.manoeuvring.hull.surge.vr
    assert unchanged[0] == unchanged[1]


@pytest.mark.sweep
def test_a_model_that_is_steered_tells_what_is_linear_and_says_what_it_does_not(tmp_path):
    """Drift and turning go together on a free course: their products are named, and held (Hwang 1980)."""
    fit, errors = fitted(tmp_path, 600.0, "thrusters", (*SMALL, *ON_A_FREE_COURSE))
    for label in ("hull, sway, Y'_v", "hull, sway, Y'_r", "hull, yaw, N'_v", "hull, yaw, N'_r"):
        assert errors[label] < 0.02
    held = {label for label, _ in fit.held}
    assert {"hull, surge, X'_vr", "hull, sway, Y'_rrr", "hull, sway, Y'_vvr"} <= held
    assert all(label in fit.notes[0] for label in held)
