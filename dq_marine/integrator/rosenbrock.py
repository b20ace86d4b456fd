"""The kick of fourth order: Rosenbrock's method for the damped momentum at frozen pose, L-stable.

At frozen pose M chi' = g(chi) = F - D(chi) chi. With S the derivative of D(chi) chi at the start, every stage solves
the same linear system,

    (M + gamma h S) U_i = gamma (h g(chi_0 + sum_j A_ij U_j) + M sum_j C_ij U_j)                        (R1)
    M chi_1 = M chi_0 + M sum_i B_i U_i                                                                 (R2)

with the coefficients of the L-stable ROS4 (Hairer & Wanner 1996, Solving Ordinary Differential Equations II, sec. IV.7,
table 7.2). The fixed point is the exact terminal velocity. Its error has no term of h^4, as extrapolation of the whole
step wants it (see `integrator.richardson`).

A body that gathers speed, within one kick, at which quadratic damping is far stiffer than at its start, is beyond what
S knows; the kick of `integrator.kick` takes its place there.
"""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.algebra.selection import select, some
from dq_marine.algebra.spatial import (
    Spatial,
    matrix6_invert,
    matrix6_transform,
    spatial_add,
    spatial_add_scaled,
    spatial_scale,
    spatial_subtract,
)
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.inertia import Inertia, momentum_from_twist, twist_from_momentum
from dq_marine.integrator.kick import Kick, QuadraticKick, make_quadratic_kick

LARGEST_GROWTH = 0.25  # of damping within a kick, over the diagonal of M

GAMMA = 0.57282
A21 = 2.0
A31, A32 = 1.867943637803922, 0.2344449711399156
C21 = -7.137615036412310
C31, C32 = 2.580708087951457, 0.6515950076447975
C41, C42, C43 = -2.137148994382534, -0.3214669691237626, -0.6949742501781779
B1, B2, B3, B4 = 2.255570073418735, 0.2870493262186792, 0.4353179431840180, 1.093502252409163


def combined(s: float, a: Spatial, r: float, b: Spatial) -> Spatial:
    """Return s a + r b."""
    return spatial_add_scaled(spatial_scale(s, a), r, b)


def stiffens(inertia: Inertia, growth: Spatial) -> bool:
    """Whether gamma h times damping, of which this is the `growth`, grows by more than a part of the diagonal of M."""
    turning, moving = growth
    m, n = inertia.matrix.angular, inertia.matrix.linear
    return (
        (turning[0] > LARGEST_GROWTH * m[0])
        | (turning[1] > LARGEST_GROWTH * m[4])
        | (turning[2] > LARGEST_GROWTH * m[8])
        | (moving[0] > LARGEST_GROWTH * n[0])
        | (moving[1] > LARGEST_GROWTH * n[4])
        | (moving[2] > LARGEST_GROWTH * n[8])
    )


@functools.cache
def make_rosenbrock_kick(algebra: DampingAlgebra) -> Kick:
    """Return the kick (R1)-(R2) for one kind of damping matrix."""
    damping_at, damping_slope, damping_growth = algebra.at, algebra.slope, algebra.growth
    damping_apply, damping_add_slope = algebra.apply, algebra.add_slope

    def excess_at(damping: Any, twist: Spatial, wrench: Spatial) -> Spatial:
        """Return g(chi)."""
        return spatial_subtract(wrench, damping_apply(damping_at(damping, twist), twist))

    robust_kick = make_quadratic_kick(algebra)

    def rosenbrock_kick(
        kick: QuadraticKick, damping: Any, inertia: Inertia, momentum: Spatial, wrench: Spatial
    ) -> Spatial:
        h = kick.duration
        start = twist_from_momentum(inertia, momentum)
        system = matrix6_invert(damping_add_slope(inertia.matrix, GAMMA * h, damping_slope(damping, start)))
        push = spatial_scale(GAMMA * h, excess_at(damping, start, wrench))
        u1 = matrix6_transform(system, push)

        twist = spatial_add_scaled(start, A21, u1)
        rough = stiffens(inertia, damping_growth(damping, GAMMA * h, start, twist))
        carried = momentum_from_twist(inertia, spatial_scale(GAMMA * C21, u1))
        push = spatial_scale(GAMMA * h, excess_at(damping, twist, wrench))
        u2 = matrix6_transform(system, spatial_add(push, carried))

        twist = spatial_add_scaled(spatial_add_scaled(start, A31, u1), A32, u2)
        push = spatial_scale(GAMMA * h, excess_at(damping, twist, wrench))
        carried = momentum_from_twist(inertia, combined(GAMMA * C31, u1, GAMMA * C32, u2))
        u3 = matrix6_transform(system, spatial_add(push, carried))

        carried = momentum_from_twist(
            inertia, spatial_add_scaled(combined(GAMMA * C41, u1, GAMMA * C42, u2), GAMMA * C43, u3)
        )
        u4 = matrix6_transform(system, spatial_add(push, carried))

        change = spatial_add(combined(B1, u1, B2, u2), combined(B3, u3, B4, u4))
        arrived = spatial_add(momentum, momentum_from_twist(inertia, change))  # (R2)
        if some(rough):
            arrived = select(rough, robust_kick(kick, damping, inertia, momentum, wrench), arrived)
        return arrived

    return rosenbrock_kick
