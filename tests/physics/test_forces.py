"""Forces of the user's own: compiled from plain Python, in pose, velocity and time; and the implicit-node kick."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from support.bodies import PlainBody, make_body, random_damping, random_inertia
from support.fossen import errors, solve
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import rotate_inverse, world_down_in_body
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.backend.compilation import compile_function
from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.scene import Scene

NO_MOMENT = (0.0, 0.0, 0.0)


class Spring(NamedTuple):
    stiffness: float


class Wave(NamedTuple):
    amplitude: float
    frequency: float


def weight(parameters, pose, time):
    return Spatial(NO_MOMENT, scale(parameters[0], world_down_in_body(pose.real)))


def spring(parameters, pose, time):
    """A spring from the body origin to the world's."""
    pull = scale(-parameters.stiffness, pose_position(pose))
    return Spatial(NO_MOMENT, rotate_inverse(pose.real, pull))


def wave(parameters, pose, time):
    """An oscillating force along the world's x axis."""
    push = (parameters.amplitude * math.cos(parameters.frequency * time), 0.0, 0.0)
    return Spatial(NO_MOMENT, rotate_inverse(pose.real, push))


def drag(parameters, pose, twist, time):
    return Spatial(scale(-parameters[0], twist.angular), scale(-parameters[0], twist.linear))


def test_a_users_force_is_the_built_in_one():
    """Compiled, too: the built-in one runs in plain Python."""
    own = make_body(np.diag([5.0, 6, 7, 1, 2, 3]), 0.02, forces=(ForceTerm("weight", weight, (2.5,)),))
    built_in = make_body(np.diag([5.0, 6, 7, 1, 2, 3]), 0.02, excess_weight=2.5, kind=PlainBody)
    for body in (own, built_in):
        body.reset(quaternion_body_to_ned=(0.6, 0.0, 0.8, 0.0), velocity_body=(0.1, 0.2, 0.3, 0.4, 0.5, 0.6))
        body.step((1.0, 2.0, 3.0, 0.1, 0.2, 0.3), 50)
    assert np.array_equal(own.get_state(), built_in.get_state())


@pytest.mark.parametrize(("order", "tolerance"), [(2, 0.05), (4, 0.15)])
def test_a_spring_swings_as_it_should(order, tolerance):
    """X = cos(omega t), omega = sqrt(k/m): a force that depends on the position."""
    steps, measured = np.array([0.1, 0.05, 0.025]), []
    for h in steps:
        body = make_body(
            np.diag([2.0] * 3 + [1.0] * 3),
            h,
            order=order,
            forces=(ForceTerm("spring", spring, Spring(8.0)),),
            kind=PlainBody,
        )
        body.reset((1.0, 0.0, 0.0))
        body.step(steps=round(2.0 / h))
        measured.append(abs(body.position_ned[0] - math.cos(4.0)))
    assert observed_order(steps, measured) == pytest.approx(order, abs=tolerance)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("pieces", [1, 4])
def test_a_force_may_depend_on_time(order, pieces):
    """M x'' = a cos(w t) from rest; time goes on from call to call."""
    steps, measured = np.array([0.1, 0.05, 0.025]), []
    for h in steps:
        body = make_body(
            np.diag([2.0] * 3 + [1.0] * 3),
            h,
            order=order,
            forces=(ForceTerm("wave", wave, Wave(3.0, 2.0)),),
            kind=PlainBody,
        )
        for _ in range(pieces):
            body.step(steps=round(2.0 / h / pieces))
        measured.append(abs(body.position_ned[0] - 3.0 / 2.0 / 4.0 * (1.0 - math.cos(4.0))))
    assert observed_order(steps, measured) == pytest.approx(order, abs=0.2)


def swell(parameters, time):
    return Spatial(
        (0.0, 0.0, 0.1 * math.sin(time)),
        (parameters.amplitude * math.cos(parameters.frequency * time), 0.0, 0.0),
    )


def swell_anywhere(parameters, pose, time):
    return swell(parameters, time)


