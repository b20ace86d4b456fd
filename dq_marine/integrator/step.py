"""What a step is made of, and what comes of it.

A scene names the functions it needs (`Composition`) and the numbers that go with them (`StepParameters`);
`make_advance` joins the functions into one that advances a body. A term that a scene lacks is not in the
composition, so nothing of it is compiled or computed. How drifts and kicks follow each other is the composition's
`method`: see `integrator.strang`, `integrator.composed` and `integrator.extrapolated`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts, pose_position
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.selection import negation, select, select_call, some, spread
from dq_marine.algebra.spatial import ZERO, Spatial, spatial_add, spatial_subtract
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.actuation import NO_ACTUATION, Actuation
from dq_marine.integrator.body import AT_REST, BodyState, Motion
from dq_marine.integrator.contact import Contact
from dq_marine.integrator.drift import Drift
from dq_marine.integrator.drift_report import DriftReport, drift_accepted, equation_met
from dq_marine.integrator.fluid_memory import NO_MEMORY, FluidMemory
from dq_marine.integrator.forces import Forces, PoseForce, Potential, TimeForce, VelocityForce
from dq_marine.integrator.inertia import Inertia, momentum_from_twist, twist_from_momentum
from dq_marine.integrator.kick import Kick
from dq_marine.integrator.staged import StageForces, join_forces
from dq_marine.integrator.water import Water, as_it_is

ACCEPTED = 0
NOT_CONVERGED = 1
WRONG_BRANCH = 2
NOT_FINITE = 3
ENERGY_NOT_KEPT = 4

REFUSALS = {
    NOT_CONVERGED: "not_converged",
    WRONG_BRANCH: "wrong_branch",
    NOT_FINITE: "not_finite",
    ENERGY_NOT_KEPT: "energy_not_kept",
}
"""Why a step was refused, by status code."""


@dataclass(frozen=True)
class Composition:
    """The functions that one scene's step is made of.

    Attributes:
        method: (composition) -> advance; the order of drifts and kicks.
        pose_forces: wrenches that depend on pose and time.
        velocity_forces: wrenches that depend on velocity too, apart from damping.
        kick: momentum change at frozen pose, (parameters, damping, inertia, momentum, wrench) -> momentum.
        drift: force-free motion, (inertia, h, pose, momentum) -> (pose, momentum, report).
        fallback: the same for a step that `drift` does not solve; where the method solves its steps itself, an advance
            for those that it does not solve.
        water: what moving water does.
        time_forces: wrenches that depend on time alone.
        actuation: the vehicle's actuators; their force is the first of its kind. None, unless a scene has them.
        potentials: of the pose forces, if all forces of the scene have one and the method makes use of them.
        memory: that of the water.
        contact: with what is solid, if there is anything.
    """

    method: Callable[[Composition], Advance]
    pose_forces: tuple[PoseForce, ...]
    velocity_forces: tuple[VelocityForce, ...]
    kick: Kick
    drift: Drift
    fallback: Callable[..., Any]
    water: Water
    time_forces: tuple[TimeForce, ...] = ()
    actuation: Actuation = NO_ACTUATION
    potentials: tuple[Potential, ...] = ()
    memory: FluidMemory = NO_MEMORY
    contact: Contact | None = None

    @property
    def at_rest(self) -> BodyState:
        """At the world's origin, axes aligned, at rest in water that is undisturbed."""
        return BodyState(AT_REST.pose, ZERO, self.memory.rest)

    @property
    def forces(self) -> Forces:
        """All wrenches."""
        return Forces(self.time_forces, self.pose_forces, self.velocity_forces)

    @property
    def forceless(self) -> bool:
        """Whether nothing acts on a body but a constant wrench; damping counts where it is a velocity force."""
        return not any(self.forces) and self.water.at_stages.forces is as_it_is

    @property
    def stage_forces(self) -> StageForces:
        """All that acts on a body at a stage; damping counts where it is a velocity force."""
        return self.water.at_stages.forces(join_forces(self.forces))


class StepParameters(NamedTuple):
    """The numbers of one scene.

    Attributes:
        inertia: M and its inverses.
        damping: what the composition's kick needs to know for any duration.
        forces: the parameters of the composition's forces.
        water: parameters of `Composition.water`.
        timing: what depends on the step size, as the method wants it.
        contact: parameters of `Composition.contact`.
    """

    inertia: Inertia
    damping: Any
    forces: Forces
    water: Any
    timing: Any
    contact: Any


def in_water(parameters: StepParameters, water: Any) -> StepParameters:
    """Return the parameters in other water."""
    inertia, damping, forces, _, timing, contact = parameters
    return StepParameters(inertia, damping, forces, water, timing, contact)


class StepOutcome(NamedTuple):
    """Where the body is and how the solver fared.

    Attributes:
        state: after `completed` steps.
        status: ACCEPTED, or why the next step was refused.
        completed: number of steps taken.
        iterations: Newton iterations of all of them.
        fallbacks: number of steps that plain Newton did not solve and the fallback did.
        residual_squared: largest squared relative residual met.
    """

    state: BodyState
    status: int
    completed: int
    iterations: int
    fallbacks: int
    residual_squared: float


