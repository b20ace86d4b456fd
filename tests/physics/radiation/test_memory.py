"""The force of the waves that a hull makes: its laws in a step, alone and in lanes, and against Cummins' equation."""

import numpy as np
import pytest
from support.bodies import PlainBody
from support.cummins import free_motion, retardation
from support.sweeps import sweep

from dq_marine import Scene
from dq_marine.algebra.spatial import ZERO, from_fossen, to_fossen
from dq_marine.backend.packing import pack
from dq_marine.integrator.fluid_memory import join_impulses, join_resistances, join_sections
from dq_marine.integrator.inertia import momentum_from_twist
from dq_marine.physics.radiation.build import memory_term, radiation_model
from dq_marine.vehicles import load_vehicle

VESSEL = load_vehicle("supply_vessel")
MODEL = radiation_model(VESSEL)
TERM = memory_term(VESSEL, "memory")
RATES = np.array([1.0, 1.0, 0.5, 0.05, 0.02, 0.02])


def scene(step, **keywords):
    """The supply vessel with radiation memory."""
    return Scene("supply_vessel", step=step, radiation="memory", **keywords)


def plain_body(step, **keywords):
    """A body of such a scene that is stepped in plain Python."""
    made = scene(step, **keywords)
    return PlainBody(made.composition, made.parameters_at, made.step)


def slope(steps, errors):
    """The order of convergence, by regression."""
    return np.polyfit(np.log(steps), np.log(errors), 1)[0]


def impulse_of(numbers, state, twist):
    """C x + E v of all sections."""
    impulse = join_impulses(MODEL.planes)(numbers.sections, state, ZERO)
    return join_resistances(MODEL.planes)(numbers.sections, twist, impulse)


def forced_wrenches(omega, h, periods, motion):
    """Mean wrench of the memory over each step of a forced oscillation cos(w t) of one velocity, (n, 6)."""
    advance = join_sections(MODEL.planes)
    numbers, state = TERM.numbers(h), TERM.memory.rest
    wrenches = []
    for n in range(int(periods * 2.0 * np.pi / omega / h)):
        velocity = np.zeros(6)
        velocity[motion] = np.cos(omega * (n + 0.5) * h)
        twist = from_fossen(velocity)
        impulse = impulse_of(numbers, state, twist)
        wrenches.append(-np.array(to_fossen(impulse)) / h)
        state = advance(numbers.sections, state, twist)
    return np.array(wrenches)


@pytest.mark.parametrize("motion", sweep(range(6), plain=[2, 4]))
def test_forced_oscillation_meets_added_mass_and_damping(motion):
    """In phase with the velocity it is -B(w), with the acceleration -(A(w) - A_inf)."""
    for omega in (0.4, 0.8, 1.5):
        h = 2.0 * np.pi / omega / 200
        wrenches = forced_wrenches(omega, h, 30, motion)
        last = slice(-400, None)
        times = (np.arange(len(wrenches)) + 0.5)[last] * h
        phases = np.stack([np.cos(omega * times), -omega * np.sin(omega * times)])
        by_velocity, by_acceleration = np.linalg.lstsq(phases.T, wrenches[last], rcond=None)[0]
        h_there = MODEL.transfer(np.array([omega]))[0, :, motion]
        largest = np.abs(h_there).max()
        assert np.abs(by_velocity + h_there.real).max() < 2e-3 * largest
        assert np.abs(by_acceleration + h_there.imag / omega).max() < 2e-3 * largest / omega


def test_radiation_takes_energy_from_any_motion():
    """The work of any velocities, from rest on, is no less than the energy that the memory holds: exactly passive."""
    rng = np.random.default_rng(4)
    advance = join_sections(MODEL.planes)
    for h in (0.01, 0.3, 5.0):
        numbers, state, work = TERM.numbers(h), TERM.memory.rest, 0.0
        for _ in range(300):
            velocity = RATES * rng.normal(size=6)
            twist = from_fossen(velocity)
            impulse = impulse_of(numbers, state, twist)
            work += velocity @ np.array(to_fossen(impulse))
            state = advance(numbers.sections, state, twist)
            stored = 0.5 * np.sum(pack(state) ** 2)
            assert work >= stored * (1.0 - 1e-9)


def test_the_flow_never_adds_energy_however_long_it_is():
    """Kinetic energy with that of the memory falls in every flow, from 1 ms to 1000 s."""
    rng = np.random.default_rng(5)
    mass = TERM.mass_matrix
    inertia = scene(0.1).parameters_at(0.1).inertia
    for duration in (1e-3, 0.1, 3.0, 1000.0):
        numbers, state = TERM.numbers(duration), TERM.memory.rest
        momentum = momentum_from_twist(inertia, from_fossen(RATES * rng.normal(size=6)))
        energies = []
        for _ in range(100):
            mu = np.array(to_fossen(momentum))
            energies.append(0.5 * mu @ np.linalg.solve(mass, mu) + 0.5 * np.sum(pack(state) ** 2))
            momentum, state = TERM.memory.flow(numbers, momentum, state)
        assert (np.diff(energies) <= 1e-12 * energies[0]).all()
        assert energies[-1] < energies[0]


def test_a_steady_motion_meets_no_force():
    """H(0) = 0: after a long time at one velocity nothing is left, to round-off beside the first impulse."""
    advance = join_sections(MODEL.planes)
    numbers, state = TERM.numbers(1.0), TERM.memory.rest
    twist = from_fossen(RATES)
    impulses = []
    for _ in range(1500):
        impulse = impulse_of(numbers, state, twist)
        impulses.append(np.abs(to_fossen(impulse)))
        state = advance(numbers.sections, state, twist)
    assert (impulses[-1] < 1e-9 * np.max(impulses, axis=0)).all()


