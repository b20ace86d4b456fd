"""Buoyancy of a hull made of boxes, at any depth and attitude.

A box is cut into columns along body z. With d the direction of down in the body frame, a column whose centre is at
the depth e = z + d . p, and which reaches r above and below it, holds water of the potential

    U = rho g V m(e, r),   m = mean of max(0, e + r s) over s in [-1, 1] = (e + r)^2/(4 r) where it crosses the surface,

V being its volume, m = e where it is under water and 0 where it is out. The wrench is the exact gradient of U, so
buoyancy takes and gives no energy on balance: through broaching, diving and capsizing. With the submerged fraction
f = dm/de = (e + r)/(2 r), between 0 and 1, dm/dr = f (1 - f).

The reach r = (1/2) sqrt((H d_z)^2 + c^2 ((a d_x)^2 + (b d_y)^2)) of a column of height H and cross-section a b has one
free number: c^2 = 1/(6 f (1 - f)) with the fraction f at rest gives each column the second moment a^3 b/12 of its
waterplane. Upright, the stiffness of a wall-sided hull is then exact with any number of columns. What the surface does
to inertia and damping is not in this force: a body out of the water keeps both.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, cross, dot, multiply_elementwise, scale
from dq_marine.integrator.forces import PoseForce


class Columns(NamedTuple):
    """The columns of one box.

    Attributes:
        corner: centre of the aftmost column to port [m], body frame.
        spacing: of the columns along x and y [m].
        reach_squares: (c a)^2, (c b)^2 and H^2 [m^2].
        weight: rho g V of one column [N].
    """

    corner: Vector3
    spacing: tuple[float, float]
    reach_squares: Vector3
    weight: float


class Reach(NamedTuple):
    """How far a column extends up and down from its centre: r [m], and dr/dd [m]."""

    length: float
    gradient: Vector3


def column_reach(columns: Columns, down: Vector3) -> Reach:
    """Return the columns' common reach."""
    gradient = multiply_elementwise(columns.reach_squares, down)
    length = 0.5 * math.sqrt(dot(gradient, down))
    return Reach(length, scale(0.25 / length, gradient))


@functools.cache
def make_box_buoyancy(along: int, across: int) -> PoseForce:
    """Return (columns, pose, time) -> wrench of a box of along x across columns."""

    def box_buoyancy(columns: Columns, pose: DualQuaternion, time: float) -> Spatial:
        down = world_down_in_body(pose.real)
        reach = column_reach(columns, down)
        per_reach = 0.5 / reach.length
        # The submerged fraction before it is limited, of the first column and its change from one to the next.
        first = 0.5 + per_reach * (pose_position(pose)[2] + dot(down, columns.corner))
        step_x = per_reach * columns.spacing[0] * down[0]
        step_y = per_reach * columns.spacing[1] * down[1]
        nothing = spread(0.0, first)
        total, by_x, by_y, crossing = nothing, nothing, nothing, nothing
        for i in range(along):
            row = nothing
            for j in range(across):
                fraction = max(0.0, min(1.0, first + i * step_x + j * step_y))
                row = row + fraction
                by_y = by_y + j * fraction
                crossing = crossing + fraction * (1.0 - fraction)
            total = total + row
            by_x = by_x + i * row
        # dU/dd = rho g V sum (f p + f (1 - f) dr/dd)
        corner, turn = columns.corner, reach.gradient
        gradient = (
            total * corner[0] + by_x * columns.spacing[0] + crossing * turn[0],
            total * corner[1] + by_y * columns.spacing[1] + crossing * turn[1],
            total * corner[2] + crossing * turn[2],
        )
        return Spatial(scale(columns.weight, cross(down, gradient)), scale(-(columns.weight * total), down))

    return box_buoyancy
