"""Free motion by explicit Runge-Kutta methods: exact in momentum, and in energy to the method's order."""

from __future__ import annotations

import functools
import math

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import smallest_normal, spread
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_scale
from dq_marine.algebra.vector3 import cross, dot
from dq_marine.integrator.drift_report import LARGEST_ENERGY_CHANGE, DriftReport, nothing_solved
from dq_marine.integrator.explicit import Explicit, foresee_nothing
from dq_marine.integrator.forced_stages import Place, travelling, turning
from dq_marine.integrator.gauss_drift import FreeSteps, moved_by
from dq_marine.integrator.gauss_forced import motion
from dq_marine.integrator.gauss_stages import squared_length
from dq_marine.integrator.increment import AT_ONCE, carried, consistent, unit
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

LEAST_ARM = 0.1
"""Of the linear momentum's weight in (G6), over Gauss's."""

STEEPNESS = 10.0
"""With which the arm grows with the share that translation has in what turns the body."""


def find(inertia: Inertia, node: float, place: Place) -> Place:
    """Return the rates of momentum (G2), attitude and way (G8) at a place, at any time."""
    twist = twist_from_momentum(inertia, place.momentum)
    rate = momentum_bracket(twist, place.momentum)
    return Place(rate, turning(place.attitude, twist), travelling(place.attitude, twist))


def arm(inertia: Inertia, momentum: Spatial) -> float:
    """Return the weight of the linear momentum in (G6), over Gauss's.

    An explicit method keeps neither the linear momentum's size nor its product with the angular momentum. Linear
    momentum turns with the body and errs most. Where it hardly turns the body itself, by Munk's moment b x v, its
    errors are not to spread to the angular momentum, on which rotation depends then.
    """
    twist = twist_from_momentum(inertia, momentum)
    munk, spin = cross(momentum.linear, twist.linear), cross(momentum.angular, twist.angular)
    by_way, by_spin = dot(munk, munk), dot(spin, spin)
    share = math.sqrt(by_way / (by_way + by_spin + smallest_normal(by_way)))
    return min(1.0, max(LEAST_ARM, STEEPNESS * share))


@functools.cache
def make_free_steps(method: Explicit) -> FreeSteps:
    """Return (inertia, h, steps, pose, momentum) -> (pose, momentum, report): steps of free motion.

    Pose and momentum are made consistent at the end (G6). The report says whether the energy is kept, but for what as
    many drifts may change.
    """
    take_step = method.make_step(foresee_nothing, find)

    def free_steps(
        inertia: Inertia, h: float, steps: int, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        start = spatial_scale(h, momentum)
        at_once = spread(AT_ONCE, start.linear[0])
        begun = Place(start, at_once.rotation, at_once.shift)
        here = begun
        for _ in range(steps):
            reached = take_step(inertia, 1.0, here).reached
            here = Place(reached.momentum, unit(reached.attitude), reached.way)
        length = arm(inertia, here.momentum) * math.sqrt(squared_length(inertia))
        moved = consistent(length, motion(begun, here), start, here.momentum)
        # Steps that are far too long leave a momentum that no pose carries to: that handed on has an energy of its own.
        had, has = quadratic_form(inertia.inverse, start), quadratic_form(inertia.inverse, here.momentum)
        hands_on = quadratic_form(inertia.inverse, carried(moved, start))
        most = steps * LARGEST_ENERGY_CHANGE * had
        kept = (abs(has - had) <= most) & (abs(hands_on - had) <= most)
        return moved_by(moved, pose, momentum, DriftReport(nothing_solved(had), kept))

    return free_steps
