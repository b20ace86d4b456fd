"""Contact with what is solid: forces that push a hull out of it and hold it by friction, taken in implicitly.

A hull touches by spheres, a surface by its signed distance. At frozen pose, and one sphere after the other, the push f
along the surface's normal is that of a spring and a damper, where the place will be after the time h,

    f = max(0, k (d - h v) - c v),   v = velocity of the place along the normal after the push,

with the depth d. Velocities follow impulses p by J M^-1 J^T p, M with all its coupling, so that this is linear in p:
there is nothing to iterate, and it is stable whatever k, c and h. A push gives no more energy than the spring held
(k d^2/4 of k d^2/2), and the stiffest spring stops the place and no more. With the push goes the impulse that stops the
place along the surface, if that is within Coulomb's cone; if not, the place slides, against friction. So what stays
within the cone stays where it is. The spheres are visited forth and back several times, with a share of the time each,
so that none of them comes first.

Sequential impulses are Catto's (2005, Iterative Dynamics with Temporal Coherence, Game Developers Conference); on
implicit springs in contact see Todorov (2014, Convex and analytically-invertible dynamics with contacts and
constraints, IEEE ICRA).
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.level import level_length
from dq_marine.algebra.matrix3 import Matrix3, adjugate, determinant, transform
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.quaternion import Quaternion, rotate, rotate_inverse
from dq_marine.algebra.selection import by_precision, select, smallest_normal, some, spread
from dq_marine.algebra.spatial import (
    Spatial,
    matrix6_transform,
    spatial_add,
    spatial_add_scaled,
    spatial_dot,
    wrench_at,
)
from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, norm, scale
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

SWEEPS = 3
"""Over all spheres, forth and back each. What friction holds against a steady push creeps by less than 1 mm/s; the more
sweeps, the slower."""

Distance: TypeAlias = Callable[[Any, Vector3], float]
"""(numbers of a solid, point in NED) -> signed distance [m], negative inside."""

WaterTwist: TypeAlias = Callable[[Any, DualQuaternion], Spatial]

Touch: TypeAlias = Callable[[Any, Any, Inertia, float, DualQuaternion, Spatial], Spatial]
"""(parameters, water's parameters, inertia, h, pose, momentum) -> momentum after the contacts of a time h."""

Contact: TypeAlias = Callable[[WaterTwist], Touch]
"""(the water's twist at a pose) -> touch. Contacts are over ground, momentum is relative to the water."""


class HullSpheres(NamedTuple):
    """Spheres by which a hull touches: places of their centres in the body frame, and radii [m].

    None of them reaches farther from the body origin than `reach` [m].
    """

    x: Table
    y: Table
    z: Table
    radius: Table
    reach: float


class Surface(NamedTuple):
    """A solid, and how its surface pushes back.

    Attributes:
        solid: numbers of its distance function.
        stiffness: k, of each sphere [N/m].
        damping: c, of each sphere [N s/m].
        friction: coefficient of Coulomb's friction.
        deepest: depth from which on the spring pushes no harder [m].
    """

    solid: Any
    stiffness: float
    damping: float
    friction: float
    deepest: float


class ContactParameters(NamedTuple):
    """The hull, and the surfaces, nested in pairs (first, (second, (..., ())))."""

    spheres: HullSpheres
    surfaces: Any


class Touching(NamedTuple):
    """A place of contact.

    Attributes:
        place: of the hull, in the body frame [m].
        outward: normal of the surface there, in the body frame.
        depth: of the sphere in the solid, more than 0 [m].
    """

    place: Vector3
    outward: Vector3
    depth: float


class FrozenBody(NamedTuple):
    """A body while contact acts on it.

    Attributes:
        inertia: its M.
        pose: body to NED, which does not change meanwhile.
        flow: the water's twist at the pose, in the body frame.
        h: how long contact acts [s].
    """

    inertia: Inertia
    pose: DualQuaternion
    flow: Spatial
    h: float


@functools.cache
def make_contact(distances: tuple[Distance, ...]) -> Contact:
    """Return the contact with solids that are given by their signed distances."""

    def contact(water_twist: WaterTwist) -> Touch:
        touch_all = folded(_link, [make_touch_of(distance) for distance in distances], _nothing_left)

        def touch(
            parameters: ContactParameters,
            water: Any,
            inertia: Inertia,
            h: float,
            pose: DualQuaternion,
            momentum: Spatial,
        ) -> Spatial:
            body = FrozenBody(inertia, pose, water_twist(water, pose), h)
            return touch_all(parameters.surfaces, parameters.spheres, body, momentum)

        return touch

    return contact


def _nothing_left(surfaces: Any, spheres: HullSpheres, body: FrozenBody, momentum: Spatial) -> Spatial:
    return momentum


def _link(first: Callable[..., Spatial], rest: Callable[..., Spatial]) -> Callable[..., Spatial]:
    def touch_surfaces(surfaces: Any, spheres: HullSpheres, body: FrozenBody, momentum: Spatial) -> Spatial:
        return rest(surfaces[1], spheres, body, first(surfaces[0], spheres, body, momentum))

    return touch_surfaces


@functools.cache
def make_touch_of(
    distance: Distance,
) -> Callable[[Surface, HullSpheres, FrozenBody, Spatial], Spatial]:
    """Return (surface, spheres, body, momentum) -> momentum after contact with one solid."""

    def normal_at(solid: Any, point: Vector3) -> Vector3:
        """Return where the distance grows fastest, a unit vector: by central differences, as it may be sampled."""
        step = by_precision(point[0], 1e-4, 1e-2)
        gradient = (
            distance(solid, add(point, (step, 0.0, 0.0))) - distance(solid, add(point, (-step, 0.0, 0.0))),
            distance(solid, add(point, (0.0, step, 0.0))) - distance(solid, add(point, (0.0, -step, 0.0))),
            distance(solid, add(point, (0.0, 0.0, step))) - distance(solid, add(point, (0.0, 0.0, -step))),
        )
        return scale(1.0 / max(norm(gradient), smallest_normal(point[0])), gradient)

    def touch(surface: Surface, spheres: HullSpheres, body: FrozenBody, momentum: Spatial) -> Spatial:
        # A distance changes by no more than the point moves: away from the solid, one of them tells of all spheres.
        if some(distance(surface.solid, pose_position(body.pose)) < spheres.reach):
            momentum = sweep(surface, spheres, body, momentum)
        return momentum

    def sweep(surface: Surface, spheres: HullSpheres, body: FrozenBody, momentum: Spatial) -> Spatial:
        attitude: Quaternion = body.pose.real
        position, count = pose_position(body.pose), len(spheres.x)
        share = body.h / (2 * SWEEPS)
        for visit in range(2 * SWEEPS * count):
            sweep_number, passed = visit // count, visit % count
            number = passed if sweep_number % 2 == 0 else count - 1 - passed
            center = (spheres.x[number], spheres.y[number], spheres.z[number])
            radius = spheres.radius[number]
            point = add(position, rotate(attitude, center))
            depth = radius - distance(surface.solid, point)
            if some(depth > 0.0):
                outward = rotate_inverse(attitude, normal_at(surface.solid, point))
                where = Touching(add_scaled(center, -radius, outward), outward, depth)
                pushed = push_back(surface, body, share, where, momentum)
                momentum = select(depth > 0.0, pushed, momentum)
        return momentum

    return touch


def push_back(
    surface: Surface, body: FrozenBody, share: float, touch: Touching, momentum: Spatial
) -> Spatial:
    """Return the momentum after contact at one place of the hull, during a share of its time [s].

    The spring looks ahead to the end of the whole time.
    """
    along, side, across = contact_wrenches(touch)
    twist = spatial_add(twist_from_momentum(body.inertia, momentum), body.flow)
    velocity = (spatial_dot(along, twist), spatial_dot(side, twist), spatial_dot(across, twist))
    yields = _mobility(body.inertia, along, side, across)
    # Its push is share (k d - (c + h k) v), with v of the place along the normal after it.
    spring = share * surface.stiffness * min(touch.depth, surface.deepest)
    resistance = share * (surface.damping + body.h * surface.stiffness)
    held = _held(yields, velocity, spring, resistance)
    holds = (held[0] > 0.0) & (level_length((held[1], held[2])) <= surface.friction * held[0])
    push = select(holds, held, _sliding(yields, velocity, spring, resistance, surface.friction))
    pushed = spatial_add_scaled(momentum, push[0], along)
    return spatial_add_scaled(spatial_add_scaled(pushed, push[1], side), push[2], across)


def contact_wrenches(touch: Touching) -> tuple[Spatial, Spatial, Spatial]:
    """Return unit forces at a place of contact: along the surface's normal, and two along the surface.

    The two complete the normal n to an orthonormal basis, without a branch: Duff et al. 2017, Building an Orthonormal
    Basis, Revisited, Journal of Computer Graphics Techniques 6(1).
    """
    x, y, z = touch.outward
    sign = select(z < 0.0, -1.0, spread(1.0, z))
    a = -1.0 / (sign + z)
    b = x * y * a
    side, across = (1.0 + sign * x * x * a, sign * b, -sign * x), (b, sign + y * y * a, -y)
    return wrench_at(touch.place, touch.outward), wrench_at(touch.place, side), wrench_at(touch.place, across)


def _mobility(inertia: Inertia, a: Spatial, b: Spatial, c: Spatial) -> Matrix3:
    """Return J M^-1 J^T: which velocities of the place impulses along three wrenches make."""
    by_b, by_c = matrix6_transform(inertia.inverse, b), matrix6_transform(inertia.inverse, c)
    aa = spatial_dot(a, matrix6_transform(inertia.inverse, a))
    ab, ac = spatial_dot(a, by_b), spatial_dot(a, by_c)
    bb, bc, cc = spatial_dot(b, by_b), spatial_dot(b, by_c), spatial_dot(c, by_c)
    return (aa, ab, ac, ab, bb, bc, ac, bc, cc)


def _held(yields: Matrix3, velocity: Vector3, spring: float, resistance: float) -> Vector3:
    """Return the impulse with which a place stops along the surface, under the push that then follows."""
    pushing, side, across = yields[:3], yields[3:6], yields[6:]
    system = (1.0 + resistance * pushing[0], resistance * pushing[1], resistance * pushing[2], *side, *across)
    wanted = (spring - resistance * velocity[0], -velocity[1], -velocity[2])
    size = determinant(system)
    return scale(1.0 / max(size, smallest_normal(size)), transform(adjugate(system), wanted))


def _sliding(
    yields: Matrix3, velocity: Vector3, spring: float, resistance: float, friction: float
) -> Vector3:
    """Return the impulse on a place that slides: a push, and friction against the velocity that it leaves."""
    push = max(0.0, spring - resistance * velocity[0]) / (1.0 + resistance * yields[0])
    along = (velocity[1] + push * yields[3], velocity[2] + push * yields[6])
    speed = level_length(along)
    to_unit = 1.0 / max(speed, smallest_normal(speed))
    one, other = to_unit * along[0], to_unit * along[1]
    slowed = one * one * yields[4] + 2.0 * one * other * yields[5] + other * other * yields[8]
    hold = min(speed / max(slowed, smallest_normal(speed)), friction * push)
    return (push, -hold * one, -hold * other)
