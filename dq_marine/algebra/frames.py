"""Points, poses, twists, momenta and wrenches from one frame to another.

A pose p = q + eps (1/2) l q is the transformation from an inner frame to an outer one; here they are called body
and world, and any two frames will do. Poses nest by `dual_multiply(outer, inner)`. R is the rotation of q.

Twists and what is paired with them, wrenches and momenta, transform in different ways:

    adjoint               Ad_p chi      = p chi p` = [R omega; R v + l x R omega]          (Fr1)
    coadjoint             Ad_p^T mu     = [R^T (m - l x f); R^T f],   mu = [m; f]          (Fr2)

Ad_p takes a twist from body to world, Ad_p^T a wrench from world to body, and their inverses go back. The
pairing stays: mu_W . Ad_p chi_B = Ad_p^T mu_W . chi_B, so power and kinetic energy are the same in all frames.

The twist in the world frame is the paper's chi_W = 2 p-dot p` (Xu & Halse, arXiv 1611.00616): the velocity field
of the body, taken at the world's origin. Its linear part is v_W = l-dot - omega_W x l, not the velocity l-dot of
the body's origin, as the paper prints. Likewise a wrench in the world frame has its moment about the world's
origin.

Throughout ` is the quaternion conjugate of both parts (`dual_conjugate`), and spatial vectors hold the angular
part first: twist [rad/s; m/s], momentum [N m s; N s], wrench [N m; N].
"""

from __future__ import annotations

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_conjugate,
    dual_multiply,
    dual_scale,
    dual_transpose,
    pose_position,
)
from dq_marine.algebra.matrix3 import (
    cross_matrix,
    matrix_add,
    matrix_multiply,
    matrix_scale,
    matrix_subtract,
)
from dq_marine.algebra.quaternion import (
    quaternion_from_vector,
    quaternion_vector,
    rotate,
    rotate_inverse,
    rotation_matrix,
)
from dq_marine.algebra.spatial import Matrix6, Spatial
from dq_marine.algebra.vector3 import Vector3, add, cross, subtract


def point_to_world(pose: DualQuaternion, point_body: Vector3) -> Vector3:
    """Return a point's world coordinates [m], R a + l: the eps part of p (1 + eps a) p with both conjugates."""
    return add(rotate(pose.real, point_body), pose_position(pose))


def point_to_body(pose: DualQuaternion, point_world: Vector3) -> Vector3:
    """Return a point's body coordinates [m], R^T (a - l)."""
    return rotate_inverse(pose.real, subtract(point_world, pose_position(pose)))


def pose_relative(reference: DualQuaternion, pose: DualQuaternion) -> DualQuaternion:
    """Return `pose` as seen from `reference`, both in the same frame: dual_multiply(reference, it) is `pose`."""
    return dual_multiply(dual_conjugate(reference), pose)


def dual_from_spatial(a: Spatial) -> DualQuaternion:
    """Return the pure dual quaternion angular + eps linear."""
    return DualQuaternion(quaternion_from_vector(a.angular), quaternion_from_vector(a.linear))


def spatial_from_dual(a: DualQuaternion) -> Spatial:
    """Return the vector parts of a; the scalar parts are dropped."""
    return Spatial(quaternion_vector(a.real), quaternion_vector(a.dual))


def adjoint(pose: DualQuaternion, twist: Spatial) -> Spatial:
    """Return Ad_p of a twist (Fr1): given in the inner frame, returned in the outer one.

    Lines in Pluecker coordinates [direction; moment] transform alike.
    """
    angular = rotate(pose.real, twist.angular)
    return Spatial(angular, add(rotate(pose.real, twist.linear), cross(pose_position(pose), angular)))


def adjoint_inverse(pose: DualQuaternion, twist: Spatial) -> Spatial:
    """Return Ad_p^-1 of a twist, [R^T omega; R^T (v - l x omega)]: from the outer frame to the inner one."""
    linear = subtract(twist.linear, cross(pose_position(pose), twist.angular))
    return Spatial(rotate_inverse(pose.real, twist.angular), rotate_inverse(pose.real, linear))


