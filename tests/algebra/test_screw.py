"""Exponential, logarithm, screws and sclerp: against 50 digits, SciPy and the definition of a screw motion."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from mpmath import mp, mpf
from scipy.linalg import expm
from scipy.spatial.transform import Rotation
from support.fossen import skew
from support.strategies import poses, unit_quaternions, vectors

from dq_marine.algebra import frames, screw
from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_inner,
    dual_multiply,
    dual_scale,
    pose_from_parts,
    pose_position,
)
from dq_marine.algebra.quaternion import rotation_matrix
from dq_marine.algebra.screw import Screw, pose_exp, pose_log, sclerp
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.backend.packing import pack

PRECISE = 8e-16
"""A few units in the last place of float64 (2.2e-16)."""

SMALL = [0.0, 1e-300, 1e-160, 1e-30, 1e-12, 1e-8, 1e-6, 1e-4, 1e-2, 0.1, 1.0]
AT_THE_SERIES_END = [2.0 - 1e-9, 2.0, 2.0 + 1e-9]
UP_TO_PI = [*SMALL, *AT_THE_SERIES_END, 3.0, 3.14, 3.1415926, math.pi * (1 - 1e-12)]
BEYOND_PI = [4.0, 5.0, 6.0, 6.28]

IDENTITY = DualQuaternion((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))

spatials = st.builds(Spatial, vectors, vectors)


@pytest.fixture(autouse=True)
def fifty_digits():
    with mp.workdps(50):
        yield


def displacements(angle, count=8):
    """Displacements of a given angle: the linear part anywhere, along the axis and across it, of 1e-3 to 1e3 m."""
    rng = np.random.default_rng(int(angle * 1000))
    for number in range(count):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        linear = rng.normal(size=3) * 10.0 ** rng.uniform(-3.0, 3.0)
        if number % 3 == 1:
            linear = axis * linear[0]
        if number % 3 == 2:
            linear = np.cross(axis, linear)
        yield Spatial(tuple((angle * axis).tolist()), tuple(linear.tolist()))


def exact_product(a, b):
    """The product of dual quaternions, eight numbers each, in mpmath's arithmetic."""

    def product(p, q):
        return [
            p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
        ]

    dual = [x + y for x, y in zip(product(a[:4], b[4:]), product(a[4:], b[:4]), strict=True)]
    return product(a[:4], b[:4]) + dual


def exact_exp(displacement, first=0):
    """The sum of (chi/2)^k/k! from k = `first`: the definition, and none of the package's formulas."""
    half = [mpf(c) / 2 for c in (0.0, *displacement.angular, 0.0, *displacement.linear)]
    term = [mpf(c) for c in (1, 0, 0, 0, 0, 0, 0, 0)]
    total = [c * (first == 0) for c in term]
    for k in range(1, 60):
        term = [c / k for c in exact_product(term, half)]
        total = [x + y for x, y in zip(total, term, strict=True)]
    return total


def exact_log(pose):
    """The shortest displacement to the unit dual quaternion nearest to `pose`, by its screw."""
    with mp.workdps(800):  # numbers as far apart as 1 and 1e-300 are subtracted
        real, dual = ([mpf(c) for c in part] for part in pose)
        norm = size(real)
        if real[0] < 0:
            norm = -norm
        real, dual = [c / norm for c in real], [c / norm for c in dual]
        excess = sum(x * y for x, y in zip(real, dual, strict=True))
        dual = [y - excess * x for x, y in zip(real, dual, strict=True)]
        sine = size(real[1:])
        if sine == 0:
            return [mpf(0)] * 3, [2 * c for c in dual[1:]]
        angle = 2 * mp.atan2(sine, real[0])
        axis = [c / sine for c in real[1:]]
        along = sum(x * y for x, y in zip(axis, dual[1:], strict=True))
        moment = [(y - along * n) / sine for n, y in zip(axis, dual[1:], strict=True)]
        shift = -2 * dual[0] / sine
        linear = [shift * n + angle * m for n, m in zip(axis, moment, strict=True)]
        return [angle * n for n in axis], linear


def size(components):
    return mp.sqrt(sum(mpf(c) ** 2 for c in components))


def distance(a, b):
    return size([mpf(x) - mpf(y) for x, y in zip(a, b, strict=True)])


@pytest.mark.parametrize("angle", [*UP_TO_PI, *BEYOND_PI])
def test_exp_has_full_precision(angle):
    for displacement in displacements(angle):
        pose, exact = pose_exp(displacement), exact_exp(displacement)
        assert distance(pose.real, exact[:4]) <= PRECISE
        assert distance(pose.dual, exact[4:]) <= PRECISE * size(displacement.linear) / 2
        if angle <= 3.2:  # near 2 pi the vector part vanishes, and its relative error grows
            assert distance(pose.real[1:], exact[1:4]) <= PRECISE * size(exact[1:4])