def test_free_decay_agrees_with_cummins_equation():
    """Heave, roll and pitch of a small push, against the equation with its convolution, written separately."""
    dt, steps = 0.05, 800
    body = scene(dt).stepper()
    push = 1e-5 * np.array([0.0, 0.0, 1.0, 0.1, 0.05, 0.0])
    body.reset(velocity_body=push)
    kernel = retardation(MODEL.damping_at, dt * np.arange(steps + 1), 150.0)
    stiffness = np.zeros((6, 6))
    stiffness[2:5, 2:5] = VESSEL.waterplane_stiffness
    damping = VESSEL.linear_damping_without_waves
    _, expected = free_motion(TERM.mass_matrix, damping, stiffness, kernel, dt, push)
    found = [body.velocity_body]
    for _ in range(steps):
        body.step()
        found.append(body.velocity_body)
    found = np.array(found)
    for motion in (2, 3, 4):
        largest = np.abs(expected[:, motion]).max()
        assert np.abs(found[:, motion] - expected[:, motion]).max() < 5e-3 * largest
        assert np.abs(expected[-200:, motion]).max() < 0.3 * largest  # it has decayed


def test_the_step_is_of_second_order():
    pushed = np.array([0.5, 0.3, 0.2, 0.05, 0.02, 0.02])

    def end(step):
        body = scene(step).stepper()
        body.reset((0.0, 0.0, 0.5), (np.cos(0.1), np.sin(0.1), 0.0, 0.0), pushed)
        body.step(steps=round(8.0 / step))
        return np.concatenate([body.get_state()[9:15] / 1e6, body.fluid_memory / 1e3])

    steps = [0.2, 0.1, 0.05]
    exact = end(0.002)
    assert slope(steps, [np.linalg.norm(end(step) - exact) for step in steps]) == pytest.approx(2.0, abs=0.1)


def test_order_4_is_of_fourth_order():
    def end(step):
        body = plain_body(step, order=4)
        body.reset((0.0, 0.0, 0.5), velocity_body=[0.5, 0.3, 0.2, 0.05, 0.02, 0.02])
        body.step(steps=round(4.0 / step))
        return np.concatenate([body.get_state()[9:15] / 1e6, body.fluid_memory / 1e3])

    steps = [0.5, 0.25, 0.125]
    exact = end(1.0 / 32.0)
    assert slope(steps, [np.linalg.norm(end(step) - exact) for step in steps]) == pytest.approx(4.0, abs=0.35)


@pytest.mark.sweep
def test_alone_and_in_lanes_a_body_has_the_same_bits():
    made = scene(0.1)
    velocities = np.random.default_rng(6).normal(size=(5, 6)) * RATES
    batch = made.batch(5)
    batch.reset(velocity_body=velocities)
    batch.step(steps=40)
    for velocity, row in zip(velocities, batch.get_state(), strict=True):
        body = made.stepper()
        body.reset(velocity_body=velocity)
        body.step(steps=40)
        assert (body.get_state() == row).all()
    assert np.abs(batch.fluid_memory).max() > 1.0
    kept = batch.get_state()
    batch.step(steps=7)
    later = batch.get_state()
    batch.set_state(kept)
    batch.step(steps=7)
    assert (batch.get_state() == later).all()


def test_the_memory_is_part_of_the_state_and_reset_clears_it():
    body = scene(0.1).stepper()
    body.reset(velocity_body=RATES)
    body.step(steps=20)
    kept = body.get_state()
    assert kept.shape == (15 + 24,)
    body.step(steps=30)
    later = body.get_state()
    body.reset()
    assert not body.fluid_memory.any()
    body.set_state(kept)
    assert (body.get_state() == kept).all()
    body.step(steps=30)
    assert (body.get_state() == later).all()


def test_in_a_uniform_current_the_motion_through_the_water_is_the_same():
    """The memory follows the velocity relative to the water: Galilei."""
    drift = np.array([0.7, -0.4, 0.0])
    still, carried = plain_body(0.1), plain_body(0.1, current=drift)
    still.reset(velocity_body=RATES)
    carried.reset(velocity_body=RATES + np.array([*drift, 0.0, 0.0, 0.0]))
    for body in (still, carried):
        body.step(steps=40)
    assert np.allclose(carried.get_state()[9:], still.get_state()[9:], rtol=1e-9, atol=1e-6)
    moved = carried.position_ned - still.position_ned
    assert np.allclose(moved, 4.0 * drift, atol=1e-9)


def test_what_the_memory_stands_for_is_taken_out_of_the_damping():
    """Added mass is the A_inf of the model, and the linear damping has no waves in it."""
    with_memory, without = scene(0.1), Scene("supply_vessel", step=0.1)
    assert "radiation memory" in with_memory.terms
    assert "radiation memory" not in without.terms
    assert without.composition.memory.rest == ()
    waves = np.diag(VESSEL.linear_damping - VESSEL.linear_damping_without_waves)
    assert np.allclose(waves, [0.0, 0.0, 6250023.6, 8139213.6, 4189979053.0, 0.0], rtol=1e-5)
    assert np.allclose(TERM.mass_matrix - VESSEL.rigid_body_matrix, MODEL.added_mass, rtol=1e-12)


def test_time_does_not_run_backwards_and_collocation_is_refused():
    with pytest.raises(Exception, match="radiation memory"):
        Scene("supply_vessel", step=-0.1, radiation="memory")
    for scheme, order in (("gauss", 8), ("galerkin", 4), ("runge_kutta", 8)):
        with pytest.raises(Exception, match='knows no radiation memory; give scheme="midpoint"'):
            Scene("supply_vessel", step=0.1, scheme=scheme, order=order, radiation="memory")