def coadjoint(pose: DualQuaternion, momentum: Spatial) -> Spatial:
    """Return Ad_p^T of a momentum or a wrench (Fr2): given in the outer frame, returned in the inner one.

    With p the increment of a step this is the transport of the body momentum (docs/theory.md, "Drift").
    """
    angular = subtract(momentum.angular, cross(pose_position(pose), momentum.linear))
    return Spatial(rotate_inverse(pose.real, angular), rotate_inverse(pose.real, momentum.linear))


def coadjoint_inverse(pose: DualQuaternion, momentum: Spatial) -> Spatial:
    """Return Ad_p^-T of a momentum or a wrench, [R m + l x R f; R f]: from the inner frame to the outer one."""
    linear = rotate(pose.real, momentum.linear)
    return Spatial(add(rotate(pose.real, momentum.angular), cross(pose_position(pose), linear)), linear)


def adjoint_matrix(pose: DualQuaternion) -> Matrix6:
    """Return the 6x6 matrix of Ad_p, [[R, 0], [S(l) R, R]], S(l) a = l x a.

    An inertia M about the inner origin is Ad^T M Ad about the outer one, with Ad that of the pose's inverse.
    """
    rotation = rotation_matrix(pose.real)
    skew = cross_matrix(pose_position(pose))
    nothing = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return Matrix6(rotation, nothing, matrix_multiply(skew, rotation), rotation)


def twist_bracket(a: Spatial, b: Spatial) -> Spatial:
    """Return ad_a b = [omega_a x omega_b; omega_a x v_b + v_a x omega_b], the rate of Ad of exp(s a) on b at s = 0.

    Half the commutator: (a b - b a)/2 as pure dual quaternions.
    """
    return Spatial(
        cross(a.angular, b.angular),
        add(cross(a.angular, b.linear), cross(a.linear, b.angular)),
    )


def momentum_bracket(twist: Spatial, momentum: Spatial) -> Spatial:
    """Return ad_chi^T mu = [m x omega + f x v; f x omega]: mu' of Kirchhoff's equations without forces."""
    return Spatial(
        add(cross(momentum.angular, twist.angular), cross(momentum.linear, twist.linear)),
        cross(momentum.linear, twist.angular),
    )


def momentum_bracket_slope(inertia: Matrix6, twist: Spatial, momentum: Spatial) -> Matrix6:
    """Return the derivative of ad_chi^T M chi with respect to chi, where mu = M chi."""
    turning, moving = cross_matrix(twist.angular), cross_matrix(twist.linear)
    angular, linear = cross_matrix(momentum.angular), cross_matrix(momentum.linear)

    first = matrix_add(
        matrix_multiply(turning, inertia.angular), matrix_multiply(moving, inertia.linear_angular)
    )
    second = matrix_add(
        matrix_multiply(turning, inertia.angular_linear), matrix_multiply(moving, inertia.linear)
    )
    return Matrix6(
        matrix_subtract(angular, first),
        matrix_subtract(linear, second),
        matrix_subtract(linear, matrix_multiply(turning, inertia.linear_angular)),
        matrix_scale(-1.0, matrix_multiply(turning, inertia.linear)),
    )


def twist_body_to_world(pose: DualQuaternion, twist_body: Spatial) -> Spatial:
    """Return chi_W = p chi_B p`, whose linear part is l-dot - omega_W x l."""
    return adjoint(pose, twist_body)


def twist_world_to_body(pose: DualQuaternion, twist_world: Spatial) -> Spatial:
    """Return chi_B = p` chi_W p, whose linear part is R^T l-dot."""
    return adjoint_inverse(pose, twist_world)


def wrench_body_to_world(pose: DualQuaternion, wrench_body: Spatial) -> Spatial:
    """Return a wrench with its moment about the world's origin, from one about the body's; momenta alike."""
    return coadjoint_inverse(pose, wrench_body)


