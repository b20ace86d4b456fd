"""Buoyancy of a hull of boxes against closed forms, clipped boxes and conserved energy."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from support.barges import DENSITY, GRAVITY, HEIGHT, LENGTH, WIDTH, barge, clipped
from support.bodies import random_quaternion

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.errors import InvalidInputError
from dq_marine.physics.hydrostatics.build import hull_terms, submerged_terms
from dq_marine.physics.hydrostatics.flotation import hull_stiffness
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, load_vehicle

SPECIFIC_WEIGHT = DENSITY * GRAVITY


def wrench_of(terms, depth, rotation):
    """Moment and force of force terms, body axes."""
    x, y, z, w = rotation.as_quat()
    pose = pose_from_parts((w, x, y, z), (0.3, -0.2, depth))
    parts = [term.function(term.parameters, pose, 0.0) for term in terms]
    return np.sum([part.angular for part in parts], axis=0), np.sum([part.linear for part in parts], axis=0)


def potential(vehicle, depth, rotation, cells):
    """Energy of weight and of the columns, from their definition, by quadrature."""
    down = rotation.as_matrix().T @ [0.0, 0.0, 1.0]
    weight = vehicle.weight * (depth + down @ np.array(vehicle.rigid_body.center_of_mass))
    total = -weight
    for box, (along, across) in zip(vehicle.hull, cells, strict=True):
        a, b, height = box.size[0] / along, box.size[1] / across, box.size[2]
        fraction = 0.5
        if vehicle.hydrostatics is not None:
            fraction = 0.5 + (vehicle.hydrostatics.equilibrium_depth + box.position[2]) / height
        c2 = 1.0 / (6.0 * fraction * (1.0 - fraction))
        reach = 0.5 * math.sqrt((height * down[2]) ** 2 + c2 * ((a * down[0]) ** 2 + (b * down[1]) ** 2))
        for i in range(along):
            for j in range(across):
                middle = [(i + 0.5) * a - 0.5 * box.size[0], (j + 0.5) * b - 0.5 * box.size[1], 0.0]
                e = depth + down @ (np.array(box.position) + middle)
                low, high = max(0.0, e - reach), max(0.0, e + reach)
                total += SPECIFIC_WEIGHT * a * b * height * (high**2 - low**2) / (4.0 * reach)
    return total


# Statics


@settings(max_examples=60)
@given(
    depth=st.floats(-1.5, 1.5),
    angles=st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)),
    floats=st.booleans(),
)
def test_the_wrench_is_the_gradient_of_the_potential(depth, angles, floats):
    vehicle = barge(cells=(3, 2), center_of_mass=(0.1, -0.05, 0.1), floats=floats)
    rotation, small = Rotation.from_euler("ZYX", angles), 1e-5
    moment, force = wrench_of(hull_terms(vehicle), depth, rotation)

    def at(dz, turn):
        return potential(vehicle, depth + dz, rotation * Rotation.from_rotvec(turn), [(3, 2)])

    push = (at(-small, np.zeros(3)) - at(small, np.zeros(3))) / (2.0 * small)
    turns = [(at(0.0, -small * e) - at(0.0, small * e)) / (2.0 * small) for e in np.eye(3)]
    scale = vehicle.weight
    assert rotation.apply(force) == pytest.approx([0.0, 0.0, push], abs=1e-3 * scale)
    assert moment == pytest.approx(turns, abs=1e-3 * scale)


@pytest.mark.parametrize("cells", [(1, 1), (2, 3), None])
def test_upright_draft_and_stiffness_are_exact_with_any_columns(cells):
    """B = W at the draft, and GM = KB + BM - KG with BM = W^2/(12 T) and L^2/(12 T)."""
    draft, z_g = 0.3, 0.1
    vehicle = barge(draft, (0.0, 0.0, z_g), cells)
    terms, depth, small = hull_terms(vehicle), draft - 0.5 * HEIGHT, 1e-4
    _, force = wrench_of(terms, depth, Rotation.identity())
    assert force == pytest.approx([0.0, 0.0, 0.0], abs=1e-9 * vehicle.weight)
    metacentric = [0.5 * draft + size**2 / (12.0 * draft) - (0.5 * HEIGHT - z_g) for size in (WIDTH, LENGTH)]
    expected = [SPECIFIC_WEIGHT * LENGTH * WIDTH, *(vehicle.weight * gm for gm in metacentric)]
    _, up = wrench_of(terms, depth - small, Rotation.identity())
    _, down = wrench_of(terms, depth + small, Rotation.identity())
    measured = [(up[2] - down[2]) / (2.0 * small)]
    for axis in range(2):
        turn = small * np.eye(3)[axis]
        ahead, _ = wrench_of(terms, depth, Rotation.from_rotvec(turn))
        back, _ = wrench_of(terms, depth, Rotation.from_rotvec(-turn))
        measured.append((back[axis] - ahead[axis]) / (2.0 * small))
    assert measured == pytest.approx(expected, rel=1e-6)
    assert hull_stiffness(vehicle) == pytest.approx(np.diag(expected), rel=1e-12, abs=1e-9)
    assert Scene(vehicle, hydrostatics="hull").restoring_frequencies == pytest.approx(
        Scene(vehicle).restoring_frequencies
    )


@pytest.mark.parametrize("degrees", [5, 15, 30, 45, 60, 90, 120, 135, 160, 175])
def test_the_righting_arm_is_that_of_a_clipped_box(degrees):
    """At the draft at which buoyancy balances weight, with the heel held: to a hundredth of the width."""
    angle, draft, z_g = math.radians(degrees), 0.35, 0.1
    vehicle = barge(draft, (0.0, 0.0, z_g), cells=(1, 40))
    terms, rotation = hull_terms(vehicle), Rotation.from_euler("x", angle)
    depth = brentq(lambda z: rotation.apply(wrench_of(terms, z, rotation)[1])[2], -1.0, 1.0, xtol=1e-12)
    exact_depth = brentq(lambda z: clipped(angle, z)[0] - WIDTH * draft, -1.0, 1.0, xtol=1e-12)
    _, center = clipped(angle, exact_depth)
    # Buoyancy pushes up at the centre of buoyancy; weight down at the centre of mass, (-z_G sin, z_G cos).
    righting = center[0] + z_g * math.sin(angle)
    moment, _ = wrench_of(terms, depth, rotation)
    assert depth == pytest.approx(exact_depth, abs=0.01 * HEIGHT)
    assert -moment[0] / vehicle.weight == pytest.approx(righting, abs=0.01 * WIDTH)


@pytest.mark.parametrize("degrees", [3.0, 10.0, 20.0])
def test_the_righting_arm_is_the_wall_sided_formula(degrees):
    """GZ = (GM + BM tan^2(phi)/2) sin(phi) while deck and bilge stay where they are."""
    angle, draft, z_g = math.radians(degrees), 0.4, 0.1
    vehicle = barge(draft, (0.0, 0.0, z_g), cells=(1, 40))
    terms, rotation = hull_terms(vehicle), Rotation.from_euler("x", angle)
    depth = brentq(lambda z: rotation.apply(wrench_of(terms, z, rotation)[1])[2], -1.0, 1.0, xtol=1e-12)
    bm = WIDTH**2 / (12.0 * draft)
    gm = 0.5 * draft + bm - (0.5 * HEIGHT - z_g)
    arm = (gm + 0.5 * bm * math.tan(angle) ** 2) * math.sin(angle)
    assert -wrench_of(terms, depth, rotation)[0][0] / vehicle.weight == pytest.approx(arm, rel=2e-3)


def test_under_water_it_is_weight_and_buoyancy():
    vehicle = barge(0.5, (0.1, 0.05, 0.08), cells=(3, 3), floats=False)
    rng = np.random.default_rng(0)
    content = vehicle.model_dump()
    content["buoyancy"] |= {"center": (0.0, 0.0, 0.0)}
    submerged = submerged_terms(Vehicle.model_validate(content))
    for _ in range(10):
        x, y, z, w = random_quaternion(rng)
        rotation = Rotation.from_quat((x, y, z, w))
        deep = wrench_of(hull_terms(vehicle), 3.0 + rng.random(), rotation)
        assert np.allclose(deep, wrench_of(submerged, 3.0, rotation), rtol=1e-12, atol=1e-8)


@pytest.mark.sweep
def test_the_otter_floats_on_its_hull_as_on_its_waterplane():
    """Boxes fitted to the published numbers: alike in rest and, to some per cent, in stiffness."""
    vehicle = load_vehicle("otter")
    assert np.allclose(np.diag(hull_stiffness(vehicle)), np.diag(vehicle.waterplane_stiffness), rtol=0.08)
    bodies = [Scene(vehicle, step=0.02, hydrostatics=kind).stepper() for kind in ("linear", "hull")]
    for body in bodies:
        body.step(steps=2000)
    assert bodies[1].position_ned[2] == pytest.approx(bodies[0].position_ned[2], rel=0.1)
    pitches = [2.0 * body.quaternion_body_to_ned[2] for body in bodies]
    assert pitches[1] == pytest.approx(pitches[0], abs=math.radians(0.5))


# Motions


def total_energy(vehicle, body, cells):
    rotation = Rotation.from_quat(np.roll(body.quaternion_body_to_ned, -1))
    nu = body.velocity_body
    kinetic = 0.5 * nu @ vehicle.mass_matrix @ nu
    return kinetic + potential(vehicle, body.position_ned[2], rotation, [cells])


def test_energy_is_kept_while_it_capsizes():
    """A top-heavy box, let go almost upright, rolls over and over: bounded, and falling with the step.

    With its square where the potential is smooth; where columns come up it has kinks, which cost part of that.
    """
    cells = (2, 6)
    vehicle = barge(0.4, (0.0, 0.0, -0.25), cells, floats=False)
    worst = []
    for step in (0.02, 0.00125):
        body = Scene(vehicle, step=step, hydrostatics="hull").stepper()
        body.reset((0.0, 0.0, 0.0), (math.cos(0.01), math.sin(0.01), 0.0, 0.0))
        initial = total_energy(vehicle, body, cells)
        error, lowest = 0.0, 1.0
        for _ in range(200):
            body.step(steps=round(0.1 / step))
            error = max(error, abs(total_energy(vehicle, body, cells) - initial))
            lowest = min(lowest, abs(body.quaternion_body_to_ned[0]))
        assert lowest < 0.2
        worst.append(error / (vehicle.weight * HEIGHT))
    assert worst[0] < 3e-3
    assert worst[0] / worst[1] > 50.0


def test_a_top_heavy_box_capsizes_and_stays_upside_down():
    vehicle = barge(0.4, (0.0, 0.0, -0.25), (2, 6), floats=False, damping=0.5)
    body = Scene(vehicle, step=0.01, hydrostatics="hull").stepper()
    body.reset((0.0, 0.0, 0.0), (math.cos(0.01), math.sin(0.01), 0.0, 0.0))
    body.step(steps=6000)
    assert abs(body.quaternion_body_to_ned[1]) == pytest.approx(1.0, abs=1e-4)
    assert body.position_ned[2] == pytest.approx(0.0, abs=1e-4)


def test_a_box_thrown_out_of_the_water_falls_freely():
    """Without added mass: a parabola as long as it is out, then a splash that it comes back from."""
    vehicle = barge(0.2, (0.0, 0.0, 0.05), (2, 6), added=0.0, damping=0.3)
    bare = vehicle.model_copy(update={"damping": barge(0.2).damping})
    body = Scene(bare, step=0.01, hydrostatics="hull").stepper()
    body.reset((0.0, 0.0, -1.0), velocity_body=(1.0, 0.0, -4.0, 0.0, 0.0, 0.0))
    body.step(steps=50)
    assert body.position_ned == pytest.approx((0.5, 0.0, -1.0 - 4.0 * 0.5 + 0.5 * GRAVITY * 0.25), rel=1e-9)
    body = Scene(vehicle, step=0.01, hydrostatics="hull").stepper()
    body.reset((0.0, 0.0, -2.0))
    deepest = max(_depths(body, 8000))
    assert deepest > 0.5 * HEIGHT
    assert body.position_ned[2] == pytest.approx(0.2 - 0.5 * HEIGHT, abs=1e-3)


def _depths(body, steps):
    for _ in range(steps):
        body.step()
        yield body.position_ned[2]


HEELING = barge(0.35, (0.0, 0.05, 0.1), (2, 6), floats=False, damping=0.3)


@pytest.mark.sweep
def test_a_batch_has_the_bits_of_single_boxes():
    scene = Scene(HEELING, step=0.01, hydrostatics="hull")
    rng = np.random.default_rng(1)
    batch = scene.batch(9, threads=1)
    positions = rng.normal(size=(9, 3))
    quaternions = np.array([random_quaternion(rng) for _ in range(9)])
    batch.reset(positions, quaternions)
    batch.step((5.0, 0.0, 0.0, 0.0, 0.0, 0.0), 60)
    for i in range(9):
        body = scene.stepper()
        body.reset(positions[i], quaternions[i])
        body.step((5.0, 0.0, 0.0, 0.0, 0.0, 0.0), 60)
        assert np.array_equal(batch.position_ned[i], body.position_ned)
        assert np.array_equal(batch.quaternion_body_to_ned[i], body.quaternion_body_to_ned)


# What is refused


def test_hydrostatics_must_be_known_and_have_what_they_need():
    with pytest.raises(InvalidInputError, match=r"hydrostatics = 'panels'.*linear.*hull"):
        Scene("otter", hydrostatics="panels")
    with pytest.raises(InvalidInputError, match=r"BlueROV2.*no hull.*\[\[hull\]\]"):
        Scene("bluerov2", hydrostatics="hull")


def test_equal_boxes_share_their_code_and_a_scene_without_hull_has_none():
    otter = Scene("otter", hydrostatics="hull")
    assert len(set(otter.composition.pose_forces[2:])) == 2
    assert otter.terms[:3] == ("net weight", "righting moment", "buoyancy of hull box 0")
    assert not any("hull" in term for term in Scene("otter").terms)


@pytest.mark.sweep  # tests/simulation has them without a hull
@pytest.mark.parametrize(
    ("precision", "arithmetic", "tolerance"), [("float64", "fast", 1e-10), ("float32", "strict", 1e-4)]
)
def test_single_precision_and_fast_arithmetic_are_near(precision, arithmetic, tolerance):
    """Some steps of a box that heels and bobs, before its motion tells roundings apart."""
    scene = Scene(HEELING, step=0.01, hydrostatics="hull")
    rng = np.random.default_rng(2)
    positions = rng.normal(scale=0.2, size=(5, 3))
    quaternions = np.array([random_quaternion(rng) for _ in range(5)])
    results = []
    for options in ({}, {"precision": precision, "arithmetic": arithmetic}):
        batch = scene.batch(5, threads=1, **options)
        batch.reset(positions, quaternions)
        batch.step(steps=50)
        results.append(batch.position_ned)
    assert np.allclose(results[1], results[0], atol=tolerance)
