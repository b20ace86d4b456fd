"""Order 4 for scenes with velocity forces: extrapolation of Strang's method, with positive substeps only.

A step of size h is taken once whole, once as two halves and once as three thirds. Strang's method with velocity
forces has a local error e2 h^3 + e3 h^4 + O(h^5) (its kick is not symmetric), and n substeps divide e2 by n^2 and e3
by n^3. The weights w of the three results that sum to 1 and cancel both are 1/12, -4/3, 9/4. (Kicks are not merged
between substeps: that would add a part of e2 h^3 that n substeps divide by n^3, and of e3 h^4 by n^4.) Momentum is
combined by components; poses in the Lie algebra about the finest result, p = p3 exp(w1 log(p3* p1) + w2 log(p3* p2)),
whose commutators are of O(h^6). Each result is L-stable, hence so is their combination.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_conjugate,
    dual_multiply,
    pose_renormalise,
)
from dq_marine.algebra.screw import pose_exp, pose_log
from dq_marine.algebra.selection import select, select_call, some
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_scale
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.step import (
    ACCEPTED,
    Advance,
    Composition,
    Progress,
    StepOutcome,
    StepParameters,
    arrival,
    progress_by_step,
    set_out,
)
from dq_marine.integrator.strang import StrangTiming, make_strang

WEIGHT_WHOLE = 1.0 / 12.0
WEIGHT_HALVES = -4.0 / 3.0
WEIGHT_THIRDS = 9.0 / 4.0


class ExtrapolatedTiming(NamedTuple):
    """Strang's timing for h, h/2 and h/3."""

    whole: StrangTiming
    halves: StrangTiming
    thirds: StrangTiming


def weighted_pose(whole: DualQuaternion, halves: DualQuaternion, thirds: DualQuaternion) -> DualQuaternion:
    """Return the weighted mean of three close poses."""
    back = dual_conjugate(thirds)
    correction = spatial_add(
        spatial_scale(WEIGHT_WHOLE, pose_log(dual_multiply(back, whole))),
        spatial_scale(WEIGHT_HALVES, pose_log(dual_multiply(back, halves))),
    )
    return pose_renormalise(dual_multiply(thirds, pose_exp(correction)))


def weighted_momentum(whole: Spatial, halves: Spatial, thirds: Spatial) -> Spatial:
    """Return the weighted mean of three momenta, by components."""
    coarse = spatial_add(spatial_scale(WEIGHT_WHOLE, whole), spatial_scale(WEIGHT_HALVES, halves))
    return spatial_add(coarse, spatial_scale(WEIGHT_THIRDS, thirds))


def joined(progress: Progress, outcome: StepOutcome) -> Progress:
    """Return the progress after a substep; a body that has been refused before keeps its reason."""
    taken = outcome.status == ACCEPTED
    return Progress(
        progress.under_way & taken,
        select(progress.under_way, outcome.status, progress.status),
        progress.completed,
        progress.iterations + outcome.iterations,
        progress.fallbacks + select(progress.under_way, outcome.fallbacks, 0),
        select(
            progress.under_way,
            max(progress.residual_squared, outcome.residual_squared),
            progress.residual_squared,
        ),
    )


def make_extrapolated(composition: Composition) -> Advance:
    """Return the advance of the extrapolated method."""
    strang, combine = make_strang(composition), composition.memory.combine

    def pieces(
        parameters: StepParameters,
        timing: StrangTiming,
        state: BodyState,
        wrench: Spatial,
        time: float,
        count: int,
        progress: Progress,
    ) -> tuple[BodyState, Progress]:
        """Take a number of single steps."""
        timed = StepParameters(
            parameters.inertia,
            parameters.damping,
            parameters.forces,
            parameters.water,
            timing,
            parameters.contact,
        )
        now = state
        for done in range(count):
            outcome = strang(timed, now, wrench, time + done * timing.h, 1)
            progress = joined(progress, outcome)
            now = outcome.state
        return now, progress

    def extrapolated(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        timing = parameters.timing
        now = state
        progress = set_out(state)
        for step in range(steps):
            node = time + step * timing.whole.h
            whole, progress = pieces(parameters, timing.whole, now, wrench, node, 1, progress)
            halves, progress = pieces(parameters, timing.halves, now, wrench, node, 2, progress)
            thirds, progress = pieces(parameters, timing.thirds, now, wrench, node, 3, progress)
            progress = progress_by_step(progress)
            if not some(progress.under_way):
                break
            coarse = combine(WEIGHT_WHOLE, whole.fluid_memory, WEIGHT_HALVES, halves.fluid_memory)
            now = BodyState(
                select_call(
                    progress.under_way, weighted_pose, (whole.pose, halves.pose, thirds.pose), whole.pose
                ),
                weighted_momentum(whole.momentum, halves.momentum, thirds.momentum),
                combine(1.0, coarse, WEIGHT_THIRDS, thirds.fluid_memory),
            )
        return arrival(state, now.pose, now.momentum, now.fluid_memory, progress)

    return extrapolated