def wrench_world_to_body(pose: DualQuaternion, wrench_world: Spatial) -> Spatial:
    """Return a wrench with its moment about the body's origin, from one about the world's; momenta alike."""
    return coadjoint(pose, wrench_world)


def twist_world_from_origin_velocity(pose: DualQuaternion, velocity: Spatial) -> Spatial:
    """Return chi_W = [omega_W; l-dot - omega_W x l] of [omega_W; l-dot], l-dot the velocity of the body's origin.

    The paper prints l-dot for the linear part of chi_W; they agree only where omega_W is parallel to l.
    """
    shift = cross(velocity.angular, pose_position(pose))
    return Spatial(velocity.angular, subtract(velocity.linear, shift))


def origin_velocity_from_twist_world(pose: DualQuaternion, twist_world: Spatial) -> Spatial:
    """Return [omega_W; l-dot] of chi_W, l-dot the velocity of the body's origin in world axes [m/s]."""
    shift = cross(twist_world.angular, pose_position(pose))
    return Spatial(twist_world.angular, add(twist_world.linear, shift))


def twist_body_from_pose_rate(pose: DualQuaternion, rate: DualQuaternion) -> Spatial:
    """Return chi_B = 2 p` p-dot = [omega; v] in the body frame.

    Kinetic energy is (1/2) chi_B . M chi_B with this chi_B; the paper prints p for p` there.
    """
    return spatial_from_dual(dual_scale(2.0, dual_multiply(dual_conjugate(pose), rate)))


def twist_world_from_pose_rate(pose: DualQuaternion, rate: DualQuaternion) -> Spatial:
    """Return chi_W = 2 p-dot p`."""
    return spatial_from_dual(dual_scale(2.0, dual_multiply(rate, dual_conjugate(pose))))


def pose_rate_from_twist_body(pose: DualQuaternion, twist_body: Spatial) -> DualQuaternion:
    """Return p-dot = (1/2) p chi_B."""
    return dual_scale(0.5, dual_multiply(pose, dual_from_spatial(twist_body)))


def pose_rate_from_twist_world(pose: DualQuaternion, twist_world: Spatial) -> DualQuaternion:
    """Return p-dot = (1/2) chi_W p."""
    return dual_scale(0.5, dual_multiply(dual_from_spatial(twist_world), pose))


def generalised_force_from_wrench_world(pose: DualQuaternion, wrench_world: Spatial) -> DualQuaternion:
    """Return the force F on the eight components of p, F* = 2 tau_W* p, * the transpose of `dual_transpose`.

    Its power is that of the wrench, F . p-dot = tau_W . chi_W. The paper prints p` for p here.
    """
    swapped = dual_transpose(dual_from_spatial(wrench_world))
    return dual_transpose(dual_scale(2.0, dual_multiply(swapped, pose)))


def generalised_force_from_wrench_body(pose: DualQuaternion, wrench_body: Spatial) -> DualQuaternion:
    """Return the force F on the eight components of p, F* = 2 p tau_B*; F . p-dot = tau_B . chi_B."""
    swapped = dual_transpose(dual_from_spatial(wrench_body))
    return dual_transpose(dual_scale(2.0, dual_multiply(pose, swapped)))


def wrench_world_from_generalised_force(pose: DualQuaternion, force: DualQuaternion) -> Spatial:
    """Return tau_W of a force F on the components of p, 2 tau_W* = F* p`; the paper prints p for p`.

    F may be the gradient of a function of the eight components: the part of it that does no work on unit dual
    quaternions ends in the scalar parts, which are dropped.
    """
    product = dual_multiply(dual_transpose(force), dual_conjugate(pose))
    return spatial_from_dual(dual_transpose(dual_scale(0.5, product)))


def wrench_body_from_generalised_force(pose: DualQuaternion, force: DualQuaternion) -> Spatial:
    """Return tau_B of a force F on the components of p, 2 tau_B* = p` F*; F may be a gradient, as above."""
    product = dual_multiply(dual_conjugate(pose), dual_transpose(force))
    return spatial_from_dual(dual_transpose(dual_scale(0.5, product)))
