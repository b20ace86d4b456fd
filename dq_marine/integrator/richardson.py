"""Order 4 for damped scenes: Richardson's extrapolation of Strang's method, with positive substeps only.

A step of size h is taken once whole and once as two halves; (4 halves - whole)/3 is of order 4, if Strang's local
error has no term of h^4. It has none where each of its parts is either symmetric, as the drift and the implicit-node
kick are, or exact up to h^4, as is the kick of `integrator.rosenbrock` and that of linear damping. Momentum and
position are combined by components, the attitude too and then normalised: that differs from a mean in the group by
the square of the two results' difference, O(h^6). Each result is L-stable with an L-stable kick, hence so is their
combination.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_from_parts, pose_position
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.selection import some
from dq_marine.algebra.spatial import Spatial, spatial_add_scaled, spatial_subtract
from dq_marine.algebra.vector3 import add_scaled, subtract
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.extrapolated import joined
from dq_marine.integrator.fluid_memory import Combine
from dq_marine.integrator.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    progress_by_step,
    set_out,
)
from dq_marine.integrator.strang import StrangTiming, make_strang

THIRD = 1.0 / 3.0


class RichardsonTiming(NamedTuple):
    """Strang's timing for h and for h/2."""

    whole: StrangTiming
    halves: StrangTiming


def corrected_attitude(whole: Quaternion, halves: Quaternion) -> Quaternion:
    """Return (4 halves - whole)/3, normalised."""
    d = (halves[0] - whole[0], halves[1] - whole[1], halves[2] - whole[2], halves[3] - whole[3])
    w, x, y, z = (
        halves[0] + THIRD * d[0],
        halves[1] + THIRD * d[1],
        halves[2] + THIRD * d[2],
        halves[3] + THIRD * d[3],
    )
    size = math.sqrt(w * w + x * x + y * y + z * z)
    return (w / size, x / size, y / size, z / size)


def corrected(whole: BodyState, halves: BodyState, combine: Combine) -> BodyState:
    """Return the extrapolated state; `combine` is that of the fluid memory."""
    position = pose_position(halves.pose)
    moved = add_scaled(position, THIRD, subtract(position, pose_position(whole.pose)))
    attitude = corrected_attitude(whole.pose.real, halves.pose.real)
    change = spatial_subtract(halves.momentum, whole.momentum)
    return BodyState(
        pose_from_parts(attitude, moved),
        spatial_add_scaled(halves.momentum, THIRD, change),
        combine(1.0 + THIRD, halves.fluid_memory, -THIRD, whole.fluid_memory),
    )


def make_richardson(composition: Composition) -> Advance:
    """Return the advance of the extrapolated method."""
    strang, combine = make_strang(composition), composition.memory.combine

    def richardson(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        inertia, damping, forces, water, timing, contact = parameters
        now = state
        progress = set_out(state)
        for step in range(steps):
            node = time + step * timing.whole.h
            whole = halves = now
            for pieces in range(1, 3):
                piece = timing.whole if pieces == 1 else timing.halves
                timed = StepParameters(inertia, damping, forces, water, piece, contact)
                outcome = strang(timed, now, wrench, node, pieces)
                progress = joined(progress, outcome)
                whole, halves = halves, outcome.state
            progress = progress_by_step(progress)
            if not some(progress.under_way):
                break
            now = corrected(whole, halves, combine)
        return arrival(state, now.pose, now.momentum, now.fluid_memory, progress)

    return richardson
