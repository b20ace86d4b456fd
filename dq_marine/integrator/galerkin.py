"""The Galerkin variational integrators as a method: orders 4, 6 and 8 with any number of steps, forces and damping.

A step whose sweeps do not converge is rescued: it is taken in 2, 4 or 8 pieces, or else in pieces by Strang's method
with the midpoint drift, whose kick is stable under any damping. It is counted as a fallback.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import negation, select, select_call, some
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_dot
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.damping import Drag
from dq_marine.integrator.drift_report import DriftReport, SolverReport, drift_accepted
from dq_marine.integrator.forces import join_pose_forces, join_velocity_forces
from dq_marine.integrator.galerkin_drift import make_galerkin_drift
from dq_marine.integrator.galerkin_forced import Wrench, make_forced_step
from dq_marine.integrator.step import (
    ACCEPTED,
    ENERGY_NOT_KEPT,
    WRONG_BRANCH,
    Advance,
    Composition,
    Flown,
    StepOutcome,
    StepParameters,
    arrival,
    progress_by_step,
    progress_with,
    set_out,
)
from dq_marine.integrator.strang import StrangTiming, make_strang

PIECES = 8
"""Of a step that is rescued, at most of its own, and of Strang's."""

Step: TypeAlias = Callable[
    [StepParameters, float, DualQuaternion, Spatial, float, Spatial],
    tuple[DualQuaternion, Spatial, DriftReport],
]
"""(parameters, h, pose, momentum, time, wrench) -> (pose, momentum, report)."""


class GalerkinTiming(NamedTuple):
    """Step size [s], damping as a force, and Strang's timing for a piece of a rescued step."""

    h: float
    damping: Any
    piece: StrangTiming


def make_wrench(composition: Composition, drag: Drag | None) -> Wrench:
    """Return (parameters, pose, twist, time, wrench) -> the sum of all forces on a body."""
    add_pose_forces = join_pose_forces(composition.pose_forces)
    add_velocity_forces = join_velocity_forces(composition.velocity_forces)

    def undamped(
        parameters: StepParameters, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
    ) -> Spatial:
        posed = add_pose_forces(parameters.forces[0], pose, time, wrench)
        return add_velocity_forces(parameters.forces[1], pose, twist, time, posed)

    if drag is None:
        return undamped

    def damped(
        parameters: StepParameters, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
    ) -> Spatial:
        slowed = spatial_add(wrench, drag(parameters.timing.damping, twist))
        return undamped(parameters, pose, twist, time, slowed)

    return damped


def make_step(composition: Composition, order: int, drag: Drag | None) -> Step:
    """Return one step; where nothing acts on a body, it is that of free motion."""
    arrive = composition.water.arrive
    free_step = make_galerkin_drift(order // 2)
    forced_step = make_forced_step(gauss(order // 2), make_wrench(composition, drag), arrive)
    forceless = not (composition.pose_forces or composition.velocity_forces or drag)

    def step(
        parameters: StepParameters,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        time: float,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        if forceless and not some(spatial_dot(wrench, wrench) > 0.0):
            moved, carried, report = free_step(parameters.inertia, h, pose, momentum)
        else:
            moved, carried, report = forced_step(parameters, h, pose, momentum, time, wrench)
        end = arrive(parameters.water, parameters.inertia, time, h, moved, carried)
        return end.pose, end.momentum, report

    return step


def make_fallback(strang: Composition, order: int, drag: Drag | None) -> Advance:
    """Return (parameters, state, wrench, time, 1) -> one body's step in pieces: 2, 4, 8 of its own, or Strang's."""
    step, advance_strang = make_step(strang, order, drag), make_strang(strang)

    def fallback(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        inertia, damping, forces, water, timing = parameters
        pieces = 2
        while pieces <= PIECES:
            h = timing.h / pieces
            pose, momentum, report = step(parameters, h, state.pose, state.momentum, time, wrench)
            worst, iterations = report.solver.relative_residual_squared, report.solver.iterations
            done = 1
            while done < pieces and drift_accepted(report):
                pose, momentum, report = step(parameters, h, pose, momentum, time + done * h, wrench)
                worst = max(worst, report.solver.relative_residual_squared)
                iterations += report.solver.iterations
                done += 1
            if drift_accepted(report):
                return StepOutcome(BodyState(pose, momentum), ACCEPTED, 1, iterations, 1, worst)
            pieces *= 2
        timed = StepParameters(inertia, damping, forces, water, timing.piece)
        return advance_strang(timed, state, wrench, time, PIECES)

    return fallback


@functools.cache
def galerkin_composition(strang: Composition, order: int, drag: Drag | None) -> Composition:
    """Return a Galerkin method's composition; `drag` is the damping of the scene, if it has any."""
    return replace(strang, method=make_galerkin(order, drag), fallback=make_fallback(strang, order, drag))


@functools.cache
def make_galerkin(order: int, drag: Drag | None) -> Callable[[Composition], Advance]:
    """Return (composition) -> advance of the given order."""

    def galerkin(composition: Composition) -> Advance:
        return make_galerkin_advance(composition, order, drag)

    return galerkin


def make_rescue(composition: Composition) -> Callable[..., tuple[DualQuaternion, Spatial, DriftReport]]:
    """Return (parameters, pose, momentum, time, wrench) -> a step by the composition's fallback."""
    fallback = composition.fallback

    def rescue(
        parameters: StepParameters, pose: DualQuaternion, momentum: Spatial, time: float, wrench: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        outcome = fallback(parameters, BodyState(pose, momentum), wrench, time, 1)
        energy_kept = outcome.status != ENERGY_NOT_KEPT
        solved = (outcome.status == ACCEPTED) | negation(energy_kept)
        residual = select(solved, outcome.residual_squared, math.inf)
        solver = SolverReport(residual, outcome.status != WRONG_BRANCH, outcome.iterations)
        return outcome.state.pose, outcome.state.momentum, DriftReport(solver, energy_kept)

    return rescue


def make_galerkin_advance(composition: Composition, order: int, drag: Drag | None) -> Advance:
    """Return the advance of a Galerkin method."""
    step, rescue = make_step(composition, order, drag), make_rescue(composition)

    def advance(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        pose, momentum = state.pose, state.momentum
        progress = set_out(state)
        for taken in range(steps):
            node = time + taken * h
            outcome = step(parameters, h, pose, momentum, node, wrench)
            lost = progress.under_way & negation(drift_accepted(outcome[2]))
            if some(lost):
                outcome = select_call(lost, rescue, (parameters, pose, momentum, node, wrench), outcome)
            flown = Flown(outcome[0], outcome[1], outcome[2], lost)
            progress = progress_by_step(progress_with(progress, flown))
            if not some(progress.under_way):
                break
            pose = select(progress.under_way, flown.pose, pose)
            momentum = select(progress.under_way, flown.momentum, momentum)
        return arrival(state, pose, momentum, progress)

    return advance
