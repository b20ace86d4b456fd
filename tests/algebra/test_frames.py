"""Frame changes against 4x4 matrices, SciPy and elementary mechanics; the paper's printed forms fail."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from support.bodies import random_inertia
from support.fossen import coriolis, skew
from support.strategies import poses, unit_quaternions, vectors

from dq_marine.algebra import dual_quaternion as dq
from dq_marine.algebra import frames
from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_conjugate,
    dual_multiply,
    pose_from_parts,
    pose_position,
)
from dq_marine.algebra.quaternion import (
    quaternion_add,
    quaternion_from_vector,
    quaternion_multiply,
    quaternion_scale,
    rotation_matrix,
)
from dq_marine.algebra.spatial import Spatial, from_fossen, matrix6_transform, spatial_dot, to_fossen
from dq_marine.backend.packing import pack, unpack
from dq_marine.integrator.body import BodyState, spatial_momentum

CLOSE = {"rtol": 1e-12, "atol": 1e-10}

spatials = st.builds(Spatial, vectors, vectors)
seeds = st.integers(0, 2**32 - 1)


def homogeneous(pose):
    m = np.eye(4)
    m[:3, :3] = Rotation.from_quat(np.roll(pose.real, -1)).as_matrix()
    m[:3, 3] = pose_position(pose)
    return m


def full(blocks):
    parts = [np.reshape(block, (3, 3)) for block in blocks]
    return np.block([[parts[0], parts[1]], [parts[2], parts[3]]])


def close(a, b, **tolerance):
    return np.allclose(pack(a), pack(b), **(tolerance or CLOSE))


def pose_rate(pose, omega_world, origin_velocity):
    """p-dot by the product rule on p = q + eps (1/2) l q, from q-dot = (1/2) omega_W q and l-dot."""
    q_rate = quaternion_scale(0.5, quaternion_multiply(quaternion_from_vector(omega_world), pose.real))
    moved = quaternion_multiply(quaternion_from_vector(origin_velocity), pose.real)
    turned = quaternion_multiply(quaternion_from_vector(pose_position(pose)), q_rate)
    return DualQuaternion(q_rate, quaternion_scale(0.5, quaternion_add(moved, turned)))


def derivative(function, pose, rate):
    """The rate of a polynomial function of a pose, by a complex step."""
    step = 1e-30
    moved = unpack_complex(pack(pose) + 1j * step * pack(rate))
    return np.imag(np.array(function(moved))) / step


def four_masses(rng, pose, rate):
    """Kinetic energy, from their velocities, and 6x6 inertia (angular first) of four masses fixed in a body."""
    energy, inertia = 0.0, np.zeros((6, 6))
    for mass, point in zip(rng.uniform(0.5, 2.0, size=4), rng.normal(size=(4, 3)), strict=True):
        velocity = derivative(lambda moved, at=point: frames.point_to_world(moved, at), pose, rate)
        energy += 0.5 * mass * velocity @ velocity
        to_velocity = np.hstack([-skew(point), np.eye(3)])
        inertia += mass * to_velocity.T @ to_velocity
    return energy, inertia


def unpack_complex(numbers):
    return DualQuaternion(tuple(numbers[:4]), tuple(numbers[4:]))


@given(unit_quaternions)
def test_rotation_matrix_is_scipys(q):
    expected = Rotation.from_quat(np.roll(q, -1)).as_matrix()
    assert np.allclose(np.reshape(rotation_matrix(q), (3, 3)), expected, atol=1e-14)


@given(poses, poses, vectors)
def test_points_and_poses_nest_as_homogeneous_matrices(outer, inner, point):
    nested = dual_multiply(outer, inner)
    expected = homogeneous(outer) @ homogeneous(inner) @ [*point, 1.0]
    assert np.allclose(frames.point_to_world(nested, point), expected[:3], **CLOSE)
    assert np.allclose(frames.point_to_body(nested, expected[:3]), point, **CLOSE)
    seen = frames.pose_relative(outer, nested)
    assert close(seen, inner)
    assert np.allclose(homogeneous(seen), np.linalg.inv(homogeneous(outer)) @ homogeneous(nested), atol=1e-10)


@given(poses, vectors)
def test_a_point_is_carried_by_both_conjugates_at_once(pose, point):
    dual_point = DualQuaternion((1.0, 0.0, 0.0, 0.0), quaternion_from_vector(point))
    carried = dual_multiply(dual_multiply(pose, dual_point), dq.dual_combined_conjugate(pose))
    assert np.allclose(carried.real, (1.0, 0.0, 0.0, 0.0), atol=1e-12)
    assert np.allclose(carried.dual, (0.0, *frames.point_to_world(pose, point)), **CLOSE)


@given(poses, poses, spatials)
def test_adjoint_is_a_representation(p, q, twist):
    sandwich = dual_multiply(dual_multiply(p, frames.dual_from_spatial(twist)), dual_conjugate(p))
    assert close(frames.dual_from_spatial(frames.adjoint(p, twist)), sandwich)
    product = dual_multiply(p, q)
    assert close(frames.adjoint(product, twist), frames.adjoint(p, frames.adjoint(q, twist)), atol=1e-9)
    assert close(frames.adjoint_inverse(p, frames.adjoint(p, twist)), twist, atol=1e-9)
    assert close(frames.adjoint_inverse(p, twist), frames.adjoint(dual_conjugate(p), twist))
    assert close(frames.adjoint(dq.dual_scale(-1.0, p), twist), frames.adjoint(p, twist))
    assert close(matrix6_transform(frames.adjoint_matrix(p), twist), frames.adjoint(p, twist))


@given(poses, poses, spatials, spatials)
def test_coadjoint_is_dual_to_adjoint(p, q, momentum, twist):
    pairing = spatial_dot(frames.coadjoint(p, momentum), twist)
    assert np.isclose(pairing, spatial_dot(momentum, frames.adjoint(p, twist)), rtol=1e-12, atol=1e-9)
    transposed = full(frames.adjoint_matrix(p)).T @ np.concatenate(momentum)
    assert np.allclose(np.concatenate(frames.coadjoint(p, momentum)), transposed, **CLOSE)
    product = dual_multiply(p, q)
    in_turn = frames.coadjoint(q, frames.coadjoint(p, momentum))
    assert close(frames.coadjoint(product, momentum), in_turn, atol=1e-9)
    assert close(frames.coadjoint_inverse(p, frames.coadjoint(p, momentum)), momentum, atol=1e-9)
    assert close(frames.coadjoint_inverse(p, momentum), frames.coadjoint(dual_conjugate(p), momentum))


@given(poses, spatials, spatials)
def test_power_is_the_same_in_both_frames(pose, wrench_body, twist_body):
    power = spatial_dot(wrench_body, twist_body)
    wrench_world = frames.wrench_body_to_world(pose, wrench_body)
    twist_world = frames.twist_body_to_world(pose, twist_body)
    assert np.isclose(spatial_dot(wrench_world, twist_world), power, rtol=1e-12, atol=1e-9)
    assert close(frames.wrench_world_to_body(pose, wrench_world), wrench_body, atol=1e-9)
    assert close(frames.twist_world_to_body(pose, twist_world), twist_body, atol=1e-9)


@given(poses, seeds)
def test_a_wrench_is_the_sum_of_forces_at_points_in_either_frame(pose, seed):
    rng = np.random.default_rng(seed)
    points, forces = rng.normal(size=(2, 4, 3))
    body = Spatial(tuple(np.cross(points, forces).sum(axis=0)), tuple(forces.sum(axis=0)))
    rotation = homogeneous(pose)[:3, :3]
    moved = np.array([frames.point_to_world(pose, point) for point in points])
    turned = forces @ rotation.T
    world = Spatial(tuple(np.cross(moved, turned).sum(axis=0)), tuple(turned.sum(axis=0)))
    assert close(frames.wrench_body_to_world(pose, body), world)
    assert close(frames.wrench_world_to_body(pose, world), body)


@given(poses, spatials)
def test_momentum_in_the_world_is_the_bodys_spatial_momentum(pose, momentum):
    assert close(frames.coadjoint_inverse(pose, momentum), spatial_momentum(BodyState(pose, momentum)))


@given(poses, spatials, seeds)
def test_kinetic_energy_does_not_depend_on_the_reference_point(pose, twist, seed):
    inertia = random_inertia(np.random.default_rng(seed))
    back = full(frames.adjoint_matrix(dual_conjugate(pose)))
    inner, outer = np.concatenate(twist), np.concatenate(frames.adjoint(pose, twist))
    energy = 0.5 * inner @ inertia @ inner
    assert np.isclose(0.5 * outer @ (back.T @ inertia @ back) @ outer, energy, rtol=1e-9)


@given(poses, vectors, vectors, vectors)
def test_twists_are_those_of_a_moving_body(pose, omega_world, origin_velocity, point):
    rotation = homogeneous(pose)[:3, :3]
    rate = pose_rate(pose, omega_world, origin_velocity)
    body = frames.twist_body_from_pose_rate(pose, rate)
    assert np.allclose(body.angular, rotation.T @ omega_world, **CLOSE)
    assert np.allclose(body.linear, rotation.T @ origin_velocity, **CLOSE)
    world = frames.twist_world_from_pose_rate(pose, rate)
    assert np.allclose(world.angular, omega_world, **CLOSE)
    shift = np.cross(omega_world, pose_position(pose))
    assert np.allclose(world.linear, origin_velocity - shift, **CLOSE)
    assert close(frames.twist_body_to_world(pose, body), world)
    assert close(frames.twist_world_to_body(pose, world), body)
    # The velocity of any point of the body follows from either.
    velocity = derivative(lambda moved: frames.point_to_world(moved, point), pose, rate)
    from_body = rotation @ (np.array(body.linear) + np.cross(body.angular, point))
    at = frames.point_to_world(pose, point)
    assert np.allclose(from_body, velocity, **CLOSE)
    assert np.allclose(np.array(world.linear) + np.cross(world.angular, at), velocity, **CLOSE)
    assert close(frames.pose_rate_from_twist_body(pose, body), rate)
    assert close(frames.pose_rate_from_twist_world(pose, world), rate)
    velocity = Spatial(omega_world, origin_velocity)
    assert close(frames.twist_world_from_origin_velocity(pose, velocity), world)
    assert close(frames.origin_velocity_from_twist_world(pose, world), velocity)


@given(poses, vectors, vectors, seeds)
def test_kinetic_energy_is_that_of_the_body_twist(pose, omega_world, origin_velocity, seed):
    rate = pose_rate(pose, omega_world, origin_velocity)
    energy, inertia = four_masses(np.random.default_rng(seed), pose, rate)
    twist = np.concatenate(frames.twist_body_from_pose_rate(pose, rate))
    assert np.isclose(0.5 * twist @ inertia @ twist, energy, rtol=1e-9, atol=1e-9)


@given(poses, spatials, spatials)
def test_a_force_on_the_components_of_the_pose_is_a_wrench(pose, wrench, twist):
    rate = frames.pose_rate_from_twist_world(pose, twist)
    force = frames.generalised_force_from_wrench_world(pose, wrench)
    power = spatial_dot(wrench, twist)
    assert np.isclose(dq.dual_dot(force, rate), power, rtol=1e-12, atol=1e-9)
    assert close(frames.wrench_world_from_generalised_force(pose, force), wrench, atol=1e-9)
    in_body = frames.wrench_world_to_body(pose, wrench)
    assert close(frames.wrench_body_from_generalised_force(pose, force), in_body, atol=1e-9)
    assert close(frames.generalised_force_from_wrench_body(pose, in_body), force, atol=1e-9)


@given(poses, vectors, vectors)
def test_the_gradient_of_a_potential_is_a_wrench(pose, arm, pull):
    """V = -pull . (point's position) for a constant pull on a point of the body; the wrench is arm x pull, pull."""

    def potential(moved):
        return -np.dot(pull, frames.point_to_world(moved, arm))

    gradient = [derivative(potential, pose, unpack(pose, unit)) for unit in np.eye(8)]
    force = unpack(pose, -np.array(gradient))
    at = frames.point_to_world(pose, arm)
    world = Spatial(tuple(np.cross(at, pull)), pull)
    assert close(frames.wrench_world_from_generalised_force(pose, force), world, atol=1e-9)
    local = homogeneous(pose)[:3, :3].T @ pull
    body = Spatial(tuple(np.cross(arm, local)), tuple(local))
    assert close(frames.wrench_body_from_generalised_force(pose, force), body, atol=1e-9)


@given(spatials, spatials, spatials)
def test_the_bracket_is_half_the_commutator_and_obeys_jacobi(a, b, c):
    da, db = frames.dual_from_spatial(a), frames.dual_from_spatial(b)
    commutator = dq.dual_add(dual_multiply(da, db), dq.dual_scale(-1.0, dual_multiply(db, da)))
    assert close(frames.dual_from_spatial(frames.twist_bracket(a, b)), dq.dual_scale(0.5, commutator))
    cycles = [
        frames.twist_bracket(x, frames.twist_bracket(y, z)) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))
    ]
    assert np.allclose(sum(pack(cycle) for cycle in cycles), 0.0, atol=1e-10)
    pairing = spatial_dot(frames.momentum_bracket(a, c), b)
    assert np.isclose(pairing, spatial_dot(c, frames.twist_bracket(a, b)), rtol=1e-12, atol=1e-9)


