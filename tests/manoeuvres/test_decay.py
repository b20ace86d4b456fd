"""Free decay: linear oscillators in closed form, quadratic ones by SciPy, both with an offset."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import newton
from setups import mass_of, righted_sphere, sphere

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import decay
from dq_marine.manoeuvres.decrement import decrement_of
from dq_marine.manoeuvres.linear_modes import stiffness_matrix
from dq_marine.physics.hydrostatics.restoring import natural_periods
from dq_marine.physics.radiation.build import memory_term
from dq_marine.vehicles import load_vehicle

SMALL = math.radians(1.0)


@pytest.mark.parametrize("motion", ["roll", "pitch"])
def test_period_and_damping_ratio_of_a_linear_oscillator(motion):
    vehicle = righted_sphere((40.0, 90.0, 90.0, 6.0, 6.0, 8.0))
    axis = {"roll": 3, "pitch": 4}[motion]
    inertia, damping = mass_of(vehicle)[axis], 6.0
    frequency = math.sqrt(vehicle.buoyant_force * 0.02 / inertia)
    ratio = damping / (2.0 * inertia * frequency)
    period = 2.0 * math.pi / (frequency * math.sqrt(1.0 - ratio**2))
    result = decay(vehicle, motion=motion, release=SMALL)
    assert result.decrement.period == pytest.approx(period, rel=1e-3)
    assert result.decrement.damping_ratio == pytest.approx(ratio, rel=1e-2)
    assert result.decrement.linear_ratio == pytest.approx(ratio, rel=1e-2)
    assert result.prediction.period == pytest.approx(period, rel=1e-9)
    assert result.prediction.damping_ratio == pytest.approx(ratio, rel=1e-9)


def test_the_linear_equations_agree_with_the_vehicles_sheet():
    """Undamped natural periods of a vehicle whose M is coupled, computed in another way."""
    vehicle = load_vehicle("remus100")
    result = decay(vehicle, motion="pitch", release=SMALL, periods=2)
    assert result.prediction.period == pytest.approx(natural_periods(vehicle)[1], rel=1e-6)
    assert result.prediction.damping_ratio == pytest.approx(0.0, abs=1e-9)


@given(
    frequency=st.floats(0.3, 6.0),
    ratio=st.floats(0.005, 0.3),
    offset=st.floats(-2.0, 2.0),
    size=st.floats(0.01, 3.0),
)
def test_any_linear_oscillator_about_any_offset(frequency, ratio, offset, size):
    damped = frequency * math.sqrt(1.0 - ratio**2)
    time = np.linspace(0.0, 6.0 * 2.0 * math.pi / damped, 4000)
    swing = np.cos(damped * time) + ratio * frequency / damped * np.sin(damped * time)
    found = decrement_of(time, offset + size * np.exp(-ratio * frequency * time) * swing, 1e-3 * size)
    assert found.period == pytest.approx(2.0 * math.pi / damped, rel=1e-3)
    assert found.damping_ratio == pytest.approx(ratio, rel=1e-2)


@pytest.mark.parametrize(("linear", "quadratic"), [(0.0, 0.4), (0.02, 0.3), (0.05, 0.0)])
def test_linear_and_quadratic_parts_are_told_apart(linear, quadratic):
    frequency = 1.7

    def rates(_, state):
        x, v = state
        return v, -2.0 * linear * frequency * v - quadratic * abs(v) * v - frequency**2 * x

    time = np.linspace(0.0, 40.0, 8001)
    solution = solve_ivp(rates, (0.0, 40.0), (0.3, 0.0), t_eval=time, rtol=1e-10, atol=1e-12)
    found = decrement_of(time, solution.y[0], 1e-3)
    assert found.linear_ratio == pytest.approx(linear, abs=5e-4)
    assert found.quadratic == pytest.approx(quadratic, rel=0.01, abs=5e-3)


def test_a_vehicle_that_does_not_swing_says_so():
    """Overdamped: it creeps back."""
    result = decay(righted_sphere((40.0, 90.0, 90.0, 400.0, 400.0, 8.0)))
    assert result.decrement is None
    assert result.prediction is None
    assert "without swinging" in result.notes[0]
    assert result.as_dict()["quantities"]["period_s"] is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"motion": "heave"}, "nothing brings .* back in heave.*only vessels that float"),
        ({"motion": "yaw"}, "'yaw' is unknown; give one of"),
        ({"release": -0.1}, "release"),
        ({"release": 2.0}, "not below pi/2"),
        ({"step": 0.0}, "step"),
        ({"step": 1e-308}, "step = 1e-308; give at least"),
        ({"periods": 0}, "periods"),
    ],
)
def test_wrong_arguments_are_refused(arguments, message):
    with pytest.raises(InvalidInputError, match=message):
        decay(righted_sphere(), **arguments)


def test_a_vehicle_without_a_righting_moment_is_refused():
    with pytest.raises(InvalidInputError, match="put the centre of mass below the centre of buoyancy"):
        decay(sphere(), motion="roll")


@pytest.mark.sweep
def test_with_radiation_memory_the_roll_is_the_pole_of_the_whole_linear_system():
    """A root s of det(s^2 M + s D + s H(s) + G), H the radiation of all frequencies: no step is in it."""
    vessel = load_vehicle("supply_vessel")
    term, viscous = memory_term(vessel, "memory"), vessel.linear_damping_without_waves
    stiffness = stiffness_matrix(vessel)
    axes, scale = np.ix_([1, 3, 5], [1, 3, 5]), np.sqrt(np.diag(term.mass_matrix)[[1, 3, 5]])

    def determinant(s):
        radiation = term.model.transfer(np.array([-1j * s]))[0]
        whole = (s * s * term.mass_matrix + s * (viscous + radiation) + stiffness)[axes]
        return np.linalg.det(whole / np.outer(scale, scale))

    pole = newton(determinant, complex(-0.05, 0.6), x1=complex(-0.04, 0.61), tol=1e-10)
    result = decay(vessel, motion="roll", release=math.radians(0.1), periods=6, radiation="memory")
    assert result.settings["radiation"] == "memory"
    assert result.decrement.period == pytest.approx(2.0 * math.pi / pole.imag, rel=2e-3)
    assert result.decrement.damping_ratio == pytest.approx(-pole.real / abs(pole), rel=0.03)
    assert "radiation" not in decay(vessel, motion="roll", periods=1).settings
