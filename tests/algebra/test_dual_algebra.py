"""Axioms of dual quaternions, in whole numbers and so exactly; and one text for scalars, arrays and compiled code."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.strategies import poses

from dq_marine.algebra import dual_quaternion as dq
from dq_marine.algebra import frames, screw
from dq_marine.algebra import quaternion as qt
from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts
from dq_marine.algebra.screw import pose_exp, pose_log, sclerp
from dq_marine.algebra.spatial import Matrix6, Spatial
from dq_marine.backend.batched import batched
from dq_marine.backend.packing import pack

whole = st.integers(-20, 20).map(float)
quaternions = st.tuples(whole, whole, whole, whole)
duals = st.builds(DualQuaternion, quaternions, quaternions)

ONE = DualQuaternion((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
EPS = DualQuaternion((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
ZERO = DualQuaternion((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))


@given(duals, duals, duals, whole)
def test_dual_quaternions_are_an_associative_algebra_with_one(a, b, c, s):
    multiply, plus, scale = dq.dual_multiply, dq.dual_add, dq.dual_scale
    assert multiply(multiply(a, b), c) == multiply(a, multiply(b, c))
    assert multiply(a, plus(b, c)) == plus(multiply(a, b), multiply(a, c))
    assert multiply(plus(a, b), c) == plus(multiply(a, c), multiply(b, c))
    assert multiply(ONE, a) == a == multiply(a, ONE)
    assert multiply(scale(s, a), b) == scale(s, multiply(a, b)) == multiply(a, scale(s, b))
    assert plus(a, scale(-1.0, a)) == ZERO


@given(duals)
def test_eps_commutes_and_its_square_is_zero(a):
    assert dq.dual_multiply(EPS, EPS) == ZERO
    assert dq.dual_multiply(EPS, a) == dq.dual_multiply(a, EPS) == DualQuaternion(ZERO.real, a.real)


@given(duals, duals)
def test_two_conjugates_reverse_products_and_one_keeps_them(a, b):
    product = dq.dual_multiply(a, b)
    for conjugate in (dq.dual_conjugate, dq.dual_combined_conjugate):
        assert conjugate(conjugate(a)) == a
        assert conjugate(product) == dq.dual_multiply(conjugate(b), conjugate(a))
    assert dq.dual_number_conjugate(dq.dual_number_conjugate(a)) == a
    assert dq.dual_number_conjugate(product) == dq.dual_multiply(
        dq.dual_number_conjugate(a), dq.dual_number_conjugate(b)
    )
    assert dq.dual_combined_conjugate(a) == dq.dual_conjugate(dq.dual_number_conjugate(a))
    assert dq.dual_combined_conjugate(a) == dq.dual_number_conjugate(dq.dual_conjugate(a))


@given(duals, duals)
def test_the_transpose_swaps_the_parts_and_keeps_the_scalar_product(a, b):
    assert dq.dual_transpose(a) == DualQuaternion(a.dual, a.real)
    assert dq.dual_transpose(dq.dual_transpose(a)) == a
    assert dq.dual_dot(a, b) == float(np.dot(pack(a), pack(b))) == dq.dual_dot(b, a)
    assert dq.dual_dot(dq.dual_transpose(a), dq.dual_transpose(b)) == dq.dual_dot(a, b)


@given(duals, duals, duals)
def test_the_two_rules_of_the_scalar_product(a, b, c):
    """Both move a factor across; they are what carries a force on p's components to a wrench."""
    star, conjugate, multiply = dq.dual_transpose, dq.dual_conjugate, dq.dual_multiply
    together = dq.dual_dot(a, multiply(b, c))
    assert together == dq.dual_dot(star(c), multiply(conjugate(b), star(a)))
    assert together == dq.dual_dot(star(b), multiply(star(a), conjugate(c)))


def test_the_rules_need_the_transpose():
    a, b, c = (DualQuaternion(tuple(range(k, k + 4)), tuple(range(k + 4, k + 8))) for k in (1, 2, 5))
    together = dq.dual_dot(a, dq.dual_multiply(b, c))
    assert together != dq.dual_dot(c, dq.dual_multiply(dq.dual_conjugate(b), a))
    assert together != dq.dual_dot(b, dq.dual_multiply(a, dq.dual_conjugate(c)))


