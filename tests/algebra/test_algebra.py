"""Laws of quaternions, dual quaternions and 6x6 blocks, against SciPy and NumPy."""

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from support.strategies import poses, quaternions, unit_quaternions, vectors

from dq_marine.algebra import dual_quaternion as dq
from dq_marine.algebra import matrix3, spatial, vector3
from dq_marine.algebra import quaternion as qt
from dq_marine.physics.matrices import angular_first, matrix6

CLOSE = {"rtol": 1e-12, "atol": 1e-9}


def rotation(q):
    return Rotation.from_quat(np.roll(q, -1))


@given(unit_quaternions, unit_quaternions, vectors)
def test_rotation_agrees_with_scipy_and_composes(p, q, a):
    assert np.allclose(qt.rotate(q, a), rotation(q).apply(a), **CLOSE)
    assert np.allclose(qt.rotate_inverse(q, qt.rotate(q, a)), a, **CLOSE)
    together = qt.quaternion_multiply(p, q)
    assert np.allclose(qt.rotate(together, a), qt.rotate(p, qt.rotate(q, a)), **CLOSE)
    assert np.allclose(qt.rotate(qt.quaternion_scale(-1.0, q), a), qt.rotate(q, a), **CLOSE)


@given(unit_quaternions, vectors, st.floats(-1e-9, 1e-9))
def test_a_length_that_is_nearly_one_is_divided_out(q, a, excess):
    longer = qt.quaternion_scale(1.0 + 0.5 * excess, q)
    found = qt.excess_of_length(longer)
    assert abs(found - excess) < 1e-15
    assert abs(qt.excess_of_length(qt.quaternion_renormalise(longer))) < 1e-15
    size = 1.0 + np.abs(a).max()
    assert np.allclose(qt.rotate_scaled(longer, found, a), qt.rotate(q, a), rtol=0.0, atol=4e-15 * size)


@given(unit_quaternions)
def test_down_is_the_third_row_of_the_rotation_matrix(q):
    assert np.allclose(qt.world_down_in_body(q), rotation(q).as_matrix()[2], **CLOSE)


@given(quaternions, quaternions, quaternions)
def test_quaternion_product_is_associative_and_norms_multiply(a, b, c):
    left = qt.quaternion_multiply(qt.quaternion_multiply(a, b), c)
    right = qt.quaternion_multiply(a, qt.quaternion_multiply(b, c))
    assert np.allclose(left, right, rtol=1e-9, atol=1e-9)
    product = qt.quaternion_multiply(a, b)
    assert np.isclose(
        qt.quaternion_dot(product, product),
        qt.quaternion_dot(a, a) * qt.quaternion_dot(b, b),
        rtol=1e-9,
        atol=1e-9,
    )


@given(poses, poses, vectors)
def test_pose_product_nests_frames(outer, inner, point):
    """p1 p2 places the inner frame in the outer one: rotation and translation of homogeneous matrices."""
    product = dq.dual_multiply(outer, inner)
    expected = np.array(dq.pose_position(outer)) + qt.rotate(outer.real, dq.pose_position(inner))
    assert np.allclose(dq.pose_position(product), expected, **CLOSE)
    assert np.allclose(
        qt.rotate(product.real, point), qt.rotate(outer.real, qt.rotate(inner.real, point)), **CLOSE
    )


@given(unit_quaternions, vectors, vectors)
def test_pose_round_trip_translation_and_inverse(q, position, displacement):
    pose = dq.pose_from_parts(q, position)
    assert np.allclose(dq.pose_position(pose), position, **CLOSE)
    assert abs(qt.quaternion_dot(pose.real, pose.dual)) < 1e-12
    moved = dq.pose_translate(pose, displacement)
    assert np.allclose(dq.pose_position(moved), vector3.add(position, displacement), **CLOSE)
    assert moved.real == pose.real
    one = dq.dual_multiply(pose, dq.dual_conjugate(pose))
    assert np.allclose(one.real, (1.0, 0.0, 0.0, 0.0), **CLOSE)
    assert np.allclose(one.dual, (0.0,) * 4, **CLOSE)


