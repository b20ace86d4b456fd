"""Collocation under one force at a time: its order, whatever acts on the body."""

import math

import numpy as np
import pytest
from support.bodies import PlainBody
from support.order import observed_order
from support.sweeps import sweep

from dq_marine import CurrentProfile, Jonswap, Scene, Sea, Wind, load_vehicle
from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.integrator import radau_sweeps
from dq_marine.integrator.sweeps import Ending
from dq_marine.physics.term import ForceTerm

COUNTS = {4: np.array([18, 24, 30, 36]), 6: np.array([12, 15, 18, 21]), 8: np.array([10, 11, 12, 13])}
"""Steps of the motion, by order: between those whose errors still fall faster than they will and round-off."""

EXPLICIT_COUNTS = {"a current that varies with depth": np.array([7, 8, 9, 10])}
"""Those of the explicit method of order 8, by force; under the others it needs shorter steps, `SHORTER`."""

SHORTER = np.array([14, 16, 18])

VELOCITY = np.array([0.5, -0.2, 0.1, 0.3, -0.2, 0.6])


def tether(parameters, pose, time):
    """A spring to the origin that becomes stiffer with time."""
    pull = scale(-parameters[0] * (1.0 + time), pose_position(pose))
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, pull))


def swell(parameters, time):
    """A force that comes and goes along an axis of the body, and a moment that begins with it."""
    force = parameters[0] * math.sin(parameters[1] * time)
    return Spatial((0.1 * force, 0.0, 0.05 * force), (0.0, force, 0.5 * force))


LAYER = CurrentProfile([0.0, 9.0], [[0.9, -0.2], [-0.6, 0.4]])
"""One that the body does not leave: at the corners of a profile no method keeps an order above two."""

FORCES = {
    "weight, buoyancy and linear damping": ("bluerov2_heavy", {}),
    "a current": ("bluerov2_heavy", {"current": (0.3, 0.2, 0.1)}),
    "a current that varies with depth": ("bluerov2_heavy", {"current": LAYER}),
    "waves on a submerged body": ("bluerov2_heavy", {"weather": [Sea(Jonswap(1.0, 6.0), components=3)]}),
    "a force of one's own": ("bluerov2_heavy", {"forces": [ForceTerm("tether", tether, (5.0,))]}),
    "a force of time alone": (
        "bluerov2_heavy",
        {"forces": [ForceTerm("swell", swell, (9.0, 1.3), uses_pose=False)]},
    ),
    "thrusters with lags": ("bluerov2_heavy", {"actuation": "thrusters"}),
    "a waterplane": ("otter", {}),
    "a hull of boxes": ("otter", {"hydrostatics": "hull"}),
    "waves on a vessel": ("otter", {"weather": [Sea(Jonswap(0.1, 4.0), components=3)]}),
    "gusts": ("otter", {"weather": [Wind(12.0, 2.0, gusts=True, components=3)]}),
}

COMPILED = "thrusters with lags"  # the compiled step alone moves actuators
METHODS = [("gauss", 8), ("runge_kutta", 8), ("galerkin", 4), ("galerkin", 6), ("galerkin", 8)]
CASES = [(*method, name) for method in METHODS for name in FORCES if name != COMPILED]
OFTEN = (
    "a current that varies with depth",
    "waves on a submerged body",
    "a waterplane",
    "a force of one's own",
    "a force of time alone",
)
PLAIN = [*(("gauss", 8, name) for name in OFTEN), ("galerkin", 6, "gusts"), ("runge_kutta", 8, "a current")]


def smooth(vehicle):
    """The vehicle without drag in |v| v, whose kinks no method of high order crosses."""
    linear = vehicle.damping.model_copy(update={"quadratic": (0.0,) * 6, "couplings": ()})
    return vehicle.model_copy(update={"damping": linear, "cross_flow": ()})


def end_of(vehicle, scheme, order, count, settings):
    """Position, attitude and velocity after the motion, in so many steps."""
    floats = vehicle.hydrostatics is not None
    depth, duration, share = (0.0, 0.5, 0.3) if floats else (3.0, 1.4, 1.0)
    scene = Scene(vehicle, step=duration / count, scheme=scheme, order=order, **settings)
    driven = settings.get("actuation") == "thrusters"
    body = scene.stepper() if driven else PlainBody(scene.composition, scene.parameters_at, scene.step)
    body.reset((0.5, 0.2, depth), velocity_body=share * VELOCITY)
    if driven:
        body.actuate(np.linspace(-0.3, 0.3, len(body.command)), count)
    else:
        body.step(steps=count)
    assert body.fallback_steps == 0
    return np.concatenate([body.position_ned, body.quaternion_body_to_ned, body.velocity_body])


@pytest.mark.parametrize(
    ("scheme", "order", "name"),
    sweep([*CASES, ("gauss", 8, COMPILED), ("runge_kutta", 8, COMPILED)], plain=PLAIN),
)
def test_the_order_is_that_of_the_method_under_every_force(scheme, order, name, monkeypatch):
    """The vehicles have damping: "gauss" is Radau's method, of order 7, whose sweeps go on to round-off here."""
    for ending in ("ENDING", "STIFF_ENDING"):
        monkeypatch.setattr(radau_sweeps, ending, Ending(1e-9, 0.0, 1e-9, 0.06))
    vehicle_name, settings = FORCES[name]
    vehicle = smooth(load_vehicle(vehicle_name))
    counts = EXPLICIT_COUNTS.get(name, SHORTER) if scheme == "runge_kutta" else COUNTS[order]
    *ends, exact = [end_of(vehicle, scheme, order, int(n), settings) for n in (*counts, 4 * counts[-1])]
    series = [np.abs(end - exact).max() for end in ends]
    expected = 7 if scheme == "gauss" else order
    assert observed_order(1.0 / counts, series) == pytest.approx(expected, abs=0.5), series


@pytest.mark.sweep
@pytest.mark.parametrize("scheme", ["gauss", "galerkin", "runge_kutta"])
@pytest.mark.parametrize("name", [name for name in FORCES if name != COMPILED])
def test_a_compiled_body_moves_as_a_plain_one(scheme, name):
    """A single body has its stages in the lanes of a vector register; forces must be able to be computed there."""
    vehicle, settings = FORCES[name]
    depth = 0.0 if load_vehicle(vehicle).hydrostatics is not None else 3.0
    scene = Scene(vehicle, step=0.1, scheme=scheme, order=8, **settings)
    compiled, plain = scene.stepper(), PlainBody(scene.composition, scene.parameters_at, scene.step)
    for body in (compiled, plain):
        body.reset((0.5, 0.2, depth), velocity_body=0.3 * VELOCITY)
        body.step(steps=6)
    np.testing.assert_allclose(compiled.get_state(), plain.get_state(), atol=1e-9)
