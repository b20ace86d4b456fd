"""Free motion by the explicit Runge-Kutta method of order 8: exact in momentum, and in energy to the method's order."""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_scale
from dq_marine.algebra.stages import weighted_sum
from dq_marine.integrator.dormand_prince import WEIGHTS, make_stages, rates
from dq_marine.integrator.drift_report import DriftReport, is_energy_kept, nothing_solved
from dq_marine.integrator.forced_stages import Place, follow, travelling, turning
from dq_marine.integrator.gauss_drift import moved_by
from dq_marine.integrator.gauss_forced import motion
from dq_marine.integrator.gauss_stages import squared_length
from dq_marine.integrator.increment import AT_ONCE, consistent, unit
from dq_marine.integrator.inertia import Inertia, twist_from_momentum


class FreeRates(NamedTuple):
    """How a free body moves in a step that lasts 1: the rates of momentum (G2), attitude and way (G8)."""

    rate: Place


def find(inertia: Inertia, share: float, place: Place) -> FreeRates:
    """Return the rates at a place, at any time."""
    twist = twist_from_momentum(inertia, place.momentum)
    rate = momentum_bracket(twist, place.momentum)
    return FreeRates(Place(rate, turning(place.attitude, twist), travelling(place.attitude, twist)))


stages_of = make_stages(find, follow)


def free_steps(
    inertia: Inertia, h: float, steps: int, pose: DualQuaternion, momentum: Spatial
) -> tuple[DualQuaternion, Spatial, DriftReport]:
    """Return pose, momentum and a report after steps of free motion; the two are made consistent at the end (G6).

    The report says whether the energy is kept, but for what a drift's may change.
    """
    start = spatial_scale(h, momentum)
    at_once = spread(AT_ONCE, start.linear[0])
    begun = Place(start, at_once.rotation, at_once.shift)
    here = begun
    for _ in range(steps):
        reached = follow(here, weighted_sum(WEIGHTS, rates(stages_of(inertia, here))))
        here = Place(reached.momentum, unit(reached.attitude), reached.way)
    had, has = quadratic_form(inertia.inverse, start), quadratic_form(inertia.inverse, here.momentum)
    report = DriftReport(nothing_solved(had), is_energy_kept(had, has))
    length = math.sqrt(squared_length(inertia))
    moved = consistent(length, motion(begun, here), start, here.momentum)
    return moved_by(moved, pose, momentum, report)