@pytest.mark.parametrize("angle", UP_TO_PI)
def test_log_has_full_precision(angle):
    for displacement in displacements(angle):
        rounded = [float(c) for c in exact_exp(displacement)]
        pose = DualQuaternion(tuple(rounded[:4]), tuple(rounded[4:]))
        angular, linear = exact_log(pose)
        found = pose_log(pose)
        assert distance(found.angular, angular) <= PRECISE * size(angular)
        assert distance(found.linear, linear) <= PRECISE * size(linear)


@pytest.mark.parametrize("angle", UP_TO_PI)
def test_log_undoes_exp(angle):
    for displacement in displacements(angle):
        back = pose_log(pose_exp(displacement))
        assert distance(back.angular, displacement.angular) <= 2 * PRECISE * angle
        assert distance(back.linear, displacement.linear) <= 2 * PRECISE * size(displacement.linear)


@pytest.mark.parametrize("angle", BEYOND_PI)
def test_log_of_more_than_half_a_turn_goes_the_other_way_round(angle):
    for displacement in displacements(angle):
        turn = np.array(pose_log(pose_exp(displacement)).angular)
        axis = np.array(displacement.angular) / angle
        assert np.allclose(turn, (angle - 2.0 * math.pi) * axis, atol=1e-14)


@given(poses)
def test_exp_undoes_log_up_to_the_sign(pose):
    again = pose_exp(pose_log(pose))
    sign = math.copysign(1.0, dual_inner(pose, again)[0])
    assert np.allclose(sign * pack(again), pack(pose), atol=1e-13)


@given(spatials)
def test_exp_agrees_with_scipy(displacement):
    generator = np.zeros((4, 4))
    generator[:3, :3] = skew(displacement.angular)
    generator[:3, 3] = displacement.linear
    expected = expm(generator)
    pose = pose_exp(displacement)
    assert np.allclose(np.reshape(rotation_matrix(pose.real), (3, 3)), expected[:3, :3], atol=1e-12)
    assert np.allclose(pose_position(pose), expected[:3, 3], atol=1e-11)


@given(poses)
def test_log_turns_as_scipy_does(pose):
    turn = Rotation.from_quat(np.roll(pose.real, -1)).as_rotvec()
    own = np.array(pose_log(pose).angular)
    at_half_a_turn = math.pi - np.linalg.norm(turn) < 1e-9  # either direction is right
    assert np.allclose(own, turn, atol=1e-12) or (at_half_a_turn and np.allclose(own, -turn, atol=1e-8))


def test_the_printed_series_fails():
    """Xu & Halse start the series of exp at k = 1: then exp(0) is not the identity."""
    for displacement in displacements(0.7):
        right, printed = exact_exp(displacement), exact_exp(displacement, first=1)
        assert distance(pack(pose_exp(displacement)), right) < 1e-12
        assert distance(pack(pose_exp(displacement)), printed) > 0.99


@pytest.mark.parametrize("square", [0.0, 1e-320, 1e-16, 1e-8, 0.3, math.nextafter(1.0, 0.0), 1.0, 1.5, 9.0])
def test_sine_ratios_are_exact_on_both_sides_of_the_threshold(square):
    with mp.workdps(700):
        angle = mp.sqrt(mpf(square) + mpf("1e-340"))
        sinc = mp.sin(angle) / angle
        slope = (mp.cos(angle) - sinc) / angle**2
    own = screw.sine_ratios(square)
    assert abs(own[0] - sinc) <= PRECISE / 2 * abs(sinc)
    assert abs(own[1] - slope) <= PRECISE * abs(slope)


@pytest.mark.parametrize("centre", [1e-3, 1.0 - 2e-4, 1.0, 1.0 + 2e-4, 4.0])
def test_derivatives_of_the_sine_ratios_pass_the_threshold_smoothly(centre):
    """Difference quotients below, across and above it, against those of 50 digits at the same points."""
    low, high = centre - 1e-4, centre + 1e-4

    def exact(square):
        sinc = mp.sin(mp.sqrt(square)) / mp.sqrt(square)
        return sinc, (mp.cos(mp.sqrt(square)) - sinc) / square

    own = [
        (b - a) / (high - low) for a, b in zip(screw.sine_ratios(low), screw.sine_ratios(high), strict=True)
    ]
    for mine, a, b in zip(own, exact(mpf(low)), exact(mpf(high)), strict=True):
        assert abs(mine - (b - a) / (mpf(high) - mpf(low))) < 4 * 2.2e-16 / 2e-4


