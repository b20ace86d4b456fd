"""Vehicles that touch what is solid: at rest, on slopes, in a narrow place, in lanes, at any stiffness and step."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dq_marine.physics.contact.shapes import Ball, Box, Pillar, Plane, Rod
from dq_marine.physics.contact.solid import Solid
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

ROV = "bluerov2_heavy"
LEVEL = (1.0, 0.0, 0.0, 0.0)
PRESS = (0.0, 0.0, 40.0, 0.0, 0.0, 0.0)
CURRENT = (0.3, -0.1, 0.0)


def scene(*solids, current=(0.0, 0.0, 0.0), step=0.025):
    return Scene(ROV, current=current, solids=solids, step=step)


@pytest.mark.sweep
def test_what_is_pressed_onto_the_seabed_rests_over_ground_in_a_current():
    vehicle = load_vehicle(ROV)
    body = scene(
        Solid(Plane(), (0.0, 0.0, 3.0), friction=0.5, stiffness=2e3, damping_ratio=0.05), current=CURRENT
    ).stepper()
    body.reset((0.0, 0.0, 2.5), LEVEL)
    body.step(PRESS, 400)
    at = body.position_ned
    assert np.abs(body.velocity_body[:3]).max() < 1e-3
    assert np.abs(body.velocity_body[3:]).max() < 3e-3
    pressed = PRESS[2] + vehicle.weight - vehicle.buoyant_force
    lowest = 0.5 * vehicle.dimensions.height
    # Four corners carry the weight, leaning as the moments of weight and current ask.
    assert at[2] + lowest - 3.0 == pytest.approx(pressed / (4 * 2e3), rel=0.1)
    body.step(PRESS, 400)
    assert np.linalg.norm(body.position_ned - at) < 0.01  # it creeps in 10 s


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.6, 1.0])
def test_what_is_pressed_on_a_slope_slides_where_it_is_steeper_than_friction_holds(friction):
    slope = math.radians(20.0)
    seabed = Solid(Plane((math.sin(slope), 0.0, -math.cos(slope))), friction=friction)
    body = scene(seabed).stepper()
    half = 0.5 * slope
    body.reset((0.0, 0.0, -0.3), (math.cos(half), 0.0, -math.sin(half), 0.0))
    down = 400.0 * np.array(
        [-math.sin(slope), 0.0, math.cos(slope), 0.0, 0.0, 0.0]
    )  # straight down, while it lies so
    body.step(down, 80)
    began = body.position_ned
    body.step(down, 40)
    slid = np.linalg.norm(body.position_ned - began)
    if math.tan(slope) > friction:
        assert slid > 0.1
    else:
        assert slid < 0.01


@pytest.mark.sweep
def test_one_that_is_let_go_in_a_narrow_place_ends_at_rest_and_inside():
    """Walls, a ball, a pillar and a rod: whatever it hits, it passes nothing, and is never faster than it began."""
    room = scene(*ROOM, current=CURRENT)
    rng = np.random.default_rng(5)
    for _ in range(3):
        body = room.stepper()
        body.reset((-1.5, 0.0, 0.0), LEVEL, (*rng.uniform(-2.0, 2.0, 3), *rng.uniform(-3.0, 3.0, 3)))
        began = body.kinetic_energy
        for _ in range(200):
            body.step(steps=2)
            assert np.abs(body.position_ned).max() < 2.6
            assert body.kinetic_energy < began
        assert np.linalg.norm(body.velocity_body[:3]) < 0.3  # it is left to the current and its own weight


WALLS = [
    Solid(Plane(tuple(-side * np.eye(3)[axis])), tuple(2.5 * side * np.eye(3)[axis]), friction=0.2)
    for axis in range(3)
    for side in (-1.0, 1.0)
]
ROOM = [
    *WALLS,
    Solid(Ball(0.4), (0.8, 0.8, 0.5), 0.3, damping_ratio=0.3),
    Solid(Box((1.0, 0.5, 0.8)), (1.2, -1.0, 0.2), 0.7),
    Solid(Pillar(0.3), (0.0, -1.8, 0.0)),
    Solid(Rod((0.0, 2.0, 0.5), 0.2), (0.5, -1.0, 1.6)),
]


@pytest.mark.sweep
@pytest.mark.parametrize("size", [8, 19])
def test_bodies_in_contact_are_the_same_alone_and_in_lanes(size):
    room = scene(*ROOM, current=CURRENT)
    rng = np.random.default_rng(size)
    batch, singles = room.batch(size, threads=1), [room.stepper() for _ in range(size)]
    velocities = rng.uniform(-2.0, 2.0, (size, 6))
    positions = np.tile((-1.5, 0.0, 0.0), (size, 1))
    batch.reset(positions, np.tile(LEVEL, (size, 1)), velocities)
    for single, state in zip(singles, batch.get_state(), strict=True):
        single.set_state(state)
    for _ in range(10):
        wrenches = 20.0 * rng.normal(size=(size, 6))
        batch.step(wrenches, 8)
        for single, wrench in zip(singles, wrenches, strict=True):
            single.step(wrench, 8)
        assert np.array_equal(batch.get_state(), np.array([single.get_state() for single in singles]))


def test_steps_are_the_same_however_many_a_call_takes():
    above = scene(Solid(Plane(), (0.0, 0.0, 1.0)))
    one, many = above.stepper(), above.stepper()
    for body in (one, many):
        body.reset((0.0, 0.0, 0.5), LEVEL, (0.5, -1.0, 1.0, 0.3, 0.2, 1.0))
    for _ in range(120):
        one.step(PRESS)
    many.step(PRESS, 120)
    assert np.allclose(one.get_state(), many.get_state(), atol=1e-12)


@pytest.mark.parametrize("step", [1e-3, 0.02, 0.1, 0.5])
@pytest.mark.parametrize("stiffness", [1e2, 1e6, 1e12])
def test_contact_is_stable_whatever_stiffness_and_step(step, stiffness):
    seabed = Solid(Plane(), (0.0, 0.0, 1.0), stiffness=stiffness, damping_ratio=0.0)
    body = scene(seabed, step=step).stepper()
    body.reset((0.0, 0.0, 0.5), LEVEL, (0.5, 0.2, 1.5, 0.5, -1.0, 0.3))
    energy = body.kinetic_energy
    for _ in range(200):
        body.step()
        assert body.kinetic_energy < 1.5 * energy
    body.step(steps=200)
    assert body.kinetic_energy < 0.2 * energy


def test_what_begins_deep_in_a_solid_is_pushed_out_slowly():
    body = scene(Solid(Plane(), (0.0, 0.0, 1.0))).stepper()
    body.reset((0.0, 0.0, 4.0), LEVEL)
    speeds = []
    for _ in range(400):
        body.step()
        speeds.append(np.linalg.norm(body.velocity_body[:3]))
    assert body.position_ned[2] < 1.0
    assert max(speeds) < 1.2


def test_a_scene_without_solids_computes_nothing_of_them():
    assert "contact" not in scene().terms
    assert "contact" in scene(Solid(Plane())).terms
    assert scene().composition == Scene(ROV, step=0.025).composition