@given(poses, spatials, spatials)
def test_frame_changes_keep_the_bracket(pose, a, b):
    inside = frames.adjoint(pose, frames.twist_bracket(a, b))
    outside = frames.twist_bracket(frames.adjoint(pose, a), frames.adjoint(pose, b))
    assert close(inside, outside, rtol=1e-12, atol=1e-8)


@given(seeds)
def test_the_momentum_bracket_is_fossens_coriolis_wrench(seed):
    """For any inertia with coupling, ad^T_chi M chi = -C(nu) nu with C by Fossen (2021), Theorem 3.2."""
    rng = np.random.default_rng(seed)
    m, nu = random_inertia(rng), rng.normal(size=6)
    rate = frames.momentum_bracket(from_fossen(tuple(nu)), from_fossen(tuple(m @ nu)))
    assert np.allclose(to_fossen(rate), -coriolis(m, nu) @ nu, atol=1e-10)


@pytest.fixture(params=range(5))
def moving(request):
    """A pose that is neither near the identity nor special, its rate, its velocity, and a wrench."""
    rng = np.random.default_rng(request.param)
    q = rng.uniform(0.3, 1.0, size=4)
    pose = pose_from_parts(tuple(q / np.linalg.norm(q)), tuple(rng.uniform(1.0, 2.0, size=3)))
    velocity = Spatial(tuple(rng.normal(size=3)), tuple(rng.normal(size=3)))
    wrench = Spatial(tuple(rng.normal(size=3)), tuple(rng.normal(size=3)))
    return pose, pose_rate(pose, *velocity), velocity, wrench