SCHEMES = [
    ("midpoint", 2),
    ("midpoint", 4),
    ("gauss", 8),
    ("galerkin", 6),
    ("runge_kutta", 4),
    ("runge_kutta", 8),
]


@pytest.mark.parametrize(("scheme", "order"), sweep(SCHEMES, plain=[("midpoint", 2), ("runge_kutta", 8)]))
@pytest.mark.parametrize("branches", [False, True])
def test_a_force_of_time_alone_is_one_of_the_pose_that_does_not_ask_for_it(scheme, order, branches):
    """Alone or in lanes, with all its stages computed side by side or not; time goes on from call to call."""
    parameters, ends = Wave(3.0, 2.0), []
    for force in (
        ForceTerm("swell", swell, parameters, branches=branches, uses_pose=False),
        ForceTerm("swell", swell_anywhere, parameters),
    ):
        scene = Scene(step=0.1, scheme=scheme, order=order, forces=[force])
        body, batch = scene.stepper(), scene.batch(3)
        for some in (body, batch):
            some.reset(velocity_body=(0.4, -0.2, 0.1, 0.1, 0.2, -0.3))
            for _ in range(3):
                some.step(steps=4)
        assert np.array_equal(batch.get_state()[1], body.get_state())
        ends.append(body.get_state())
    np.testing.assert_allclose(*ends, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("order", "tolerance"), [(2, 0.05), (4, 0.15)])
def test_a_force_may_depend_on_velocity(order, tolerance):
    rng = np.random.default_rng(4)
    m, velocity = random_inertia(rng, 5.0), 0.6 + 0.5 * rng.uniform(size=6)
    wrench = 6.0 * np.abs(rng.normal(size=6))  # keeps the velocities' signs: |nu| nu has a kink at zero
    quadratic, current = np.full(6, 0.5), (0.03, -0.02, 0.01)
    reference = solve(
        m, np.zeros(3), (1.0, 0.0, 0.0, 0.0), velocity, 0.5, linear=1.5 * np.eye(6), quadratic=quadratic,
        current=current, wrench=wrench, rtol=3e-14,
    )  # fmt: skip
    counts, measured = np.array([20, 30, 45, 68]), []
    for count in counts:
        term = ForceTerm("drag", drag, (1.5,), uses_velocity=True)
        case = {"quadratic": quadratic, "current": current, "forces": (term,)}
        body = make_body(m, 0.5 / count, order=order, kind=PlainBody, **case)
        body.reset(velocity_body=velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    for series in np.array(measured).T:
        assert observed_order(0.5 / counts, series) == pytest.approx(order, abs=tolerance)


def make_push(force):
    def push(parameters, pose, time):
        return Spatial(NO_MOMENT, (force, 0.0, 0.0))

    return push


def typed_push(force):
    """The same without a source file, as if typed at a prompt."""
    names = {"Spatial": Spatial, "__name__": "__main__"}
    text = f"def push(p, pose, time): return Spatial((0.0, 0.0, 0.0), ({force}, 0.0, 0.0))"
    exec(compile(text, "<prompt>", "exec"), names)
    return names["push"]


@pytest.mark.parametrize("make", [make_push, typed_push])
def test_compiled_code_on_disk_is_not_taken_for_that_of_another_force(make, tmp_path, monkeypatch):
    """It holds a closure's number as a constant; where there is no source file, the code itself enters the key."""
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))
    for force in (1.0, 2.0):
        assert compile_function(make(force), "a test")(0.0, 0.0, 0.0).linear[0] == force


@pytest.mark.sweep
@pytest.mark.parametrize("make", [make_push, typed_push])
def test_bodies_pushed_by_such_forces_are_told_apart(make, tmp_path, monkeypatch):
    """The same for whole steps, which are composed of the force."""
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))
    for force in (1.0, 2.0):
        body = make_body(np.eye(6), 0.1, forces=(ForceTerm("push", make(force), ()),))
        body.step(steps=10)
        assert body.velocity_body[0] == pytest.approx(force)


def no_spatial(parameters, pose, time):
    return (0.0, 0.0, 0.0)


def infinite(parameters, pose, time):
    return Spatial((math.inf, 0.0, 0.0), NO_MOMENT)


