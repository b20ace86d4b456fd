"""The Galerkin variational integrators as a method: orders 4, 6 and 8 with any number of steps, forces and damping.

A step whose sweeps do not converge is left to the fallback: 2, 4 or 8 pieces of the same method, or else pieces by
Strang's method with the midpoint drift, whose kick is stable under any damping. Such steps are counted.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import some
from dq_marine.algebra.spatial import Spatial, spatial_dot
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.fallback import make_advance_with_fallback, usable
from dq_marine.integrator.galerkin_drift import make_galerkin_drift
from dq_marine.integrator.galerkin_forced import make_forced_step
from dq_marine.integrator.staged import Step
from dq_marine.integrator.step import (
    ACCEPTED,
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    make_advance,
)
from dq_marine.integrator.strang import StrangTiming

PIECES = 8
"""Of a step that the sweeps do not solve: at most, of the same method, and of Strang's."""


class PiecesTiming(NamedTuple):
    """Step size [s] of a step that is taken in pieces, and Strang's timing for one of `PIECES`."""

    h: float
    piece: StrangTiming


def make_step(composition: Composition, order: int) -> Step:
    """Return one step; where nothing acts on a body, it is that of free motion."""
    water = composition.water.at_stages
    carry = water.carry
    free_step = make_galerkin_drift(order // 2)
    forced_step = make_forced_step(gauss(order // 2), composition.stage_forces, carry)
    forceless = composition.forceless

    def step(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        if forceless and not some(spatial_dot(wrench, wrench) > 0.0):
            moved, carried, report = free_step(parameters.inertia, h, pose, momentum)
        else:
            moved, carried, report = forced_step(parameters, time, h, pose, momentum, wrench)
        return carry(parameters.water, time, h, moved), carried, report

    return water.step(step)


@functools.cache
def make_in_pieces(composition: Composition, order: int, strang: Composition) -> Advance:
    """Return (parameters, state, wrench, time, 1) -> one body's step in pieces: 2, 4, 8 of its own, or Strang's."""
    step, advance_strang = make_step(composition, order), make_advance(strang)

    def in_pieces(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        inertia, damping, forces, water, timing, contact = parameters
        pieces = 2
        while pieces <= PIECES:
            h, moved = timing.h / pieces, state
            worst, iterations, done, fine = 0.0, 0, 0, True
            while done < pieces and fine:
                start = time + done * h
                pose, momentum, report = step(parameters, start, h, moved.pose, moved.momentum, wrench)
                moved, fine = BodyState(pose, momentum, state.fluid_memory), usable(report)
                worst = max(worst, report.solver.relative_residual_squared)
                iterations += report.solver.iterations
                done += 1
            if fine:
                return StepOutcome(moved, ACCEPTED, 1, iterations, 1, worst)
            pieces *= 2
        timed = StepParameters(inertia, damping, forces, water, timing.piece, contact)
        return advance_strang(timed, state, wrench, time, PIECES)

    return in_pieces


@functools.cache
def make_galerkin(order: int) -> Callable[[Composition], Advance]:
    """Return the method of the given order: (composition) -> advance."""

    def galerkin(composition: Composition) -> Advance:
        return make_advance_with_fallback(make_step(composition, order), composition.fallback)

    return galerkin
