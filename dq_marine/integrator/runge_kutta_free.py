"""Free motion by explicit Runge-Kutta methods: exact in momentum, and in energy to the method's order."""

from __future__ import annotations

import functools
import math

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_scale
from dq_marine.integrator.drift_report import LARGEST_ENERGY_CHANGE, DriftReport, nothing_solved
from dq_marine.integrator.explicit import Explicit, foresee_nothing
from dq_marine.integrator.forced_stages import Place, travelling, turning
from dq_marine.integrator.gauss_drift import FreeSteps, moved_by
from dq_marine.integrator.gauss_forced import motion
from dq_marine.integrator.gauss_stages import squared_length
from dq_marine.integrator.increment import AT_ONCE, consistent, unit
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

ARM = 0.1
"""Of the linear momentum's weight in (G6), over Gauss's.

An explicit method keeps neither the linear momentum's size nor its product with the angular momentum. Linear momentum
turns with the body and errs most; with Gauss's weight its errors would spread to the angular momentum, on which
rotation depends.
"""


def find(inertia: Inertia, node: float, place: Place) -> Place:
    """Return the rates of momentum (G2), attitude and way (G8) at a place, at any time."""
    twist = twist_from_momentum(inertia, place.momentum)
    rate = momentum_bracket(twist, place.momentum)
    return Place(rate, turning(place.attitude, twist), travelling(place.attitude, twist))


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
        had, has = quadratic_form(inertia.inverse, start), quadratic_form(inertia.inverse, here.momentum)
        kept = abs(has - had) <= steps * LARGEST_ENERGY_CHANGE * had
        report = DriftReport(nothing_solved(had), kept)
        length = ARM * math.sqrt(squared_length(inertia))
        moved = consistent(length, motion(begun, here), start, here.momentum)
        return moved_by(moved, pose, momentum, report)

    return free_steps
