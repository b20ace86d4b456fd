"""What methods with stages ask of a scene: all forces at a stage as one function, and a step that solves them."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.forces import Forces, join_posed_forces, join_velocity_forces

StageForces: TypeAlias = Callable[[Any, DualQuaternion, Spatial, float, Spatial], Spatial]
"""(the step's parameters, pose, twist, time, constant body wrench) -> all that acts on the body, in its frame."""

Step: TypeAlias = Callable[
    [Any, float, float, DualQuaternion, Spatial, Spatial],
    tuple[DualQuaternion, Spatial, DriftReport],
]
"""(the step's parameters, time, h, pose, momentum, constant body wrench) -> (pose, momentum, report)."""


@functools.cache
def join_forces(forces: Forces) -> StageForces:
    """Return the sum of all forces and the constant wrench, on a body in still water."""
    add_posed_forces = join_posed_forces(forces)
    add_velocity_forces = join_velocity_forces(forces.of_velocity)

    def all_forces(
        parameters: Any, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
    ) -> Spatial:
        posed = add_posed_forces(parameters.forces, pose, time, wrench)
        return add_velocity_forces(parameters.forces.of_velocity, pose, twist, time, posed)

    return all_forces
