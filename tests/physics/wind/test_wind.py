"""Wind: its signs from all sides, Fossen's formula, gusts of their spectrum, and a current that carries the vessel."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.bodies import PlainBody, make_body

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import Spatial, to_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.physics.weather import Wind, Windage
from dq_marine.physics.wind.gusts import gust_spectrum, mean_speed
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

STILL = np.zeros(3)
HOLD = Windage(frontal_area=0.4, lateral_area=1.1, length=2.0, height=10.0, above_origin=0.5)
REST = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def force_of(wind, heading=0.0, velocity=(0.0, 0.0, 0.0), current=STILL, time=0.0):
    term = wind.terms(load_vehicle("bluerov2_heavy"), np.asarray(current))[0]
    pose = pose_from_parts((math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading)), (0.0, 0.0, 0.0))
    return np.array(to_fossen(term.function(term.parameters, pose, Spatial((0.0, 0.0, 0.0), velocity), time)))


@pytest.mark.parametrize("heading", [0.0, 1.2, -2.9])
def test_wind_pushes_away_from_where_it_comes(heading):
    """From ahead: back. From astern: ahead. From port: to starboard, and heels that way. From starboard: to port."""
    from_ahead, from_starboard, from_astern, from_port = (
        force_of(Wind(10.0, heading + angle, HOLD), heading) for angle in np.arange(4) * 0.5 * math.pi
    )
    assert from_ahead[0] < 0.0 < from_astern[0]
    assert from_starboard[1] < 0.0 < from_port[1]
    assert from_starboard[3] < 0.0 < from_port[3]
    np.testing.assert_allclose(from_ahead + from_astern, 0.0, atol=1e-12)
    np.testing.assert_allclose(from_port + from_starboard, 0.0, atol=1e-12)
    assert np.abs(from_ahead[[1, 2, 5]]).max() < 1e-12
    assert np.abs(from_port[[0, 2, 5]]).max() < 1e-12


@pytest.mark.parametrize("angle", np.linspace(-3.0, 3.0, 13))
def test_the_force_is_fossens(angle):
    """X = q C_X A_F, Y = q C_Y A_L, N = q C_N A_L L with gamma by atan2, for a vessel under way."""
    nu, wind_speed, heading = np.array([1.5, -0.4]), 8.0, 0.7
    wind = Wind(wind_speed, angle, HOLD)
    u_w, v_w = (wind_speed * f(angle + math.pi - heading) for f in (math.cos, math.sin))
    u, v = nu[0] - u_w, nu[1] - v_w
    gamma, q = -math.atan2(v, u), 0.5 * 1.225 * (u * u + v * v)
    x, y = -q * 0.7 * math.cos(gamma) * 0.4, q * 0.8 * math.sin(gamma) * 1.1
    n = q * 0.1 * math.sin(2.0 * gamma) * 1.1 * 2.0
    expected = [x, y, 0.0, 0.5 * y, -0.5 * x, n]
    np.testing.assert_allclose(force_of(wind, heading, (1.5, -0.4, 0.0)), expected, atol=1e-12)


def test_a_vessel_adrift_with_the_current_feels_the_wind_over_it():
    """Carried at 0.5 m/s into 0.5 m/s of wind from ahead there are 1 m/s over deck; along with it, none."""
    wind = Wind(0.5, 0.0, HOLD)
    ahead = force_of(wind, current=(0.5, 0.0, 0.0))
    np.testing.assert_allclose(ahead, force_of(wind, velocity=(0.5, 0.0, 0.0)), atol=1e-15)
    np.testing.assert_allclose(force_of(wind, current=(-0.5, 0.0, 0.0)), 0.0, atol=1e-15)


def test_a_vessel_before_the_wind_runs_as_scipy_says():
    """M u' = q A c - d u - e |u| u, with the hull's drag; second order in the step."""
    wind = Wind(12.0, math.pi, Windage(**(vars(HOLD) | {"above_origin": 0.0})))

    def rate(_, u):
        over = 12.0 - u
        return (0.5 * 1.225 * 0.7 * 0.4 * over * abs(over) - 5.0 * u - 20.0 * abs(u) * u) / 30.0

    reference = solve_ivp(rate, (0.0, 3.0), [0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[0, -1]
    terms, measured = wind.terms(load_vehicle("bluerov2_heavy"), STILL), []
    for step in (0.1, 0.05):
        drag = {"linear": 5.0 * np.eye(6), "quadratic": np.full(6, 20.0)}
        body = make_body(30.0 * np.eye(6), step, forces=terms, kind=PlainBody, **drag)
        body.step(steps=round(3.0 / step))
        measured.append(abs(body.velocity_body[0] - reference))
    assert measured[1] < 1e-4 * reference
    assert math.log2(measured[0] / measured[1]) == pytest.approx(2.0, abs=0.2)


@pytest.mark.sweep
def test_gusts_have_the_spectrums_energy_and_the_mean_wind():
    wind = Wind(
        15.0, math.pi, Windage(2.0 / 1.225, 0.0, 1.0, 10.0, c_x=1.0), gusts=True, components=60, seed=4
    )
    times = np.arange(0.0, 6000.0, 3.1)  # coarser than the fastest gusts: mean and variance do not mind
    speed = np.sqrt([force_of(wind, time=t)[0] for t in times.tolist()])  # X = V^2
    frequencies = np.geomspace(1.0 / 600.0, 0.5, 20_001)
    density = gust_spectrum(frequencies, 15.0, 10.0)
    variance = float((0.5 * (density[1:] + density[:-1]) * np.diff(frequencies)).sum())
    assert speed.mean() == pytest.approx(15.0, rel=0.02)
    assert speed.var() == pytest.approx(variance, rel=0.05)
    again = Wind(15.0, math.pi, wind.windage, gusts=True, components=60, seed=4)
    assert force_of(again, time=17.0).tolist() == force_of(wind, time=17.0).tolist()


def test_the_mean_wind_rises_with_the_height():
    """ISO 19901-1: at 20 m/s, C = 0.0573 sqrt(1 + 0.15 U) = 0.1146 per unit of the logarithm."""
    assert mean_speed(20.0, 10.0) == 20.0
    assert mean_speed(20.0, 10.0 * math.e) == pytest.approx(20.0 * 1.1146, rel=1e-4)
    assert mean_speed(20.0, 1.0) < 20.0


@pytest.mark.sweep  # with waves and their drift: waves/test_floating
def test_vessels_in_lanes_have_the_bits_of_a_single_one():
    scene = Scene(weather=[Wind(12.0, 2.0, HOLD, gusts=True, components=7)], current=(0.2, 0.1, 0.0))
    batch, single = scene.batch(3), scene.stepper()
    for body in (batch, single):
        body.reset((1.0, 2.0, 0.0), (0.8, 0.0, 0.0, 0.6))
        body.step(steps=40)
    assert np.array_equal(batch.get_state()[2], single.get_state())
    assert "wind" in scene.terms


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Wind(-1.0, 0.0), "speed = -1"),
        (lambda: Wind(500.0, 0.0), "0 to 100"),
        (lambda: Wind(5.0, math.nan), "direction_from"),
        (lambda: Wind(5.0, 0.0, windage=3.0), "Windage"),
        (lambda: Wind(5.0, 0.0, components=0), "components"),
        (lambda: Wind(5.0, 0.0, gusts=True, seed="x"), "seed"),
        (lambda: Windage(-1.0, 1.0, 1.0, 1.0), "frontal_area = -1"),
        (lambda: Scene(weather=[Wind(5.0, 0.0)]), "submerged"),
        (lambda: Scene(weather=Wind(5.0, 0.0)), "give a list"),
        (lambda: Scene(weather=["windy"]), "Wind"),
    ],
)
def test_what_is_no_wind_is_refused(make, message):
    with pytest.raises(InvalidInputError, match=message):
        make()