@pytest.mark.parametrize("angle", [1e-5, 0.5, 2.0 - 2e-4, 2.0, 2.0 + 2e-4, 3.0])
def test_derivatives_of_exp_and_log_along_the_angle(angle):
    direction = next(displacements(1.0))
    low, high = (
        Spatial(tuple(t * c for c in direction.angular), direction.linear)
        for t in (angle - 1e-6, angle + 1e-6)
    )
    quotient = (pack(pose_exp(high)) - pack(pose_exp(low))) / 2e-6
    exact = [(b - a) / mpf(2e-6) for a, b in zip(exact_exp(low), exact_exp(high), strict=True)]
    scale = 1.0 + float(size(direction.linear))
    assert distance(quotient, exact) < 1e-9 * scale
    back = (pack(pose_log(pose_exp(high))) - pack(pose_log(pose_exp(low)))) / 2e-6
    assert np.allclose(back, (pack(high) - pack(low)) / 2e-6, atol=1e-8 * scale)


def test_exp_and_log_of_next_to_nothing_are_linear():
    tiny = Spatial((3e-200, -4e-200, 1e-250), (1e-180, 2e-210, -5e-200))
    pose = pose_exp(tiny)
    assert pose == DualQuaternion((1.0, 1.5e-200, -2e-200, 5e-251), (0.0, 5e-181, 1e-210, -2.5e-200))
    assert pose_log(pose) == tiny


def test_what_is_not_finite_becomes_nan_and_raises_nothing():
    for bad in (math.inf, -math.inf, math.nan, 1e200):
        assert math.isnan(pose_exp(Spatial((0.0, bad, 0.0), (0.0, 0.0, 0.0))).real[0])
    assert math.isnan(screw.length((0.0, math.nan, 0.0)))
    assert math.isnan(pose_log(DualQuaternion((math.nan,) * 4, (0.0,) * 4)).angular[0])


@given(poses)
def test_minus_a_pose_is_the_same_pose(pose):
    assert pose_log(dual_scale(-1.0, pose)) == pose_log(pose)
    assert np.linalg.norm(pose_log(pose).angular) <= math.pi * (1.0 + 1e-15)


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, -0.6, 0.8)])
@pytest.mark.parametrize("scalar", [0.0, -0.0])
def test_half_a_turn_has_one_direction(axis, scalar):
    pose = pose_from_parts((scalar, *axis), (1.0, 2.0, 3.0))
    displacement = pose_log(pose)
    assert pose_log(dual_scale(-1.0, pose)) == displacement
    assert np.isclose(np.linalg.norm(displacement.angular), math.pi)
    assert next(c for c in displacement.angular if c != 0.0) > 0.0
    assert np.allclose(pose_position(pose_exp(displacement)), (1.0, 2.0, 3.0), atol=1e-14)


@pytest.mark.parametrize("magnitude", [5e-324, 1e-310, 1e-200, 1.0, 1e160, 1e308])
def test_length_neither_overflows_nor_underflows(magnitude):
    a = (magnitude * 0.5, -magnitude, magnitude * 0.25)
    assert abs(screw.length(a) - size(a)) <= PRECISE * size(a) + mpf(5e-324)
    assert screw.length((0.0, 0.0, 0.0)) == 0.0


@given(unit_quaternions, vectors, st.floats(1e-3, 3.1), st.floats(-5.0, 5.0))
def test_a_screw_turns_about_its_axis_and_shifts_along_it(q, through, angle, translation):
    axis = frames.rotate(q, (1.0, 0.0, 0.0))
    motion = Screw(axis, tuple(np.cross(through, axis)), angle, translation)
    pose = screw.pose_from_screw(motion)
    for along in (-1.0, 0.0, 2.0):  # points of the axis stay on it
        point = tuple(np.array(through) + along * np.array(axis))
        moved = np.array(point) + translation * np.array(axis)
        assert np.allclose(frames.point_to_world(pose, point), moved, atol=1e-11)
    assert np.allclose(pose_log(pose).angular, angle * np.array(axis), atol=1e-12)
    found = screw.screw_from_pose(pose)
    assert np.allclose(pack(found), pack(motion), rtol=1e-9, atol=1e-12 / angle)
    assert abs(np.dot(found.axis, found.moment)) <= 4e-16 * (1.0 + np.linalg.norm(found.moment))
    assert screw.screw_pitch(motion) == translation / angle
    foot = screw.screw_point(motion)
    assert np.allclose(np.cross(foot, axis), motion.moment, atol=1e-12)
    assert abs(np.dot(foot, axis)) < 1e-12


@pytest.mark.parametrize("angle", UP_TO_PI)
def test_displacement_and_screw_are_two_forms_of_one(angle):
    for displacement in displacements(angle):
        motion = screw.screw_from_displacement(displacement)
        assert distance(motion.axis, (0.0, 0.0, 0.0)) == pytest.approx(1.0, abs=PRECISE)
        back = screw.displacement_from_screw(motion)
        assert distance(back.angular, displacement.angular) <= PRECISE * angle
        assert distance(back.linear, displacement.linear) <= 2 * PRECISE * size(displacement.linear)
        assert motion.angle == pytest.approx(angle, rel=PRECISE, abs=0.0)