@given(duals, duals)
def test_the_dual_number_product_is_the_scalar_part(a, b):
    product = dq.dual_multiply(dq.dual_conjugate(a), b)
    assert dq.dual_inner(a, b) == (product.real[0], product.dual[0])
    assert dq.dual_inner(a, b) == dq.dual_inner(b, a)


@given(poses, poses, poses)
def test_unit_dual_quaternions_are_a_group_and_keep_the_dual_number_product(a, b, c):
    product = dq.dual_multiply(a, b)
    assert np.allclose(dq.dual_inner(product, product), (1.0, 0.0), atol=1e-12)
    one = dq.dual_multiply(product, dq.dual_multiply(dq.dual_conjugate(b), dq.dual_conjugate(a)))
    assert np.allclose(pack(one), pack(ONE), atol=1e-12)
    expected = dq.dual_inner(a, b)
    assert np.allclose(dq.dual_inner(dq.dual_multiply(c, a), dq.dual_multiply(c, b)), expected, atol=1e-11)
    assert np.allclose(dq.dual_inner(dq.dual_multiply(a, c), dq.dual_multiply(b, c)), expected, atol=1e-11)


ARITHMETIC = (
    (qt.quaternion_add, "qq"),
    (qt.quaternion_subtract, "qq"),
    (qt.quaternion_scale, "sq"),
    (qt.quaternion_dot, "qq"),
    (qt.quaternion_multiply, "qq"),
    (qt.quaternion_conjugate, "q"),
    (qt.quaternion_from_vector, "v"),
    (qt.quaternion_vector, "q"),
    (qt.rotate, "qv"),
    (qt.rotate_inverse, "qv"),
    (qt.rotate_scaled, "qsv"),
    (qt.excess_of_length, "q"),
    (qt.quaternion_renormalise, "q"),
    (qt.rotation_matrix, "q"),
    (qt.world_down_in_body, "q"),
    (dq.dual_add, "pp"),
    (dq.dual_scale, "sp"),
    (dq.dual_multiply, "pp"),
    (dq.dual_conjugate, "p"),
    (dq.dual_number_conjugate, "p"),
    (dq.dual_combined_conjugate, "p"),
    (dq.dual_transpose, "p"),
    (dq.dual_dot, "pp"),
    (dq.dual_inner, "pp"),
    (dq.pose_from_parts, "qv"),
    (dq.pose_position, "p"),
    (dq.pose_translate, "pv"),
    (dq.pose_renormalise, "p"),
    (frames.point_to_world, "pv"),
    (frames.point_to_body, "pv"),
    (frames.pose_relative, "pp"),
    (frames.dual_from_spatial, "t"),
    (frames.spatial_from_dual, "p"),
    (frames.adjoint, "pt"),
    (frames.adjoint_inverse, "pt"),
    (frames.coadjoint, "pt"),
    (frames.coadjoint_inverse, "pt"),
    (frames.adjoint_matrix, "p"),
    (frames.twist_bracket, "tt"),
    (frames.momentum_bracket, "tt"),
    (frames.momentum_bracket_slope, "mtt"),
    (frames.twist_body_to_world, "pt"),
    (frames.twist_world_to_body, "pt"),
    (frames.wrench_body_to_world, "pt"),
    (frames.wrench_world_to_body, "pt"),
    (frames.twist_world_from_origin_velocity, "pt"),
    (frames.origin_velocity_from_twist_world, "pt"),
    (frames.twist_body_from_pose_rate, "pp"),
    (frames.twist_world_from_pose_rate, "pp"),
    (frames.pose_rate_from_twist_body, "pt"),
    (frames.pose_rate_from_twist_world, "pt"),
    (frames.generalised_force_from_wrench_world, "pt"),
    (frames.generalised_force_from_wrench_body, "pt"),
    (frames.wrench_world_from_generalised_force, "pp"),
    (frames.wrench_body_from_generalised_force, "pp"),
)
"""Every function of quaternions, dual quaternions and frames, with the kinds of its arguments."""


def draw(kind, rng, shape):
    """Arrays for a scalar, vector, unit quaternion, unit dual quaternion, twist or 6x6 matrix."""
    if kind == "s":
        return rng.normal(size=shape)
    if kind == "v":
        return tuple(rng.normal(size=(3, *shape)))
    if kind == "t":
        return Spatial(draw("v", rng, shape), draw("v", rng, shape))
    if kind == "m":
        return Matrix6(*(tuple(rng.normal(size=(9, *shape))) for _ in range(4)))
    if kind == "p":
        return pose_from_parts(draw("q", rng, shape), draw("v", rng, shape))
    q = rng.normal(size=(4, *shape))
    return tuple(q / np.linalg.norm(q, axis=0))


