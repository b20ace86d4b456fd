"""Bodies driven by their actuators, against Fossen's equations with the actuators' own, and against closed forms."""

import math

import numpy as np
import pytest
from support.actuated import actuator_wrench, solve
from support.fleet import everything, twin_screw, vehicle_with
from support.fossen import errors
from support.order import observed_order
from support.remus import mss_propeller
from support.sweeps import sweep

from dq_marine.errors import InvalidInputError, StepNotSolvableError
from dq_marine.simulation.scene import Scene, batch_of
from dq_marine.vehicles import load_vehicle

QUATERNION = np.array([0.8, 0.2, -0.4, 0.4]) / np.linalg.norm([0.8, 0.2, -0.4, 0.4])
VELOCITY = (0.8, 0.5, -0.6, 0.7, -0.8, 0.9)
COMMAND = (50.0, -0.7, 40.0, 2.0, 0.8, 0.5, 0.25, -0.3)
LAGGED_COMMAND = (50.0, 40.0, 2.0, 0.25)


def lagged():
    """One actuator of each kind, without what has a kink in time or velocity: rate limits, quadratic damping."""
    vehicle = everything()
    lag = {"time_constant": 0.3, "rate_limit": None}
    content = vehicle.model_dump()
    content["damping"]["quadratic"] = (0.0,) * 6
    content |= {kind: content[kind][:1] for kind in ("thrusters", "azimuths", "fins")}
    for thruster in content["thrusters"]:
        thruster |= lag | {"dead_band": 0.0}
    for azimuth in content["azimuths"]:
        azimuth |= lag | {"angle_time_constant": 0.4, "angle_rate_limit_deg_s": None}
    for fin in content["fins"]:
        fin |= {"time_constant": 0.2, "rate_limit_deg_s": None}
    return type(vehicle).model_validate(content)


def placed(body, values):
    """Place a body with its channels at given values."""
    body.reset((1.0, -2.0, 3.0), QUATERNION, VELOCITY)
    state = body.get_state()
    state[15 : 15 + len(values)] = values
    body.set_state(state)


ORDERS = [(2, 320, 0.05), (4, 160, 0.15)]


@pytest.mark.parametrize(("order", "finest", "tolerance"), sweep(ORDERS, plain=ORDERS[:1]))
def test_the_order_is_kept(order, finest, tolerance):
    vehicle = lagged()
    values = np.array([20.0, 15.0, 0.5, 0.1])  # no channel changes sign: n |n| has a kink there
    duration, counts = 0.4, finest // np.array([8, 4, 2, 1])
    *reference, reached = solve(
        vehicle, (1.0, -2.0, 3.0), QUATERNION, VELOCITY, values, LAGGED_COMMAND, duration
    )
    measured = []
    for count in counts:
        body = Scene(vehicle, step=duration / count, order=order, actuation="thrusters").stepper()
        placed(body, values)
        body.actuate(LAGGED_COMMAND, int(count))
        measured.append(errors(body, reference))
        assert body.actuator_values == pytest.approx(reached, rel=1e-9)
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        slope = observed_order(duration / counts, series)
        assert abs(slope - order) < tolerance, f"{kind} has order {slope:.3f}, errors {series}"


def test_a_lag_does_not_depend_on_the_step():
    """The channels are exact whatever the step, and however many calls it takes."""
    for step, calls in ((0.1, 1), (0.02, 1), (0.02, 25), (0.005, 4)):
        body = Scene(twin_screw(time_constant=0.1), step=step, actuation="thrusters").stepper()
        for _ in range(calls):
            body.actuate((60.0, -40.0), round(0.5 / step / calls))
        expected = np.array([60.0, -40.0]) * (1.0 - math.exp(-5.0))
        assert body.actuator_values == pytest.approx(expected, rel=1e-12)


def test_the_wrench_is_that_of_the_equations():
    vehicle = everything()
    body = Scene(vehicle, actuation="thrusters").stepper()
    values = np.array([30.0, -0.4, 25.0, 2.5, 0.6, -0.3, 0.2, -0.15])
    placed(body, values)
    own = body.actuator_wrench_body
    assert own == pytest.approx(actuator_wrench(vehicle, values, body.relative_velocity_body), rel=1e-12)


