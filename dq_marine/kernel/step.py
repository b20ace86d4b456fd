"""Composition of a step from its parts: half kick, drift, half kick.

A scene names the functions it needs (`Composition`) and the numbers that go with them (`StepParameters`);
`make_advance` joins the functions into one that advances a body. A term that a scene lacks is not in the
composition, so nothing of it is compiled or computed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from dq_marine.kernel.body import BodyState, Motion
from dq_marine.kernel.current import Water
from dq_marine.kernel.drift import Drift
from dq_marine.kernel.drift_report import drift_accepted
from dq_marine.kernel.dual_quaternion import DualQuaternion, pose_position
from dq_marine.kernel.inertia import Inertia, twist_from_momentum
from dq_marine.kernel.kick import Kick
from dq_marine.kernel.spatial import Spatial, spatial_add

ACCEPTED = 0
NOT_CONVERGED = 1
WRONG_BRANCH = 2
NOT_FINITE = 3

PoseForce: TypeAlias = Callable[[Any, DualQuaternion], Spatial]


@dataclass(frozen=True)
class Composition:
    """The functions that one scene's step is made of.

    Attributes:
        forces: wrenches that depend on the pose, each (parameters, pose) -> wrench.
        kick: momentum change at frozen pose, (parameters, inertia, momentum, wrench) -> momentum.
        drift: force-free motion, (inertia, h, pose, momentum) -> (pose, momentum, report).
        rescue: the same for a step that `drift` does not solve.
        water: what moving water does.
    """

    forces: tuple[PoseForce, ...]
    kick: Kick
    drift: Drift
    rescue: Drift
    water: Water


class StepParameters(NamedTuple):
    """The numbers of one scene.

    Attributes:
        h: step [s].
        inertia: M and its inverses.
        forces: the parameters of `Composition.forces`, nested in pairs (first, (second, (..., ()))).
        half_kick: parameters of the kick over h/2.
        full_kick: parameters of the kick over h.
        water: parameters of `Composition.water`.
    """

    h: float
    inertia: Inertia
    forces: Any
    half_kick: Any
    full_kick: Any
    water: Any


class StepOutcome(NamedTuple):
    """Where the body is and how the solver fared.

    Attributes:
        state: after `completed` steps.
        status: ACCEPTED, or why the next step was refused.
        completed: number of steps taken.
        iterations: Newton iterations of all of them.
        rescued: number of steps that plain Newton did not solve and the rescue did.
        residual_squared: largest squared relative residual met.
    """

    state: BodyState
    status: int
    completed: int
    iterations: int
    rescued: int
    residual_squared: float


def is_finite(pose: DualQuaternion, momentum: Spatial) -> bool:
    """Whether no component is infinite or NaN: only then is the difference of their sum to itself zero."""
    angular, linear, dual = momentum.angular, momentum.linear, pose.dual
    total = angular[0] + angular[1] + angular[2] + linear[0] + linear[1] + linear[2]
    total = total + dual[0] + dual[1] + dual[2] + dual[3]
    return total - total == 0.0


def no_force(parameters: Any, pose: DualQuaternion, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def join_forces(forces: tuple[PoseForce, ...]) -> Callable[[Any, DualQuaternion, Spatial], Spatial]:
    """Return (parameters, pose, wrench) -> wrench + the sum of all forces."""
    if not forces:
        return no_force
    first, rest = forces[0], join_forces(forces[1:])

    def add_forces(parameters: Any, pose: DualQuaternion, wrench: Spatial) -> Spatial:
        return rest(parameters[1], pose, spatial_add(wrench, first(parameters[0], pose)))

    return add_forces


def make_advance(
    composition: Composition,
) -> Callable[[StepParameters, BodyState, Spatial, int], StepOutcome]:
    """Return (parameters, state, wrench, steps) -> outcome: `steps` steps under a constant body wrench.

    The closing half kick of a step and the opening one of the next share a pose and are taken as one full
    kick. A step that the drift refuses ends the call, with the state before that step's drift discarded: the
    outcome's state is the one handed in.
    """
    add_forces = join_forces(composition.forces)
    kick, carry = composition.kick, composition.water.carry
    drift, rescue = composition.drift, composition.rescue

    def advance(parameters: StepParameters, state: BodyState, wrench: Spatial, steps: int) -> StepOutcome:
        inertia = parameters.inertia
        pose = state.pose
        force = add_forces(parameters.forces, pose, wrench)
        momentum = kick(parameters.half_kick, inertia, state.momentum, force)
        iterations = 0
        rescued = 0
        worst = 0.0
        for completed in range(steps):
            moved, transported, report = drift(inertia, parameters.h, pose, momentum)
            if not drift_accepted(report):
                moved, transported, report = rescue(inertia, parameters.h, pose, momentum)
                rescued += 1
            iterations += report.iterations
            worst = max(worst, report.relative_residual_squared)
            if not drift_accepted(report):
                status = NOT_CONVERGED if report.on_rest_branch else WRONG_BRANCH
                residual = report.relative_residual_squared
                return StepOutcome(state, status, completed, iterations, rescued, residual)
            momentum = transported
            pose = carry(parameters.water, parameters.h, moved)
            force = add_forces(parameters.forces, pose, wrench)
            closing = parameters.half_kick if completed == steps - 1 else parameters.full_kick
            momentum = kick(closing, inertia, momentum, force)
        if not is_finite(pose, momentum):
            return StepOutcome(state, NOT_FINITE, steps, iterations, rescued, worst)
        return StepOutcome(BodyState(pose, momentum), ACCEPTED, steps, iterations, rescued, worst)

    return advance


def make_motion(composition: Composition) -> Callable[[StepParameters, BodyState], Motion]:
    """Return (parameters, state) -> the body's motion over ground."""
    water_twist = composition.water.twist

    def motion(parameters: StepParameters, state: BodyState) -> Motion:
        relative = twist_from_momentum(parameters.inertia, state.momentum)
        over_ground = spatial_add(relative, water_twist(parameters.water, state.pose))
        return Motion(pose_position(state.pose), state.pose.real, over_ground)

    return motion
