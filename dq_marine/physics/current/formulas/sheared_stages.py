"""Water that varies with depth, for methods with stages: relative to the water at the depth where a step begins.

With d = u(z) - u(z0) the difference to the water at that depth, and k = [0; R^T d] the same as a twist, the momentum is
taken relative to the water at z0, which moves uniformly (docs/theory.md, "Current"):

    y = mu + M k                                                                                      (S3)
    chi_0 = M^-1 y,   chi = chi_0 - k                                                                 (S4)
    y' = ad*_chi_0 y + F(p, chi, t) + Q                                                               (S5)
    Q = -ad*_chi_0 (M k) - [b x R^T d; 0] - M [0; omega x R^T d],   b the linear part of M chi        (S6)

Seen from the frame that drifts with u(z0), the pose moves with the twist chi_0. To the method this is therefore a
uniform current and one force more. It has no slope of u: at a corner of the profile the rates of y are continuous. At
the step's start y is mu, and at its end mu follows from (S3).
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_translate
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.matrix3 import transform
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_subtract
from dq_marine.algebra.vector3 import Vector3, add, cross, scale, subtract
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.inertia import Inertia, momentum_from_twist
from dq_marine.integrator.staged import StageForces, Step
from dq_marine.integrator.step import StepParameters, in_water
from dq_marine.integrator.water import WaterAtStages

Velocity: TypeAlias = Callable[[Any, DualQuaternion], Vector3]
"""(the water's parameters, pose) -> the water's velocity in NED [m/s] where the body is."""


class FromDepth(NamedTuple):
    """Water that varies with depth, and its velocity in NED [m/s] at the depth where a step begins."""

    current: Any
    velocity: Vector3


def carry_from_depth(water: FromDepth, time: float, elapsed: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose displaced by the way of the water at the depth where the step begins."""
    return pose_translate(pose, scale(elapsed, water.velocity))


def translation_momentum(inertia: Inertia, velocity: Vector3) -> Spatial:
    """Return M [0; v]."""
    matrix = inertia.matrix
    return Spatial(transform(matrix.angular_linear, velocity), transform(matrix.linear, velocity))


def slip(inertia: Inertia, pose: DualQuaternion, momentum: Spatial, change: Vector3) -> Spatial:
    """Return the momentum relative to water whose velocity in NED is another by `change`, the body's being the same."""
    return spatial_add_scaled(
        momentum, -1.0, translation_momentum(inertia, rotate_inverse(pose.real, change))
    )


def shear_force(inertia: Inertia, twist: Spatial, relative: Spatial, difference: Vector3) -> Spatial:
    """Return (S6), from chi_0, chi and R^T d."""
    linear = momentum_from_twist(inertia, relative).linear
    turning = translation_momentum(inertia, cross(twist.angular, difference))
    carried = momentum_bracket(twist, translation_momentum(inertia, difference))
    return Spatial(
        scale(-1.0, add(add(carried.angular, cross(linear, difference)), turning.angular)),
        scale(-1.0, add(carried.linear, turning.linear)),
    )


def make_sheared_stages(velocity: Velocity) -> WaterAtStages:
    """Return what water that varies with depth does to methods with stages."""

    @functools.cache
    def in_shear(forces: StageForces) -> StageForces:
        def forces_in_shear(
            parameters: StepParameters, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
        ) -> Spatial:
            water = parameters.water
            change = subtract(velocity(water.current, pose), water.velocity)
            difference = rotate_inverse(pose.real, change)
            relative = spatial_subtract(twist, Spatial((0.0, 0.0, 0.0), difference))  # (S4)
            acting = forces(parameters, pose, relative, time, wrench)
            return spatial_add(acting, shear_force(parameters.inertia, twist, relative, difference))  # (S5)

        return forces_in_shear

    def from_start(step: Step) -> Step:
        def step_from_start(
            parameters: StepParameters,
            time: float,
            h: float,
            pose: DualQuaternion,
            momentum: Spatial,
            wrench: Spatial,
        ) -> tuple[DualQuaternion, Spatial, DriftReport]:
            start = velocity(parameters.water, pose)
            there = in_water(parameters, FromDepth(parameters.water, start))
            moved, relative_to_start, report = step(there, time, h, pose, momentum, wrench)
            change = subtract(velocity(parameters.water, moved), start)
            return moved, slip(parameters.inertia, moved, relative_to_start, change), report  # (S3)

        return step_from_start

    return WaterAtStages(carry_from_depth, in_shear, from_start)