def trimmed(vehicle):
    """The vehicle neutral, its centres in the origin: pushed ahead it runs straight."""
    content = vehicle.model_dump()
    content["rigid_body"] |= {"center_of_mass": (0.0, 0.0, 0.0)}
    content["buoyancy"] |= {
        "center": (0.0, 0.0, 0.0),
        "volume": vehicle.rigid_body.mass / vehicle.buoyancy.water_density,
    }
    for thruster in content["thrusters"]:
        thruster["position"] = (0.0, thruster["position"][1], 0.0)
    return type(vehicle).model_validate(content)


@pytest.mark.parametrize(("speed", "gain"), [(40.0, 0.02), (-40.0, 0.011)])
def test_a_hull_under_propellers_reaches_its_terminal_speed(speed, gain):
    """Damping holds the thrust: d u + q |u| u = 2 k n |n|."""
    vehicle = trimmed(twin_screw())
    body = Scene(vehicle, actuation="thrusters").stepper()
    body.actuate((speed, speed), 3000)
    d, q = vehicle.linear_damping[0, 0], vehicle.quadratic_damping[0]
    terminal = (-d + math.sqrt(d * d + 8.0 * q * gain * speed**2)) / (2.0 * q)
    assert body.velocity_body[0] == pytest.approx(math.copysign(terminal, speed), rel=1e-9)


def test_a_remus_runs_at_the_speed_that_its_propeller_holds():
    """K n^2 - i n u = q u^2; the propeller's moment only turns the hull about its axis."""
    body = Scene(trimmed(load_vehicle("remus100")), actuation="thrusters").stepper()
    n, k, i, q = 1500.0 * math.pi / 30.0, 4.1188e-3, 0.159506, 6.1645
    body.actuate((n, 0.0, 0.0), 10000)
    held = (math.sqrt((i * n) ** 2 + 4.0 * q * k * n * n) - i * n) / (2.0 * q)
    assert body.velocity_body[0] == pytest.approx(held, rel=1e-4)


def test_signs_of_rudder_and_planes():
    """As published: positive rudder turns the bow to port and pushes to starboard, positive planes pitch it down."""
    body = Scene(trimmed(load_vehicle("remus100")), actuation="thrusters").stepper()
    body.reset(velocity_body=(1.5, 0.0, 0.0, 0.0, 0.0, 0.0))
    state = body.get_state()
    state[16:18] = 0.1, 0.2  # propeller, rudder, stern planes
    body.set_state(state)
    expected = 2.25 * np.array([0.0, 0.610584, -4.274088, 0.0, -2.9179198, -0.4168457])
    assert body.actuator_wrench_body == pytest.approx(expected, rel=1e-12)
    body.actuate((0.0, 0.1, 0.0), 5)
    assert body.velocity_body[5] < 0.0


