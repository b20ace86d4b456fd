"""Steady horizontal current that varies with depth, on a body that is small against the scale on which it varies.

Water that moves horizontally and steadily does not accelerate, Du/Dt = 0, and neither does a body that it carries to
another depth: the velocity over ground stays and the velocity through the water changes by -R^T du (docs/theory.md,
"Current"). Before and after a drift over h the depth is taken to go on at its present rate w for h/2,

    before:  mu <- mu - M [0; R^T (u(z + (h/2) w) - u(z))]                                            (S1)
    after:   mu <- mu - M [0; R^T (u(z) - u(z - (h/2) w))]                                            (S2)

and the position gains (h/2) u(z). Both leave z and w as they are, and each undoes the other for -h: the step stays
symmetric. Differences, not slopes: what a body meets over many steps adds up to the difference of u between the first
depth and the last, and where the profile has a corner the step keeps its order.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position, pose_translate
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, scale, subtract
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.water import Placed, Water
from dq_marine.physics.current.formulas.sheared_stages import make_sheared_stages, slip
from dq_marine.physics.current.formulas.uniform import draw_current, stay

Change: TypeAlias = Callable[[Any, float], tuple[float, float]]


class Layer(NamedTuple):
    """Water between two depths [m], whose horizontal velocity changes by `north` and `east` [1/s] per metre."""

    top: float
    bottom: float
    north: float
    east: float


class ShearedCurrent(NamedTuple):
    """Velocity in NED [m/s] above the layers, and the layers, nested in pairs (first, (second, (..., ())))."""

    above: Vector3
    layers: Any


def same_profile(current: ShearedCurrent, velocity: Vector3) -> ShearedCurrent:
    """Return the parameters: a profile is the same in every episode."""
    return current


def no_change(layers: Any, depth: float) -> tuple[float, float]:
    """Return zero: there are no layers."""
    return (0.0, 0.0)


@functools.cache
def make_change(layers: int) -> Change:
    """Return (layers, depth) -> change of the velocity, north and east, from above the layers to a depth."""

    def link(_: int, rest: Change) -> Change:
        def change(nested: Any, depth: float) -> tuple[float, float]:
            layer, below = nested[0], rest(nested[1], depth)
            # The part of the layer above the depth, by magnitudes alone: depths may also be arrays.
            crossed = 0.5 * (layer.bottom - layer.top + abs(depth - layer.top) - abs(depth - layer.bottom))
            return (layer.north * crossed + below[0], layer.east * crossed + below[1])

        return change

    return folded(link, range(layers), no_change)


@functools.cache
def make_sheared_water(layers: int) -> Water:
    """Return what water with a profile of so many layers does."""
    change = make_change(layers)

    def at_depth(current: ShearedCurrent, depth: float) -> Vector3:
        north, east = change(current.layers, depth)
        return (current.above[0] + north, current.above[1] + east, current.above[2])

    def velocity(current: ShearedCurrent, pose: DualQuaternion) -> Vector3:
        return at_depth(current, pose_position(pose)[2])

    def twist(current: ShearedCurrent, pose: DualQuaternion) -> Spatial:
        return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, velocity(current, pose)))

    def depart(
        current: ShearedCurrent,
        inertia: Inertia,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
    ) -> Placed:
        depth = pose_position(pose)[2]
        here = at_depth(current, depth)
        there = at_depth(current, depth + 0.5 * h * sinking(inertia, pose, momentum))
        slipped = slip(inertia, pose, momentum, subtract(there, here))  # (S1)
        return Placed(pose_translate(pose, scale(0.5 * h, here)), slipped)

    def arrive(
        current: ShearedCurrent,
        inertia: Inertia,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
    ) -> Placed:
        depth = pose_position(pose)[2]
        here = at_depth(current, depth)
        there = at_depth(current, depth - 0.5 * h * sinking(inertia, pose, momentum))
        slipped = slip(inertia, pose, momentum, subtract(here, there))  # (S2)
        return Placed(pose_translate(pose, scale(0.5 * h, here)), slipped)

    stages = make_sheared_stages(velocity)
    return Water(draw_current, same_profile, depart, arrive, stages, velocity, twist, stay, 0)


def sinking(inertia: Inertia, pose: DualQuaternion, momentum: Spatial) -> float:
    """Return the rate of the depth [m/s]; the water itself moves horizontally."""
    return rotate(pose.real, twist_from_momentum(inertia, momentum).linear)[2]
