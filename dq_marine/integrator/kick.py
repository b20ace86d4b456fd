"""The change of momentum at frozen pose: all forces act together, damping implicitly.

With the wrench F of everything but damping held over the kick's duration h, and the damping matrix D frozen
at a predicted mid velocity chi_m,

    (M + (h/2) D(chi)) chi_m = mu + (h/2) F                                                          (K1)
    r = F - D chi                                                                                    (K2)
    (M + h D + (h^2/2) D M^-1 D) dchi = h r + (h^2/2) D M^-1 r,   D = D(chi_m)                       (K3)

which is the Pade (0,2) approximation of the exponential: second order, L-stable, and with the exact terminal
velocity F = D(chi) chi as its fixed point. Where D is constant, the kick is mu' = P mu + Q F with P = exp(-h D M^-1)
and its integral Q prepared once: exact. Where there is none, it is mu' = mu + h F.

The implicit-node kick is the alternative of the trapezoidal Lagrange-d'Alembert principle: all forces at the node's own
velocity,

    M chi_k + (h/2) D(chi_k) chi_k = mu_k- + (h/2) F,     mu_k+ = M chi_k + (h/2) (F - D(chi_k) chi_k)   (K4)

so the kick that closes a step is implicit and the one that opens the next explicit: the whole step stays symmetric. It
is A-stable only, and rings where damping is stiff.

Every kick has the signature (kick, damping, inertia, momentum, wrench) -> momentum: what depends on its duration, what
does not, M, mu and F.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.selection import by_precision, select, some, spread
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_scaled,
    matrix6_solve,
    matrix6_transform,
    spatial_add,
    spatial_add_scaled,
    spatial_dot,
    spatial_scale,
    spatial_subtract,
)
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.inertia import Inertia, momentum_from_twist, twist_from_momentum

MAX_NODE_ITERATIONS = 30
NODE_TOLERANCE = 1e-28  # of the squared velocity: a change at round-off
NODE_TOLERANCE_SINGLE = 1e-12  # the same in single precision

Kick: TypeAlias = Callable[[Any, Any, Inertia, Spatial, Spatial], Spatial]


class UndampedKick(NamedTuple):
    """A kick without damping, of `duration` [s]."""

    duration: float


class LinearKick(NamedTuple):
    """A kick with a constant damping matrix, prepared for one duration: mu' = P mu + Q F."""

    propagator: Matrix6
    forcing: Matrix6


class QuadraticKick(NamedTuple):
    """A kick of `duration` [s] with damping that grows with the velocity."""

    duration: float


class NodeKick(NamedTuple):
    """A kick (K4): implicit over one duration [s], then explicit over another; 0 leaves a part out."""

    implicit_duration: float
    explicit_duration: float


def undamped_kick(
    kick: UndampedKick, damping: Any, inertia: Inertia, momentum: Spatial, wrench: Spatial
) -> Spatial:
    """Return mu + h F."""
    return spatial_add_scaled(momentum, kick.duration, wrench)


def linear_kick(
    kick: LinearKick, damping: Any, inertia: Inertia, momentum: Spatial, wrench: Spatial
) -> Spatial:
    """Return P mu + Q F."""
    return spatial_add(matrix6_transform(kick.propagator, momentum), matrix6_transform(kick.forcing, wrench))


@functools.cache
def make_quadratic_kick(algebra: DampingAlgebra) -> Kick:
    """Return the kick (K1)-(K3) for one kind of damping matrix."""
    damping_at, damping_apply = algebra.at, algebra.apply
    damping_add_scaled, damping_sandwich = algebra.add_scaled, algebra.sandwich

    def quadratic_kick(
        kick: QuadraticKick, damping: Any, inertia: Inertia, momentum: Spatial, wrench: Spatial
    ) -> Spatial:
        h = kick.duration
        twist = twist_from_momentum(inertia, momentum)
        middle = matrix6_solve(  # (K1)
            damping_add_scaled(inertia.matrix, 0.5 * h, damping_at(damping, twist)),
            spatial_add_scaled(momentum, 0.5 * h, wrench),
        )
        d = damping_at(damping, middle)
        excess = spatial_subtract(wrench, damping_apply(d, twist))  # (K2)
        slowed = damping_apply(d, twist_from_momentum(inertia, excess))
        change = matrix6_solve(  # (K3)
            damping_add_scaled(
                matrix6_add_scaled(inertia.matrix, 0.5 * h * h, damping_sandwich(d, inertia.inverse)),
                h,
                d,
            ),
            spatial_scale(h, spatial_add_scaled(excess, 0.5 * h, slowed)),
        )
        return momentum_from_twist(inertia, spatial_add(twist, change))

    return quadratic_kick


@functools.cache
def make_node_kick(algebra: DampingAlgebra) -> Kick:
    """Return the kick (K4) for one kind of damping matrix; its implicit part is solved by Newton's method."""
    damping_at, damping_slope = algebra.at, algebra.slope
    damping_apply, damping_add_slope = algebra.apply, algebra.add_slope

    def node_kick(
        kick: NodeKick, damping: Any, inertia: Inertia, momentum: Spatial, wrench: Spatial
    ) -> Spatial:
        h = kick.implicit_duration
        target = spatial_add_scaled(momentum, h, wrench)
        twist = twist_from_momentum(inertia, momentum)
        active = spread(True, momentum.linear[0])
        tolerance = by_precision(momentum.linear[0], NODE_TOLERANCE, NODE_TOLERANCE_SINGLE)
        for _ in range(MAX_NODE_ITERATIONS):
            drag = damping_apply(damping_at(damping, twist), twist)
            held = spatial_add_scaled(momentum_from_twist(inertia, twist), h, drag)
            slope = damping_add_slope(inertia.matrix, h, damping_slope(damping, twist))
            change = matrix6_solve(slope, spatial_subtract(target, held))
            twist = select(active, spatial_add(twist, change), twist)
            active = active & (spatial_dot(change, change) > tolerance * spatial_dot(twist, twist))
            if not some(active):
                break
        drag = damping_apply(damping_at(damping, twist), twist)
        excess = spatial_subtract(wrench, drag)
        return spatial_add_scaled(momentum_from_twist(inertia, twist), kick.explicit_duration, excess)

    return node_kick