def test_a_propeller_turns_the_hull_against_itself():
    body = Scene(trimmed(load_vehicle("remus100")), actuation="thrusters").stepper()
    body.reset(velocity_body=(1.5, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.actuate((95.8, 0.0, 0.0))
    thrust, moment = mss_propeller(95.8, 1.5)
    assert moment == pytest.approx(-0.402, abs=1e-3)
    assert body.actuator_wrench_body[[0, 3]] == pytest.approx([thrust, moment], rel=2e-3)


def test_commands_are_held_and_limited():
    body = Scene(trimmed(twin_screw(dead_band=5.0)), actuation="thrusters").stepper()
    body.actuate((1e9, 3.0))
    assert body.actuator_values.tolist() == [60.0, 0.0]
    body.step(steps=3)
    assert body.actuator_values.tolist() == [60.0, 0.0]
    assert body.command.tolist() == [1e9, 3.0]
    body.reset()
    assert not body.actuator_values.any()


def test_a_wrench_acts_besides():
    """Actuators at rest: the body moves under the wrench as one without."""
    plain = Scene("bluerov2_heavy").stepper()
    driven = Scene("bluerov2_heavy", actuation="thrusters").stepper()
    for body in (plain, driven):
        body.step((10.0, 5.0, -3.0, 1.0, 0.0, 2.0), 20)
    assert np.array_equal(plain.get_state(), driven.get_state()[:15])


def test_restart_is_bit_for_bit():
    scene = Scene(everything(), actuation="thrusters")
    body, other = scene.stepper(), scene.stepper()
    body.actuate(COMMAND, 7)
    other.set_state(body.get_state())
    for each in (body, other):
        each.step(steps=4)
        each.actuate(np.negative(COMMAND), 9)
    assert np.array_equal(body.get_state(), other.get_state())
    with pytest.raises(InvalidInputError, match=r"shape \(15,\)"):
        body.set_state(np.zeros(15))


def test_bad_commands_change_nothing():
    body = Scene(trimmed(twin_screw()), actuation="thrusters").stepper()
    body.actuate((10.0, 20.0), 3)
    before = body.get_state()
    for command, steps, wrench in (
        ((1.0,), 1, np.zeros(6)),
        ((math.nan, 0.0), 1, np.zeros(6)),
        ((1.0, 2.0), 0, np.zeros(6)),
        ((1.0, 2.0), 1, np.full(6, math.inf)),
    ):
        with pytest.raises(InvalidInputError):
            body.actuate(command, steps, wrench)
    with pytest.raises(StepNotSolvableError):
        body.actuate((1.0, 2.0), 5, np.full(6, 1e300))
    assert np.array_equal(before, body.get_state())


def test_what_cannot_be_driven_says_so():
    with pytest.raises(InvalidInputError, match="driven by wrenches"):
        Scene("bluerov2_heavy").stepper().actuate(np.zeros(8))
    with pytest.raises(InvalidInputError, match="no actuators whose force is known"):
        Scene(vehicle_with(), actuation="thrusters")
    with pytest.raises(InvalidInputError, match="'sails' is unknown"):
        Scene("bluerov2_heavy", actuation="sails")
    with pytest.raises(InvalidInputError, match="cannot be undone"):
        Scene("bluerov2_heavy", actuation="thrusters", step=-0.01)


@pytest.mark.sweep
def test_a_batch_has_the_bits_of_single_bodies():
    rng = np.random.default_rng(1)
    scene, n = Scene(everything(), current=(0.3, 0.1, 0.0), actuation="thrusters"), 11
    batch, single = scene.batch(n, threads=1), scene.stepper()
    low, high = np.array([[c.low, c.high] for c in scene.vehicle.channels]).T
    commands = rng.uniform(1.2 * low, 1.2 * high, (2, n, len(low)))
    velocity = rng.normal(size=(n, 6))
    batch.reset(velocity_body=velocity)
    for command in commands:
        batch.actuate(command, 6)
    batch.step((1.0, 2.0, 3.0, 0.1, 0.2, 0.3), 3)
    for i in range(n):
        single.reset(velocity_body=velocity[i])
        for command in commands:
            single.actuate(command[i], 6)
        single.step((1.0, 2.0, 3.0, 0.1, 0.2, 0.3), 3)
        assert np.array_equal(single.get_state(), batch.get_state()[i])
    other = scene.batch(n, threads=1)
    other.set_state(batch.get_state())
    for each in (batch, other):
        each.actuate(commands[0], 4)
    assert np.array_equal(batch.get_state(), other.get_state())


@pytest.mark.sweep  # a batch of equal ones has the bits of single bodies
def test_a_batch_of_different_actuators():
    """Time constants and gains of their own in every lane."""
    vehicles = [twin_screw(time_constant=0.05 * i, gain_forward=0.01 * i) for i in (1, 2, 3)]
    scenes = [Scene(vehicle, actuation="thrusters") for vehicle in vehicles]
    batch = batch_of(scenes, threads=1)
    batch.actuate((50.0, -30.0), 10)
    for i, scene in enumerate(scenes):
        single = scene.stepper()
        single.actuate((50.0, -30.0), 10)
        assert np.array_equal(single.get_state(), batch.get_state()[i])
