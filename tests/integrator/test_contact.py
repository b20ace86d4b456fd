"""Contact, one touch in plain Python: what a push may do to the momentum, whatever the inertia, pose and surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from support.bodies import PlainBody, make_body, random_inertia, random_quaternion

from dq_marine.algebra.dual_quaternion import pose_from_parts, pose_position
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.spatial import from_fossen, spatial_subtract, to_fossen
from dq_marine.algebra.vector3 import add, cross
from dq_marine.integrator.inertia import momentum_from_twist, twist_from_momentum
from dq_marine.physics.contact.build import contact_of
from dq_marine.physics.contact.hull import spheres_about
from dq_marine.physics.contact.shapes import Ball, Plane
from dq_marine.physics.contact.solid import Solid
from dq_marine.physics.matrices import inertia_term

seeds = st.integers(0, 10_000)
decades = st.floats(-3.0, 9.0)
STILL = from_fossen((0.0,) * 6)


BALL = spheres_about([(0.0, 0.0, 0.0)], 0.1)
CORNERS = spheres_about([(x, y, z) for x in (-1.0, 1.0) for y in (-0.5, 0.5) for z in (-0.3, 0.3)], 0.1)


def touched(matrix, hull, solids, pose, momentum, h, flow=STILL):
    """The momentum after contact with solids over a time h, in water of a twist."""
    term = contact_of(hull, matrix, solids)
    touch = term.contact(lambda parameters, pose: flow)
    return touch(term.parameters, (), inertia_term(matrix), h, pose, momentum)


def energy(matrix, momentum, flow=STILL):
    """Of the motion over ground: what contact must not raise, as a quadratic form of M."""
    twist = np.array(to_fossen(twist_from_momentum(inertia_term(matrix), momentum))) + to_fossen(flow)
    return 0.5 * twist @ matrix @ twist


def drawn(seed):
    """An inertia, a pose near the origin and a momentum."""
    rng = np.random.default_rng(seed)
    matrix = random_inertia(rng, 100.0)
    pose = pose_from_parts(tuple(random_quaternion(rng)), tuple(0.3 * rng.normal(size=3)))
    return matrix, pose, from_fossen(tuple(3.0 * rng.normal(size=6)))


@given(seeds, decades, st.floats(0.0, 3.0), st.floats(0.0, 2.0), st.floats(-3.0, 1.0))
def test_energy_grows_by_no_more_than_the_springs_held(seed, stiffness, ratio, friction, log_h):
    matrix, pose, momentum = drawn(seed)
    solid = Solid(Plane(), friction=friction, stiffness=10.0**stiffness, damping_ratio=ratio)
    after = touched(matrix, CORNERS, [solid], pose, momentum, 10.0**log_h)
    position = np.array(rotate_all(pose, CORNERS))
    depths = np.maximum(0.1 + position[:, 2], 0.0)
    held = 0.5 * 10.0**stiffness * np.sum(depths**2)
    assert energy(matrix, after) <= energy(matrix, momentum) + held + 1e-9 * (1.0 + energy(matrix, momentum))


def rotate_all(pose, hull):
    """Where the spheres are in NED."""
    origin = pose_position(pose)
    return [add(origin, rotate(pose.real, center)) for center in zip(hull.x, hull.y, hull.z, strict=True)]


@given(seeds, st.floats(0.0, 2.0), decades)
def test_one_sphere_is_pushed_away_and_held_within_the_cone_of_friction(seed, friction, stiffness):
    matrix, pose, momentum = drawn(seed)
    solid = Solid(Ball(1.0), friction=friction, stiffness=10.0**stiffness)
    after = touched(matrix, BALL, [solid], pose, momentum, 0.05)
    push = np.array(rotate(pose.real, spatial_subtract(after, momentum).linear))
    outward = np.array(rotate_all(pose, BALL)[0])
    outward /= np.linalg.norm(outward)
    along = push @ outward
    size = 1e-9 * (1.0 + np.linalg.norm(push))
    assert along >= -1e-6 * size
    sideways = np.linalg.norm(push - along * outward)
    # The normal is a central difference of the distance: it errs by the square of its step.
    assert sideways <= friction * along + 1e-6 * np.linalg.norm(push) + size


@given(seeds, st.booleans())
def test_what_is_infinitely_stiff_and_rough_stops_the_place_of_contact(seed, coupled):
    rng = np.random.default_rng(seed)
    matrix = random_inertia(rng, 100.0, coupled=coupled)
    inertia = inertia_term(matrix)
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, -0.1 + 1e-9))
    solid = Solid(Plane(), friction=100.0, stiffness=1e15)
    falling = momentum_from_twist(inertia, from_fossen((0.3, -0.2, 1.0, *rng.normal(size=3))))
    after = touched(matrix, BALL, [solid], pose, falling, 0.05)
    twist = twist_from_momentum(inertia, after)
    place = add(twist.linear, cross(twist.angular, (0.0, 0.0, 0.1)))
    assert place[2] < 1e-5
    if not coupled:  # else to stop it sideways may lift it off
        assert_allclose(place, 0.0, atol=1e-5)


def test_what_is_not_touched_keeps_its_bits():
    matrix, pose, momentum = drawn(1)
    far = [Solid(Plane(), (0.0, 0.0, 5.0)), Solid(Ball(0.5), (9.0, 0.0, 0.0))]
    assert touched(matrix, CORNERS, far, pose, momentum, 0.05) == momentum


def test_without_friction_nothing_changes_along_a_plane():
    rng = np.random.default_rng(3)
    matrix, pose, momentum = drawn(3)
    normal = rng.normal(size=3)
    smooth = Solid(Plane(tuple(normal)), friction=0.0)
    after = touched(matrix, CORNERS, [smooth], pose, momentum, 0.05)
    push = np.array(rotate(pose.real, spatial_subtract(after, momentum).linear))
    assert np.linalg.norm(push) > 0.1
    assert_allclose(np.cross(push, normal / np.linalg.norm(normal)), 0.0, atol=1e-6 * np.linalg.norm(push))


def test_friction_is_over_ground_whatever_the_water_does():
    """A vehicle at rest on the seabed in a current: its momentum relative to the water stays as it is."""
    matrix = np.diag([10.0, 12.0, 14.0, 1.0, 1.0, 1.0])
    flow = from_fossen((0.5, -0.2, 0.0, 0.0, 0.0, 0.0))
    at_rest = momentum_from_twist(inertia_term(matrix), from_fossen((-0.5, 0.2, 0.0, 0.0, 0.0, 0.0)))
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, -0.09))
    # Just as deep as balances nothing: without stiffness there is no push, and friction holds what is at rest anyway.
    after = touched(matrix, BALL, [Solid(Plane(), stiffness=1e-6)], pose, at_rest, 0.05, flow)
    assert_allclose(to_fossen(after), to_fossen(at_rest), atol=1e-6)
    drifting = touched(matrix, BALL, [Solid(Plane(), friction=5.0, stiffness=1e4)], pose, STILL, 0.05, flow)
    assert energy(matrix, drifting, flow) < energy(matrix, STILL, flow) + 0.5 * 1e4 * 0.01**2


@pytest.mark.parametrize("ratio", [0.0, 0.1, 0.3, 0.6])
def test_what_hits_rebounds_as_the_closed_form_says(ratio):
    """Restitution of a spring and a damper that does not pull: Schwager and Poeschel 2007, Granular Matter 9, 465."""
    matrix = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    solid = Solid(Plane(), friction=0.0, stiffness=2.0 * 20.0**2, damping_ratio=ratio)
    expected = math.exp(-ratio / math.sqrt(1.0 - ratio**2) * contact_angle(ratio))
    errors = [abs(rebound(matrix, solid, h) - expected) for h in (2e-3, 1e-3, 5e-4)]
    assert errors[-1] < 0.02
    assert errors[0] > 1.5 * errors[1] > 2.25 * errors[2]  # of first order in the step


def contact_angle(ratio):
    """Of the swing in contact, from touching to the moment when the force would begin to pull [rad]."""
    swing = math.sqrt(1.0 - ratio**2)
    turned = math.atan2(2.0 * ratio * swing, 1.0 - 2.0 * ratio**2)
    return math.pi - turned


def rebound(matrix, solid, h):
    """Speed after a hit, over that before it."""
    body = make_body(matrix, h, contact=contact_of(BALL, matrix, [solid]), kind=PlainBody)
    body.reset((0.0, 0.0, -0.1 - 1e-6), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.5, 0.0, 0.0, 0.0))
    body.step(steps=round(0.25 / h))
    assert body.position_ned[2] < -0.1
    return -body.velocity_body[2] / 0.5
