"""Orders 4, 6 and 8 for undamped scenes: symmetric compositions of Strang's step.

A step of size h is made of stages of sizes g_i h, some negative. Strang's step is symmetric, so a symmetric sequence of
stages raises its order (Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, sec. V.3). Spatial momentum stays
exact and energy bounded. Negative stages undo damping unstably, so damped scenes cannot use them.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.selection import some
from dq_marine.algebra.spatial import Spatial, spatial_add_scaled
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.forces import join_posed_forces
from dq_marine.integrator.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    make_flight,
    progress_by_step,
    progress_with,
    set_out,
)

_SUZUKI = 1.0 / (4.0 - 4.0 ** (1.0 / 3.0))

STAGES: dict[int, tuple[float, ...]] = {
    # Suzuki 1990, Phys. Lett. A 146, 319: five stages
    4: (_SUZUKI, _SUZUKI, 1.0 - 4.0 * _SUZUKI, _SUZUKI, _SUZUKI),
    # Kahan & Li 1997, Math. Comp. 66, 1089: s9odr6a
    6: (
        0.39216144400731413927925056,
        0.33259913678935943859974864,
        -0.70624617255763935980996482,
        0.08221359629355080023149045,
        0.79854399093482996339895035,
        0.08221359629355080023149045,
        -0.70624617255763935980996482,
        0.33259913678935943859974864,
        0.39216144400731413927925056,
    ),
    # Kahan & Li 1997: s17odr8a
    8: (
        0.13020248308889008087881763,
        0.56116298177510838456196441,
        -0.38947496264484728640807860,
        0.15884190655515560089621075,
        -0.39590389413323757733623154,
        0.18453964097831570709183254,
        0.25837438768632204729397911,
        0.29501172360931029887096624,
        -0.60550853383003451169892108,
        0.29501172360931029887096624,
        0.25837438768632204729397911,
        0.18453964097831570709183254,
        -0.39590389413323757733623154,
        0.15884190655515560089621075,
        -0.38947496264484728640807860,
        0.56116298177510838456196441,
        0.13020248308889008087881763,
    ),
}
"""Stage sizes over the step size, by order."""


class ComposedTiming(NamedTuple):
    """Stage sizes g_i h [s]."""

    stages: tuple[float, ...]


def make_composed(composition: Composition) -> Advance:
    """Return the advance of a symmetric composition; the scene must have neither damping nor velocity forces.

    Between stages, and between steps, the half kicks that share a pose are taken together.
    """
    add_forces = join_posed_forces(composition.forces)
    fly = make_flight(composition)

    def composed(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        stages = parameters.timing.stages
        pose = state.pose
        node = time
        force = add_forces(parameters.forces, pose, node, wrench)
        momentum = spatial_add_scaled(state.momentum, 0.5 * stages[0], force)
        progress = set_out(state)
        for step in range(steps):
            for stage in range(len(stages)):
                flown = fly(parameters, node, stages[stage], pose, momentum, progress.under_way)
                progress = progress_with(progress, flown)
                if not some(progress.under_way):
                    return arrival(state, pose, momentum, state.fluid_memory, progress)
                pose = flown.pose
                last = stage == len(stages) - 1
                following = 0.0 if last and step == steps - 1 else stages[0 if last else stage + 1]
                node += stages[stage]
                force = add_forces(parameters.forces, pose, node, wrench)
                duration = 0.5 * (stages[stage] + following)
                momentum = spatial_add_scaled(flown.momentum, duration, force)
            progress = progress_by_step(progress)
        return arrival(state, pose, momentum, state.fluid_memory, progress)

    return composed
