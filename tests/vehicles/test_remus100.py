"""REMUS 100: its estimates computed anew, and its runs beside the equations of Prestero (2001) integrated by SciPy."""

import math

import numpy as np
import pytest
from support.remus import PRESTERO, REVISED, mss_propeller, run

from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

DENSITY = 1030.0
FIN_AREA, FIN_ARM = 0.00665, 0.6827
FULL, SLOW = 159.7, 95.8
FOUR_DEGREES = math.radians(4.0)
DIAMETER, NOSE, MIDDLE, TAIL, CUT_NOSE, CUT_TAIL = 0.191, 0.191, 0.654, 0.541, 0.0165, 0.0368


def hull():
    """Return x ahead of the origin and radius of the Myring hull of Prestero (2001), section 2.1."""
    x = np.linspace(0.0, NOSE + MIDDLE + TAIL - CUT_NOSE - CUT_TAIL, 4001)
    behind = x - (NOSE + MIDDLE - CUT_NOSE)
    slope = math.tan(math.radians(25.0))
    nose = 0.5 * DIAMETER * np.sqrt(np.maximum(1.0 - ((x + CUT_NOSE - NOSE) / NOSE) ** 2, 0.0))
    tail = (
        0.5 * DIAMETER
        - (1.5 * DIAMETER / TAIL**2 - slope / TAIL) * behind**2
        + (DIAMETER / TAIL**3 - slope / TAIL**2) * behind**3
    )
    radius = np.where(x < NOSE - CUT_NOSE, nose, np.where(behind > 0.0, tail, 0.5 * DIAMETER))
    return 0.611 - x, radius


def remus(commands, duration, speed=0.0):
    body = Scene("remus100", step=0.01, actuation="thrusters").stepper()
    body.reset((0.0, 0.0, 100.0), velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.actuate(commands, round(duration / 0.01))
    return body


def by_scipy(duration, shaft_speed=SLOW, **helm):
    return run(REVISED, duration, lambda surge: mss_propeller(shaft_speed, surge), **helm)


def test_theoretical_drag_is_that_of_strips_over_the_hull():
    """Prestero (2001): C_d = 1.1 on the hull and 0.558 on two fins. His moments, rounded otherwise, are 8 % above."""
    x, radius = hull()
    fins = DENSITY * FIN_AREA * 0.558
    side = np.trapezoid(DENSITY * 1.1 * radius, -x) + fins
    moment = np.trapezoid(DENSITY * 1.1 * radius * np.abs(x) ** 3, -x) + fins * FIN_ARM**3
    drag = load_vehicle("remus100").quadratic_damping
    assert drag[[1, 2]] == pytest.approx(side, rel=0.02)
    assert drag[[4, 5]] == pytest.approx(moment, rel=0.1)


def test_fins_and_lift_are_their_formulas():
    slope = 1.0 / (1.0 / (1.8 * math.pi) + 1.0 / (2.21 * math.pi))
    vehicle = load_vehicle("remus100")
    rudder, planes = (np.array(fin.coefficients) for fin in vehicle.fins)
    assert planes[[2, 4]] == pytest.approx(-DENSITY * slope * FIN_AREA * np.array([1.0, FIN_ARM]), rel=2e-3)
    assert rudder[[1, 5]] * 3.5 == pytest.approx(planes[[2, 4]] * [-1.0, 1.0], rel=1e-4)
    lift = 0.5 * DENSITY * (1.2 * DIAMETER**2 + slope * FIN_AREA) + 15.7 / 1.543
    assert vehicle.damping_couplings[1, 1, 0] == pytest.approx(lift, rel=2e-3)


def test_prestero_circles_without_helm_and_the_revision_does_not():
    """From a rudder of a millionth: the adjusted set ends at 6.3 deg/s; that of the file answers in proportion."""
    adrift = run(PRESTERO, 120.0, lambda _: (3.86, 0.0), rudder=1e-6, speed=1.5)
    assert math.degrees(abs(adrift[5])) == pytest.approx(6.3, abs=0.2)
    neutral = REVISED | {"net_buoyancy": 0.0}
    steady = run(neutral, 120.0, lambda u: (mss_propeller(SLOW, u)[0], 0.0), rudder=1e-6, speed=1.5)
    assert math.degrees(abs(steady[5])) < 1e-3


@pytest.mark.parametrize(("shaft_speed", "expected"), [(SLOW, 1.526), (FULL, 2.548)])
def test_hands_off_it_goes_straight_but_for_the_propellers_torque(shaft_speed, expected):
    """2.5 m/s (5 knots) at 1525 rpm; a roll that its weight holds, and less than half a degree per second."""
    body = remus((shaft_speed, 0.0, 0.0), 120.0)
    assert body.velocity_body[0] == pytest.approx(expected, rel=5e-3)
    assert 0.0 < -math.degrees(body.velocity_body[5]) < 0.5


@pytest.mark.parametrize(("rudder", "planes"), [(0.0, 0.0), (FOUR_DEGREES, 0.0), (0.0, FOUR_DEGREES)])
def test_it_moves_by_presteros_equations(rudder, planes):
    body = remus((SLOW, rudder, planes), 10.0, speed=1.54)
    expected = by_scipy(10.0, rudder=rudder, planes=planes, speed=1.54)
    assert body.velocity_body == pytest.approx(expected[:6], rel=2e-2, abs=2e-3)
    assert body.position_ned[2] - 100.0 == pytest.approx(expected[9], rel=2e-2, abs=5e-3)


def test_four_degrees_of_rudder_turn_it_as_the_set_adjusted_to_trials():
    adjusted = run(PRESTERO, 120.0, lambda _: (3.86, 0.0), rudder=FOUR_DEGREES, speed=1.5)
    assert math.degrees(adjusted[5]) == pytest.approx(-8.925, abs=0.01)
    assert remus((SLOW, FOUR_DEGREES, 0.0), 60.0).velocity_body[5] == pytest.approx(adjusted[5], rel=0.2)


def test_four_degrees_of_planes_pitch_it_as_the_set_adjusted_to_trials():
    """The first swing, and the depth in ten seconds."""
    adjusted = [run(PRESTERO, t, lambda _: (3.86, 0.0), planes=FOUR_DEGREES, speed=1.54) for t in (8.0, 10.0)]
    swing = min(by_scipy(t, planes=FOUR_DEGREES, speed=1.54)[7] for t in (4.0, 5.0, 6.0))
    assert swing == pytest.approx(adjusted[0][7], rel=0.2)
    dive = remus((SLOW, 0.0, FOUR_DEGREES), 10.0, speed=1.54).position_ned[2] - 100.0
    assert dive == pytest.approx(adjusted[1][9], rel=0.2)