def is_finite(pose: DualQuaternion, momentum: Spatial) -> bool:
    """Whether no component is infinite or NaN: only then is the difference of their sum to itself zero."""
    angular, linear, dual = momentum.angular, momentum.linear, pose.dual
    total = angular[0] + angular[1] + angular[2] + linear[0] + linear[1] + linear[2]
    total = total + dual[0] + dual[1] + dual[2] + dual[3]
    return total - total == 0.0


Advance: TypeAlias = Callable[[StepParameters, BodyState, Spatial, float, int], StepOutcome]


def make_advance(composition: Composition) -> Advance:
    """Return (parameters, state, wrench, time, steps) -> outcome: steps from `time` on, under a constant body wrench.

    A step that the drift refuses ends the call; the outcome's state is then the one handed in.
    """
    return composition.method(composition)


class Flown(NamedTuple):
    """A drift's outcome: pose, with the water's way added, momentum, report, and whether it took the fallback."""

    pose: DualQuaternion
    momentum: Spatial
    report: DriftReport
    fell_back: bool


def make_flight(
    composition: Composition,
) -> Callable[[StepParameters, float, float, DualQuaternion, Spatial, bool], Flown]:
    """Return (parameters, time, h, pose, momentum, wanted) -> the drift over h from `time` on in the moving water.

    Where plain Newton fails, the fallback does it, but not where it is not `wanted`: for a body refused before.
    """
    drift, fallback, water = composition.drift, composition.fallback, composition.water
    depart, arrive = water.depart, water.arrive

    def fly(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wanted: bool,
    ) -> Flown:
        inertia = parameters.inertia
        start = depart(parameters.water, inertia, time, h, pose, momentum)
        outcome = drift(inertia, h, start.pose, start.momentum)
        lost = wanted & negation(drift_accepted(outcome[2]))
        if some(lost):
            outcome = select_call(lost, fallback, (inertia, h, start.pose, start.momentum), outcome)
        moved, transported, report = outcome
        end = arrive(parameters.water, inertia, time, h, moved, transported)
        return Flown(end.pose, end.momentum, report, lost)

    return fly


class Progress(NamedTuple):
    """How the drifts of a call have gone so far; `under_way` as long as none was refused. See `StepOutcome`."""

    under_way: bool
    status: int
    completed: int
    iterations: int
    fallbacks: int
    residual_squared: float


def set_out(state: BodyState) -> Progress:
    """Return the progress before the first drift."""
    like = state.momentum.linear[0]
    counter = spread(0, like)
    return Progress(spread(True, like), spread(ACCEPTED, like), counter, 0, counter, spread(0.0, like))


def progress_with(progress: Progress, flown: Flown) -> Progress:
    """Return the progress after one more drift."""
    report, solver = flown.report, flown.report.solver
    solved = drift_accepted(report)
    refused = progress.under_way & negation(solved)
    reason = select(solver.on_rest_branch, NOT_CONVERGED, WRONG_BRANCH)
    reason = select(equation_met(solver), ENERGY_NOT_KEPT, reason)
    worst = max(progress.residual_squared, solver.relative_residual_squared)
    return Progress(
        progress.under_way & solved,
        select(refused, reason, progress.status),
        progress.completed,
        progress.iterations + solver.iterations,
        progress.fallbacks + select(flown.fell_back, 1, 0),
        select(progress.under_way, worst, progress.residual_squared),
    )


def progress_by_step(progress: Progress) -> Progress:
    """Return the progress at the end of a step."""
    return Progress(
        progress.under_way,
        progress.status,
        progress.completed + select(progress.under_way, 1, 0),
        progress.iterations,
        progress.fallbacks,
        progress.residual_squared,
    )


def arrival(
    start: BodyState, pose: DualQuaternion, momentum: Spatial, fluid_memory: Any, progress: Progress
) -> StepOutcome:
    """Return the outcome of a call: where its steps led, unless one was refused or that is not finite."""
    finite = is_finite(pose, momentum)
    status = select(progress.under_way & negation(finite), NOT_FINITE, progress.status)
    state = select(progress.under_way & finite, BodyState(pose, momentum, fluid_memory), start)
    return StepOutcome(
        state, status, progress.completed, progress.iterations, progress.fallbacks, progress.residual_squared
    )


def make_placement(
    composition: Composition,
) -> Callable[[StepParameters, Vector3, Quaternion, Spatial], BodyState]:
    """Return (parameters, position, attitude, velocity over ground) -> the state of a body placed so.

    The water has no memory of a motion before.
    """
    water_twist, undisturbed = composition.water.twist, composition.memory.rest

    def place(
        parameters: StepParameters, position_ned: Vector3, attitude: Quaternion, velocity: Spatial
    ) -> BodyState:
        pose = pose_from_parts(attitude, position_ned)
        relative = spatial_subtract(velocity, water_twist(parameters.water, pose))
        momentum = momentum_from_twist(parameters.inertia, relative)
        return BodyState(pose, momentum, spread(undisturbed, momentum.linear[0]))

    return place


def make_motion(composition: Composition) -> Callable[[StepParameters, BodyState], Motion]:
    """Return (parameters, state) -> the body's motion over ground."""
    water_twist = composition.water.twist

    def motion(parameters: StepParameters, state: BodyState) -> Motion:
        relative = twist_from_momentum(parameters.inertia, state.momentum)
        over_ground = spatial_add(relative, water_twist(parameters.water, state.pose))
        return Motion(pose_position(state.pose), state.pose.real, over_ground)

    return motion
