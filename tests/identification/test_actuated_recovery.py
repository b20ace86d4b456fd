"""An AUV driven by its propeller and fins: lift, drag and gains are found from commands."""

from __future__ import annotations

import numpy as np
import pytest
from identification.logs import PERIOD, STEP, changed, written

from dq_marine import Scene, load_vehicle
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.identification import Conditions, fit_vehicle, read_log
from dq_marine.identification.parameters import parameters_of, quantities_of

GROUPS = ("quadratic", "couplings", "gains")
COLUMNS = (
    *(
        "time_s",
        "roll_deg",
        "pitch_deg",
        "heading_deg",
        "u_m_s",
        "v_m_s",
        "w_m_s",
        "p_rad_s",
        "q_rad_s",
        "r_rad_s",
    ),
    *("command_propeller_rad_s", "command_rudder_rad", "command_stern_planes_rad"),
)


def lagging(vehicle):
    """Return the vehicle with a shaft and fins that take their time."""
    content = vehicle.model_dump()
    content["thrusters"][0]["time_constant"] = 1.5
    for fin in content["fins"]:
        fin["rate_limit_deg_s"] = 20.0
    return type(vehicle).model_validate(content)


def rows_of(vehicle, seconds):
    rng = np.random.default_rng(1)
    body, command = Scene(vehicle, step=STEP, actuation="thrusters").stepper(), np.zeros(3)
    for k in range(round(seconds / PERIOD) + 1):
        if k % 30 == 0:
            command = rng.uniform([60.0, -0.3, -0.1], [200.0, 0.3, 0.1])
        angles = np.degrees(attitude_angles(body.quaternion_body_to_ned)) + rng.normal(0.0, 0.1, 3)
        velocity = body.velocity_body + np.repeat([0.005, 0.002], 3) * rng.normal(size=6)
        yield (k * PERIOD, *angles, *velocity, *command)
        body.actuate(command, round(PERIOD / STEP))


@pytest.mark.sweep
def test_lift_drag_and_gains_of_an_auv(tmp_path):
    nominal = lagging(load_vehicle("remus100"))
    true = changed(nominal, GROUPS, 3, spread=0.3)
    path = written(tmp_path / "run.csv", rows_of(true, 120.0), COLUMNS)
    fit = fit_vehicle(nominal, read_log(path, nominal), Conditions(GROUPS, step=STEP))
    expected = {one.label: one.value for one in quantities_of(true, parameters_of(nominal, GROUPS))}
    found = {one.label: one for one in fit.estimates}
    assert {
        "quadratic damping, surge",
        "gain of propeller",
        "gain of rudder",
        "coupling, sway by |surge| sway",
    } <= set(found)
    for label, one in found.items():
        error = abs(one.value - expected[label])
        assert error < 4.0 * one.standard_error + 1e-3 * abs(one.value), label
        if one.standard_error < 0.005 * abs(one.value):
            assert error < 0.02 * abs(expected[label]), label