def test_the_axis_of_a_pure_translation_is_its_direction():
    motion = screw.screw_from_pose(pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, -3.0, 4.0)))
    assert motion == Screw((0.0, -0.6, 0.8), (0.0, 0.0, 0.0), 0.0, 5.0)
    assert screw.screw_pitch(motion) == math.inf
    assert pose_position(screw.pose_from_screw(motion)) == pytest.approx((0.0, -3.0, 4.0), abs=1e-15)
    assert screw.screw_pitch(motion._replace(translation=-5.0)) == -math.inf
    assert screw.screw_from_pose(IDENTITY) == Screw((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0, 0.0)


@pytest.mark.parametrize(("angle", "turns"), [(0.99e-305, False), (1.01e-305, True)])
def test_a_turn_that_cannot_be_told_from_a_translation(angle, turns):
    displacement = Spatial((0.0, angle, 0.0), (0.0, 0.0, 1.0))
    motion = screw.screw_from_displacement(displacement)
    assert (motion.angle > 0.0) is turns
    assert all(math.isfinite(c) for c in pack(motion))
    back = screw.displacement_from_screw(motion)
    assert back.linear == pytest.approx((0.0, 0.0, 1.0), abs=1e-15)
    assert back.angular == pytest.approx((0.0, angle, 0.0), abs=1e-305)
    assert screw.screw_from_displacement(Spatial((0.0, 1e-320, 0.0), (0.0, 0.0, 0.0))).angle == 1e-320


@given(poses, spatials)
def test_the_adjoint_of_exp_is_that_of_the_displacement(pose, displacement):
    """Carried to other frames, g exp(chi) g^-1 = exp(Ad_g chi); in the moved frame itself chi is the same."""
    carried = dual_multiply(pose, pose_exp(displacement))
    other = dual_multiply(pose_exp(frames.adjoint(pose, displacement)), pose)
    assert np.allclose(pack(carried), pack(other), atol=1e-9)
    assert np.allclose(
        pack(frames.adjoint(pose_exp(displacement), displacement)), pack(displacement), atol=1e-9
    )


@given(spatials, spatials)
def test_the_bracket_is_the_rate_of_the_adjoint(a, b):
    step = 1e-6
    ahead, behind = (frames.adjoint(pose_exp(spatial_scale(s, a)), b) for s in (step, -step))
    rate = (pack(ahead) - pack(behind)) / (2.0 * step)
    assert np.allclose(rate, pack(frames.twist_bracket(a, b)), atol=1e-4)


@given(poses, poses)
def test_sclerp_begins_and_ends_where_it_should_the_shorter_way(start, end):
    assert sclerp(start, end, 0.0) == start
    arrived = pack(sclerp(start, end, 1.0))
    assert np.allclose(arrived, pack(end), atol=1e-12) or np.allclose(-arrived, pack(end), atol=1e-12)
    assert sclerp(start, dual_scale(-1.0, end), 0.3) == sclerp(start, end, 0.3)
    way = pose_log(frames.pose_relative(start, sclerp(start, end, 0.5)))
    assert np.linalg.norm(way.angular) <= 0.5 * math.pi + 1e-12


@given(poses, poses, st.floats(-1.0, 2.0), st.floats(0.01, 0.3))
def test_sclerp_moves_with_constant_twist_in_body_and_world(start, end, fraction, ahead):
    displacement = pose_log(frames.pose_relative(start, end))
    at, then = sclerp(start, end, fraction), sclerp(start, end, fraction + ahead)
    in_body = pose_log(frames.pose_relative(at, then))
    assert np.allclose(pack(in_body), ahead * pack(displacement), atol=1e-11)
    in_world = frames.adjoint(at, spatial_scale(1.0 / ahead, in_body))
    assert np.allclose(pack(in_world), pack(frames.adjoint(start, displacement)), atol=1e-8)


@given(poses, poses, poses, st.floats(0.0, 1.0))
def test_sclerp_does_not_depend_on_the_frames(start, end, frame, fraction):
    turn = np.linalg.norm(pose_log(frames.pose_relative(start, end)).angular)
    assume(turn < math.pi - 1e-6)  # half a turn may be made in either direction
    way = sclerp(start, end, fraction)
    outer = sclerp(dual_multiply(frame, start), dual_multiply(frame, end), fraction)
    assert np.allclose(pack(outer), pack(dual_multiply(frame, way)), atol=1e-8)
    inner = sclerp(dual_multiply(start, frame), dual_multiply(end, frame), fraction)
    assert np.allclose(pack(inner), pack(dual_multiply(way, frame)), atol=1e-8)
