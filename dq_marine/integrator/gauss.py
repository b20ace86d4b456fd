"""Gauss's collocation for whole scenes: order 6 or 8 for smooth forces, exact in the momentum that they leave alone.

Steps are taken in `runs`: those of free motion by `gauss_drift`, or for order 6 by `gauss_successive`, those with
forces at the stages by `gauss_forced`. Gauss's collocation on the momentum keeps energy, momentum and Casimirs of free
bodies. It is not variational.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.gauss_drift import FreeSteps, make_gauss_steps
from dq_marine.integrator.gauss_forced import make_forced_steps
from dq_marine.integrator.gauss_successive import SUCCESSIVE, successive_steps
from dq_marine.integrator.runs import make_method_in_runs
from dq_marine.integrator.step import Advance, Composition


def make_free_steps(stages: int) -> FreeSteps:
    """Return (inertia, h, steps, pose, momentum) -> (pose, momentum, report): steps of free motion."""
    return successive_steps if stages == SUCCESSIVE else make_gauss_steps(stages)


@functools.cache
def make_gauss_method(stages: int) -> Callable[[Composition], Advance]:
    """Return the method of order 2 x stages: (composition) -> advance."""

    def make_gauss(composition: Composition) -> Advance:
        forced = make_forced_steps(composition, gauss(stages))
        return make_method_in_runs(composition, make_free_steps(stages), forced)

    return make_gauss