@given(poses, st.floats(-1e-8, 1e-8), st.floats(-1e-8, 1e-8))
def test_renormalising_restores_both_constraints_and_keeps_the_position(pose, stretch, along):
    real = qt.quaternion_scale(1.0 + stretch, pose.real)
    dual = qt.quaternion_add(
        qt.quaternion_scale(1.0 + stretch, pose.dual), qt.quaternion_scale(along, pose.real)
    )
    restored = dq.pose_renormalise(dq.DualQuaternion(real, dual))
    assert abs(qt.quaternion_dot(restored.real, restored.real) - 1.0) < 5e-15
    assert abs(qt.quaternion_dot(restored.real, restored.dual)) < 1e-14
    assert np.allclose(dq.pose_position(restored), dq.pose_position(pose), atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_blocks_agree_with_numpy(seed):
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(6, 6)), rng.normal(size=(6, 6))
    x, d, e = rng.normal(size=(3, 6))
    pair = spatial.Spatial(tuple(x[:3]), tuple(x[3:]))
    diagonal = spatial.Spatial(tuple(d[:3]), tuple(d[3:]))
    columns = spatial.Spatial(tuple(e[:3]), tuple(e[3:]))

    def full(m):
        blocks = [np.reshape(block, (3, 3)) for block in m]
        return np.block([[blocks[0], blocks[1]], [blocks[2], blocks[3]]])

    def flat(pair):
        return np.concatenate(pair)

    assert np.allclose(flat(spatial.matrix6_transform(matrix6(a), pair)), a @ x)
    assert np.allclose(full(spatial.matrix6_multiply(matrix6(a), matrix6(b))), a @ b)
    assert np.allclose(full(spatial.matrix6_add_scaled(matrix6(a), 0.3, matrix6(b))), a + 0.3 * b)
    assert np.allclose(full(spatial.matrix6_add_diagonal(matrix6(a), diagonal)), a + np.diag(d))
    sandwich = spatial.spatial_scale_rows_and_columns(diagonal, matrix6(a), columns)
    assert np.allclose(full(sandwich), np.diag(d) @ a @ np.diag(e))
    positive = a @ a.T + np.eye(6)
    solved = flat(spatial.matrix6_solve(matrix6(positive), pair))
    assert np.allclose(positive @ solved, x, atol=1e-9)


@given(st.integers(0, 2**32 - 1))
def test_matrix3_agrees_with_numpy(seed):
    rng = np.random.default_rng(seed)
    m = rng.normal(size=(3, 3)) + 3.0 * np.eye(3)
    flat = tuple(m.ravel())
    assert np.isclose(matrix3.determinant(flat), np.linalg.det(m))
    assert np.allclose(np.reshape(matrix3.invert(flat), (3, 3)), np.linalg.inv(m))
    assert np.allclose(np.reshape(matrix3.adjugate(flat), (3, 3)) @ m, np.linalg.det(m) * np.eye(3))


@given(st.integers(0, 2**32 - 1))
def test_negative_real_eigenvalues_are_found(seed):
    rng = np.random.default_rng(seed)
    m = rng.normal(size=(3, 3)) + rng.uniform(-1.0, 2.0) * np.eye(3)
    eigenvalues = np.linalg.eigvals(m)
    real = eigenvalues[np.abs(eigenvalues.imag) < 1e-9].real
    near_double = np.abs(eigenvalues.imag).max() < 1e-3 * np.abs(eigenvalues).max()
    if np.abs(real).min() > 1e-6 and not near_double:
        assert matrix3.has_negative_real_eigenvalue(tuple(m.ravel())) == bool((real < 0.0).any())


@given(st.integers(0, 2**32 - 1))
@example(1705)  # 93 and twice -0.008
def test_two_equal_negative_eigenvalues_are_found(seed):
    """As an axisymmetric body has them: round-off must not hide the double root."""
    rng = np.random.default_rng(seed)
    basis, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    positive, negative = np.exp(rng.uniform(-5.0, 5.0, 2))
    m = basis @ np.diag([positive, -negative, -negative]) @ basis.T
    assert matrix3.has_negative_real_eigenvalue(tuple(m.ravel()))


def test_two_negative_eigenvalues_are_found_though_the_determinant_is_positive():
    assert matrix3.has_negative_real_eigenvalue((5.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0))
    assert matrix3.has_negative_real_eigenvalue((float("nan"),) * 9)
    assert not matrix3.has_negative_real_eigenvalue((5.0, 0.0, 0.0, 0.0, -1.0, 9.0, 0.0, -9.0, -1.0))


@given(st.tuples(*[st.floats(-1e3, 1e3)] * 6))
def test_fossen_order_round_trip(components):
    pair = spatial.from_fossen(components)
    assert pair.linear == components[:3]
    assert pair.angular == components[3:]
    assert spatial.to_fossen(pair) == components


def test_reordering_a_matrix_moves_the_angular_block_first():
    m = np.arange(36.0).reshape(6, 6)
    reordered = angular_first(m)
    assert np.array_equal(reordered[:3, :3], m[3:, 3:])
    assert np.array_equal(reordered[:3, 3:], m[3:, :3])
    assert np.array_equal(angular_first(reordered), m)
