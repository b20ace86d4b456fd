"""A current that nobody measured, found with the vehicle's numbers from noisy motion."""

from __future__ import annotations

import numpy as np
import pytest
from identification.logs import COLUMNS, GROUPS, PERIOD, STEP, changed, rov_log, written

from dq_marine import Scene, load_vehicle
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.identification import Conditions, fit_vehicle, read_log
from dq_marine.identification.parameters import parameters_of, quantities_of

SEED = 5
CURRENT = (0.2, -0.12, 0.0)
LABELS = ("current, north", "current, east")


@pytest.fixture(scope="module")
def nominal():
    return load_vehicle("bluerov2_heavy")


@pytest.fixture(scope="module")
def log(nominal, tmp_path_factory):
    rows = rov_log(SEED, 90.0, current=CURRENT)
    return read_log(written(tmp_path_factory.mktemp("log") / "run.csv", rows), nominal)


@pytest.fixture(scope="module")
def fit(nominal, log):
    return fit_vehicle(nominal, log, Conditions((*GROUPS, "current"), step=STEP))


def test_the_current_is_found_with_the_vehicles_numbers(nominal, fit):
    """Within its standard errors, which are millimetres a second, and it does no harm to the others."""
    found = {one.label: one for one in fit.estimates}
    for label, true in zip(LABELS, CURRENT, strict=False):
        assert abs(found[label].value - true) < 3.5 * found[label].standard_error < 0.02
        assert found[label].nominal == 0.0
        assert found[label].unit == "m/s"
    true = quantities_of(changed(nominal, GROUPS, SEED), parameters_of(nominal, GROUPS))
    scores = [(found[one.label].value - one.value) / found[one.label].standard_error for one in true]
    assert np.abs(scores).max() < 3.5
    assert not fit.held


@pytest.mark.sweep
def test_without_it_the_residuals_say_that_something_is_missing(nominal, log, fit):
    still = fit_vehicle(nominal, log, Conditions(GROUPS, step=STEP))
    assert any("such as a current" in note for note in still.notes)
    assert not any("such as a current" in note for note in fit.notes)
    assert still.noise[6:8].min() > 1.5 * fit.noise[6:8].max()


@pytest.mark.sweep
def test_it_may_be_all_that_is_free_and_begins_where_it_is_given(nominal, log, fit):
    """The vehicle that was found in the water that was found: from a guess that is 0.3 m/s off."""
    guess = (CURRENT[0] + 0.3, CURRENT[1], 0.0)
    again = fit_vehicle(fit.vehicle, log, Conditions(("current",), step=STEP, current=guess))
    assert [one.label for one in again.estimates] == list(LABELS)
    assert [one.nominal for one in again.estimates] == [guess[0], guess[1]]
    found = {one.label: one.value for one in fit.estimates}
    assert [one.value for one in again.estimates] == pytest.approx(
        [found[label] for label in LABELS], abs=1e-3
    )
    assert again.vehicle == fit.vehicle


@pytest.mark.sweep
def test_a_vessel_afloat_tells_it_too(tmp_path):
    """The Otter, by its propellers, with the noise of a receiver for position and velocity."""
    nominal, groups = load_vehicle("otter"), ("linear", "cross_flow")
    true = changed(nominal, groups, 4, spread=0.3)
    rng = np.random.default_rng(4)
    body = Scene(true, step=STEP, current=CURRENT, actuation="thrusters").stepper()
    body.reset((0.0, 0.0, nominal.equilibrium_depth), (1.0, 0.0, 0.0, 0.0), (0.0,) * 6)
    rows, speeds = [], np.zeros(2)
    for k in range(round(120.0 / PERIOD) + 1):
        if k % 50 == 0:
            speeds = rng.uniform(-20.0, 80.0, 2)
        position = body.position_ned[:2] + rng.normal(0.0, 0.3, 2)
        angles = np.degrees(attitude_angles(body.quaternion_body_to_ned)) + rng.normal(0.0, 0.2, 3)
        velocity = body.velocity_body + np.repeat([0.02, 0.003], 3) * rng.normal(size=6)
        rows.append((k * PERIOD, *position, *angles, *velocity, *speeds))
        body.actuate(speeds, round(PERIOD / STEP))
    columns = ("time_s", "north_m", "east_m", *COLUMNS[2:11], "command_port_rad_s", "command_starboard_rad_s")
    log = read_log(written(tmp_path / "run.csv", rows, columns), nominal)
    fit = fit_vehicle(nominal, log, Conditions((*groups, "current"), step=STEP))
    found = {one.label: one for one in fit.estimates}
    expected = {one.label: one.value for one in quantities_of(true, parameters_of(nominal, groups))}
    for label, value in (expected | dict(zip(LABELS, CURRENT, strict=False))).items():
        assert abs(found[label].value - value) < 4.0 * found[label].standard_error, label
    assert max(found[label].standard_error for label in LABELS) < 0.01