def entry(structure, index):
    """One entry of nested tuples of arrays, as floats."""
    if not isinstance(structure, tuple):
        return float(structure[index])
    parts = [entry(part, index) for part in structure]
    return type(structure)(*parts) if hasattr(structure, "_fields") else tuple(parts)


def components(structure):
    if not isinstance(structure, tuple):
        return [structure]
    return list(itertools.chain.from_iterable(components(part) for part in structure))


def bits(structure, shape):
    return [np.broadcast_to(c, shape).astype(float).tobytes() for c in components(structure)]


def one_after_the_other(functions):
    """One function that calls all, on nested pairs of their arguments: so that they compile together."""
    if not functions:

        def end(arguments):
            return ()

        return end
    first, rest = functions[0], one_after_the_other(functions[1:])

    def call(arguments):
        return (first(*arguments[0]), rest(arguments[1]))

    return call


GROUPS = [ARITHMETIC[i : i + 10] for i in range(0, len(ARITHMETIC), 10)]
TOGETHER = [one_after_the_other([function for function, _ in group]) for group in GROUPS]


def test_no_function_is_left_out():
    named = {function for function, _ in ARITHMETIC}
    for module in (qt, dq, frames):
        own = {
            value
            for value in vars(module).values()
            if getattr(value, "__module__", "") == module.__name__ and not isinstance(value, type)
        }
        assert own <= named


@pytest.mark.parametrize("group", range(len(GROUPS)))
@settings(max_examples=20)
@given(
    st.integers(0, 2**32 - 1),
    st.one_of(st.tuples(st.integers(1, 5)), st.tuples(st.integers(1, 4), st.integers(1, 3))),
)
def test_scalars_arrays_and_compiled_code_have_the_same_bits(group, seed, shape):
    rng = np.random.default_rng(seed)
    arguments = ()
    for _, kinds in reversed(GROUPS[group]):
        arguments = (tuple(draw(kind, rng, shape) for kind in kinds), arguments)
    on_arrays = TOGETHER[group](arguments)
    compiled = batched(TOGETHER[group])(arguments)
    assert bits(on_arrays, shape) == bits(compiled, shape)
    for index in np.ndindex(shape):
        single = components(TOGETHER[group](entry(arguments, index)))
        assert np.array(single).tobytes() == pack(entry(compiled, index)).tobytes()


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.sampled_from([(), (4,), (3, 2), (0,)]))
def test_branching_functions_have_the_same_bits_in_batches(seed, shape):
    """Functions with branches: compiled over leading axes, against plain Python; all branches are met."""
    rng = np.random.default_rng(seed)
    angle = rng.choice([0.0, 1e-300, 1e-8, 0.5, 2.0, 3.0, 6.0], size=shape)
    direction = rng.normal(size=(2, 3, *shape))
    chi = Spatial(tuple(angle * direction[0]), tuple(direction[1]))
    pose = batched(pose_exp)(chi)
    other = batched(pose_exp)(Spatial(tuple(direction[1]), tuple(direction[0])))
    motion = batched(screw.screw_from_pose)(pose)
    for function, arguments in (
        (pose_exp, (chi,)),
        (pose_log, (pose,)),
        (screw.pose_shortest, (pose,)),
        (screw.screw_from_pose, (pose,)),
        (screw.screw_from_displacement, (chi,)),
        (screw.displacement_from_screw, (motion,)),
        (screw.pose_from_screw, (motion,)),
        (screw.screw_pitch, (motion,)),
        (screw.screw_point, (motion,)),
        (screw.length, (chi.linear,)),
        (screw.sine_ratios, (angle,)),
        (sclerp, (pose, other, angle)),
    ):
        together = batched(function)(*arguments)
        for index in np.ndindex(shape):
            single = function(*entry(arguments, index))
            assert type(single) is type(entry(together, index))
            assert pack(single).tobytes() == pack(entry(together, index)).tobytes()


def test_batches_broadcast():
    start, end = ONE, pose_exp(Spatial((0.1, 0.2, 0.3), (1.0, 2.0, 3.0)))
    way = batched(sclerp)(start, end, np.linspace(0.0, 1.0, 5))
    assert way.real[0].shape == (5,)
    assert np.array_equal(pack(entry(way, 2)), pack(sclerp(start, end, 0.5)))