@pytest.mark.parametrize(
    ("force", "message"),
    [
        (lambda: 1.0, "ForceTerm"),
        (ForceTerm("drag", drag, (1.0,)), r"drag.*takes \(parameters, pose, time\)"),
        (ForceTerm("weight", weight, (1.0,), uses_velocity=True), r"weight.*twist, time"),
        (ForceTerm("wave", wave, Wave(3.0, 2.0), uses_pose=False), r"wave.*takes \(parameters, time\)"),
        (ForceTerm("drag", drag, (1.0,), uses_velocity=True, uses_pose=False), "leave uses_pose out"),
        (ForceTerm("flat", no_spatial, ()), r"flat.*Spatial"),
        (ForceTerm("huge", infinite, ()), r"huge.*finite"),
    ],
)
def test_a_wrong_force_is_refused(force, message):
    with pytest.raises(InvalidInputError, match=message):
        Scene(forces=[force])


@pytest.mark.parametrize("forces", [3, ForceTerm("weight", weight, (1.0,)), "weight"])
def test_forces_are_a_list(forces):
    with pytest.raises(InvalidInputError, match=r"list of|ForceTerm"):
        Scene(forces=forces)


def test_a_scene_says_what_forces_it_has_and_refuses_what_they_forbid():
    term = ForceTerm("drag", drag, (1.0,), uses_velocity=True)
    assert "drag" in Scene(forces=[term]).terms
    with pytest.raises(InvalidInputError, match="cannot be undone"):
        Scene(forces=[term], step=-0.02)
    with pytest.raises(InvalidInputError, match=r"kick = 'soft'.*implicit_node"):
        Scene(kick="soft")


# The implicit-node kick


@pytest.mark.parametrize("full", [False, True])
def test_the_implicit_node_kick_is_of_second_order(full):
    rng = np.random.default_rng(9)
    m, velocity, wrench = random_inertia(rng), rng.normal(size=6), rng.normal(size=6)
    velocity = np.sign(velocity) * (0.6 + np.abs(velocity))
    case = {
        "quadratic": np.ones(6),
        "excess_weight": 1.0,
        "linear": random_damping(rng) if full else np.eye(6),
    }
    reference = solve(m, np.zeros(3), (1.0, 0.0, 0.0, 0.0), velocity, 0.5, wrench=wrench, **case)
    counts, measured = np.array([50, 100, 200]), []
    for count in counts:
        body = make_body(m, 0.5 / count, l_stable=False, kind=PlainBody, **case)
        body.reset(velocity_body=velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    for series in np.array(measured).T:
        assert observed_order(0.5 / counts, series) == pytest.approx(2.0, abs=0.05)


def test_the_implicit_node_kick_rings_when_stiff_and_the_default_does_not():
    """Linear decay: (1 - z/2)/(1 + z/2) for z = h lambda, which flips sign and hardly decays at z = 1e4."""
    left = {}
    for l_stable in (True, False):
        for stiffness in (0.1, 1e4):
            body = make_body(np.eye(6), 1.0, linear=stiffness * np.eye(6), l_stable=l_stable)
            body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
            body.step()
            left[l_stable, stiffness] = body.velocity_body[0]
    assert left[False, 0.1] == pytest.approx(0.95 / 1.05)
    assert left[True, 0.1] == pytest.approx(math.exp(-0.1), rel=1e-12)
    assert left[False, 1e4] == pytest.approx((1.0 - 5e3) / (1.0 + 5e3))
    assert 0.0 <= left[True, 1e4] < 1e-10


def test_the_implicit_node_kick_reaches_the_exact_terminal_velocity():
    body = make_body(
        np.diag([19.86] * 3 + [0.4] * 3),
        0.1,
        linear=13.7 * np.eye(6),
        quadratic=np.full(6, 141.0),
        l_stable=False,
    )
    body.step((40.0, 0.0, 0.0, 0.0, 0.0, 0.0), 2000)
    assert body.velocity_body[0] == pytest.approx(0.4862530975891999, rel=1e-12)
