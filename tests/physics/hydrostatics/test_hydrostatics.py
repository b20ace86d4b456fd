"""A vessel that floats, on its waterplane's linear stiffness: energy, periods, damping, order, batches."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from support.bodies import make_body, random_inertia, random_quaternion
from support.fossen import coriolis, errors, skew
from support.order import observed_order

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.physics.hydrostatics.formulas.waterplane import (
    WaterplaneRestoring,
    waterplane_restoring,
    waterplane_restoring_in_body_axes,
)
from dq_marine.physics.hydrostatics.restoring import floating_periods
from dq_marine.physics.matrices import matrix3
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, load_vehicle

STIFFNESS = np.array([[40.0, 1.5, 6.0], [1.5, 12.0, -0.8], [6.0, -0.8, 25.0]])
DEPTH = 0.3


def waterplane(stiffness=STIFFNESS, depth=DEPTH):
    return ForceTerm(
        "waterplane restoring", waterplane_restoring, WaterplaneRestoring(matrix3(stiffness), depth)
    )


def zeta(position, rotation):
    """Depth below rest, and the components of down that are roll and -pitch to first order."""
    down = rotation.T @ [0.0, 0.0, 1.0]
    return np.array([position[2] - DEPTH, down[1], -down[0]])


def energy(m, position, rotation, velocity, stiffness=STIFFNESS):
    z = zeta(position, rotation)
    return 0.5 * velocity @ m @ velocity + 0.5 * z @ stiffness @ z


def state_of(body):
    return (
        body.position_ned,
        Rotation.from_quat(np.roll(body.quaternion_body_to_ned, -1)).as_matrix(),
        body.velocity_body,
    )


def solved(m, position, quaternion, velocity, duration):
    """The same motion by SciPy: Fossen's equations with the force found by differences of the potential."""
    inverse = np.linalg.inv(m)

    def potential(p, r):
        z = zeta(p, r)
        return 0.5 * z @ STIFFNESS @ z

    def derivative(_, y):
        p, r, nu = y[:3], y[3:12].reshape(3, 3), y[12:]
        tau, small = np.zeros(6), 1e-5
        for i in range(3):
            unit = small * np.eye(3)[i]
            tau[i] = potential(p - r @ unit, r) - potential(p + r @ unit, r)
            turn = Rotation.from_rotvec(unit).as_matrix()
            tau[3 + i] = potential(p, r @ turn.T) - potential(p, r @ turn)
        force = tau / (2.0 * small) - coriolis(m, nu) @ nu
        return np.concatenate([r @ nu[:3], (r @ skew(nu[3:])).ravel(), inverse @ force])

    start = np.concatenate(
        [position, Rotation.from_quat(np.roll(quaternion, -1)).as_matrix().ravel(), velocity]
    )
    y = solve_ivp(derivative, (0.0, duration), start, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    return y[:3], y[3:12].reshape(3, 3), y[12:]


@pytest.mark.parametrize("restoring", [waterplane_restoring, waterplane_restoring_in_body_axes])
def test_to_first_order_it_is_minus_g_eta(restoring):
    small = 1e-6
    for heave, roll, pitch in small * np.random.default_rng(0).normal(size=(10, 3)):
        x, y, z, w = Rotation.from_euler("ZYX", [0.7, pitch, roll]).as_quat()
        pose = pose_from_parts((w, x, y, z), (3.0, -2.0, DEPTH + heave))
        moment, force = restoring(WaterplaneRestoring(matrix3(STIFFNESS), DEPTH), pose, 0.0)
        expected = -STIFFNESS @ [heave, roll, pitch]
        assert np.allclose([force[2], moment[0], moment[1]], expected, rtol=0.0, atol=1e-9)
        assert np.allclose([force[0], force[1], moment[2]], 0.0, atol=1e-9)


def test_the_step_is_of_second_order():
    rng = np.random.default_rng(3)
    m, duration, counts = random_inertia(rng), 1.0, np.array([100, 200, 400])
    position, quaternion, velocity = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    reference = solved(m, position, quaternion, velocity, duration)
    measured = []
    for count in counts:
        body = make_body(m, duration / count, forces=(waterplane(),))
        body.reset(position, quaternion, velocity)
        body.step(steps=int(count))
        measured.append(errors(body, reference))
    for series in np.array(measured).T:
        assert observed_order(duration / counts, series) == pytest.approx(2.0, abs=0.05)


def test_energy_stays_in_bounds_for_100000_steps():
    """Bounded, without drift: the second half of the run has the mean of the first; a quarter of the step, 1/16.

    The motion is chaotic. Steps are compared over 20 s, in which they follow the same orbit; beyond, the largest error
    is that of wherever each has come, and follows from the last bit of M.
    """
    rng = np.random.default_rng(5)
    m = random_inertia(rng)
    position, quaternion, velocity = (0.0, 0.0, 0.5), (0.9, 0.3, -0.2, 0.2), 0.3 * rng.normal(size=6)
    quaternion = np.array(quaternion) / np.linalg.norm(quaternion)
    early = []
    for step, repeats in ((0.02, 4000), (0.005, 2000)):
        body = make_body(m, step, forces=(waterplane(),))
        body.reset(position, quaternion, velocity)
        initial = energy(m, *state_of(body))
        series = []
        for _ in range(repeats):
            body.step(steps=25)
            series.append(energy(m, *state_of(body)) / initial - 1.0)
        first, second = np.array_split(np.array(series), 2)
        worst = np.abs(series).max()
        assert worst < 3e-3
        assert abs(first.mean() - second.mean()) < 0.1 * worst
        early.append(np.abs(series[: round(20.0 / (25 * step))]).max())
    assert early[0] / early[1] == pytest.approx(16.0, rel=0.05)


def uncoupled(**tables):
    """The Otter with a diagonal M, an undamped one, and other tables replaced."""
    content = load_vehicle("otter").model_dump()
    content["rigid_body"] |= {"center_of_mass": (0.0, 0.0, 0.0), "inertia": (16.0, 21.0, 30.0)}
    content["damping"] = {"linear": (0.0,) * 6}
    content["hydrostatics"] |= {"center_of_flotation": 0.0}
    content |= {"payloads": (), "hull": ()} | tables
    return Vehicle.model_validate(content)


def crossings(body, read, count):
    """Times at which a quantity changes sign, interpolated."""
    found, before = [], read(body)
    while len(found) < count:
        body.step()
        now = read(body)
        if before * now < 0.0:
            found.append(body.time - body.step_size * now / (now - before))
        before = now
    return np.array(found)


@pytest.mark.parametrize(("axis", "name"), [(0, "heave"), (1, "roll"), (2, "pitch")])
def test_free_motions_have_the_closed_periods(axis, name):
    """2 pi sqrt(M_ii/C_ii) of uncoupled heave, roll and pitch, and the sheet says so."""
    vehicle = uncoupled()
    i = axis + 2
    period = 2.0 * math.pi * math.sqrt(vehicle.mass_matrix[i, i] / vehicle.waterplane_stiffness[axis, axis])
    assert floating_periods(vehicle)[axis] == pytest.approx(period, rel=1e-12), name
    body = Scene(vehicle, step=0.002).stepper()
    small = np.zeros(4)
    small[axis] = 1e-4
    attitude = np.array([1.0, small[1], small[2], 0.0])
    body.reset((0.0, 0.0, small[0]), attitude / np.linalg.norm(attitude))

    def read(state):
        return (state.position_ned[2], *state.quaternion_body_to_ned[1:3])[axis]

    times = crossings(body, read, 5)
    # The step shortens a period by (h omega)^2/24, 1.6e-5 at most.
    assert times[4] - times[0] == pytest.approx(2.0 * period, rel=2e-5)


def test_free_roll_of_the_supply_vessel_has_the_period_and_damping_of_its_gm_and_zeta():
    """As the eigenvalue of sway, roll and yaw, linearised; near sqrt(m g GM/M_44) and D_44/(2 M_44 omega)."""
    vehicle = load_vehicle("supply_vessel")
    m, d, c = vehicle.mass_matrix, vehicle.linear_damping, vehicle.waterplane_stiffness
    stiffness = np.zeros((6, 6))
    stiffness[2:5, 2:5] = c
    lower = np.hstack([-np.linalg.solve(m, stiffness), -np.linalg.solve(m, d)])
    values, vectors = np.linalg.eig(np.vstack([np.hstack([np.zeros((6, 6)), np.eye(6)]), lower]))
    rolling = [k for k in np.flatnonzero(values.imag > 0.0) if np.abs(vectors[3:6, k]).argmax() == 0]
    (mode,) = rolling
    natural = abs(values[mode])
    gm = c[1, 1] / vehicle.weight
    assert gm == pytest.approx(2.1437, abs=1e-4)
    by_gm = math.sqrt(vehicle.weight * gm / m[3, 3])
    zeta = d[3, 3] / (2.0 * m[3, 3] * by_gm)
    assert natural == pytest.approx(by_gm, rel=0.1)
    assert -values[mode].real / natural == pytest.approx(zeta, rel=0.15)

    # Start in the mode, one degree of roll, and see it decay in half periods.
    shape = vectors[:, mode] / vectors[3, mode]
    eta, nu = (math.radians(1.0) * part for part in (shape[:6].real, shape[6:].real))
    body = Scene(vehicle, step=0.02).stepper()
    x, y, z, w = Rotation.from_euler("ZYX", [eta[5], eta[4], eta[3]]).as_quat()
    body.reset(eta[:3], (w, x, y, z), nu)

    def roll(state):
        return 2.0 * state.quaternion_body_to_ned[1]

    times = crossings(body, roll, 5)
    assert (times[4] - times[0]) / 2.0 == pytest.approx(2.0 * math.pi / values[mode].imag, rel=2e-3)
    body.reset(eta[:3], (w, x, y, z), nu)
    period = 2.0 * math.pi / values[mode].imag
    body.step(steps=round(period / 0.02))
    assert math.log(math.radians(1.0) / roll(body)) == pytest.approx(-values[mode].real * period, rel=1e-2)


def test_a_payload_sinks_and_trims_the_vessel():
    """C zeta = (m g, y m g, -x m g): where the Otter comes to rest, to first order."""
    content = load_vehicle("otter").model_dump()
    content["hydrostatics"] |= {"force_axes": "earth"}
    vehicle = Vehicle.model_validate(content)
    (payload,) = vehicle.payloads
    scene = Scene(vehicle, step=0.02)
    assert scene.terms[:3] == ("waterplane restoring", "net weight", "righting moment")
    body = scene.stepper()
    body.step(steps=3000)
    weight = payload.mass * 9.81
    depth, roll, pitch = np.linalg.solve(
        vehicle.waterplane_stiffness, [weight, 0.0, -payload.position[0] * weight]
    )
    assert body.position_ned[2] == pytest.approx(depth, rel=5e-3)
    assert 2.0 * body.quaternion_body_to_ned[2] == pytest.approx(pitch, rel=0.15)
    assert 2.0 * body.quaternion_body_to_ned[1] == pytest.approx(roll, abs=1e-9)


def test_it_rests_at_its_equilibrium_depth():
    vehicle = uncoupled(hydrostatics=uncoupled().hydrostatics.model_dump() | {"equilibrium_depth": 0.4})
    body = Scene(vehicle, step=0.02).stepper()
    body.reset((1.0, 2.0, 0.4), (math.cos(0.5), 0.0, 0.0, math.sin(0.5)))
    body.step(steps=100)
    assert np.allclose(body.position_ned, (1.0, 2.0, 0.4), atol=1e-12)


@pytest.mark.sweep
def test_a_batch_has_the_bits_of_single_vessels():
    scene = Scene("otter", current=(0.2, 0.1, 0.0), step=0.02)
    rng = np.random.default_rng(0)
    batch = scene.batch(9, threads=1)
    quaternions = np.array([random_quaternion(rng) for _ in range(9)])
    positions = rng.normal(size=(9, 3))
    batch.reset(positions, quaternions)
    batch.step((20.0, 0.0, 0.0, 0.0, 0.0, 3.0), 50)
    for i in range(9):
        body = scene.stepper()
        body.reset(positions[i], quaternions[i])
        body.step((20.0, 0.0, 0.0, 0.0, 0.0, 3.0), 50)
        assert np.array_equal(batch.position_ned[i], body.position_ned)
        assert np.array_equal(batch.quaternion_body_to_ned[i], body.quaternion_body_to_ned)
        assert np.array_equal(batch.velocity_body[i], body.velocity_body)


def test_axes_of_the_force_differ_by_where_heave_pushes():
    """Along the vertical there is no way to gain from it; along a trimmed body's axes it pushes ahead or astern."""
    angle, depth = 0.1, 0.02
    pose = pose_from_parts((math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0), (0.0, 0.0, DEPTH + depth))
    term = WaterplaneRestoring(matrix3(np.diag([1000.0, 10.0, 10.0])), DEPTH)
    rotation = Rotation.from_euler("y", angle)
    vertical = rotation.apply(waterplane_restoring(term, pose, 0.0).linear)
    along_body = rotation.apply(waterplane_restoring_in_body_axes(term, pose, 0.0).linear)
    assert vertical == pytest.approx([0.0, 0.0, -20.0], abs=1e-12)
    assert along_body == pytest.approx([-20.0 * math.sin(angle), 0.0, -20.0 * math.cos(angle)])