def differ(a, b):
    return np.linalg.norm(pack(a) - pack(b)) > 1e-2


def test_the_printed_world_twist_fails(moving):
    """Xu & Halse print l-dot for the linear part of chi_W = 2 p-dot p`."""
    pose, rate, printed, _ = moving
    assert differ(frames.twist_world_from_pose_rate(pose, rate), printed)
    assert differ(frames.twist_body_from_pose_rate(pose, rate), frames.twist_world_to_body(pose, printed))


def test_the_printed_kinetic_energy_fails(moving):
    """Xu & Halse print 2 p p-dot for chi_B = 2 p` p-dot: not even a pure dual quaternion."""
    pose, rate, _, _ = moving
    energy, inertia = four_masses(np.random.default_rng(0), pose, rate)
    printed = dq.dual_scale(2.0, dual_multiply(pose, rate))
    assert abs(printed.real[0]) > 1e-2
    twist = np.concatenate(frames.spatial_from_dual(printed))
    assert abs(0.5 * twist @ inertia @ twist - energy) > 1e-2 * energy


def test_the_printed_world_wrench_fails(moving):
    """Xu & Halse print F* p = 2 tau_W* and F* = 2 tau_W* p`, with the pose and its conjugate changed over."""
    pose, rate, _, wrench = moving
    power = spatial_dot(wrench, frames.twist_world_from_pose_rate(pose, rate))
    force = frames.generalised_force_from_wrench_world(pose, wrench)
    assert np.isclose(dq.dual_dot(force, rate), power, rtol=1e-12)
    printed = frames.generalised_force_from_wrench_world(dual_conjugate(pose), wrench)
    assert abs(dq.dual_dot(printed, rate) - power) > 1e-2
    assert differ(frames.wrench_world_from_generalised_force(dual_conjugate(pose), force), wrench)
