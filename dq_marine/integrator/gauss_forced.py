"""Steps of a body with forces, by Gauss's collocation on momentum, attitude and position.

With c = h mu, W = M^-1 and the forces F at the stages (docs/theory.md, eqs. G1, G3 and G7-G9)

    K_i = ad*_(W y_i) y_i + h^2 F(p_i, chi_i, t_i)                                                   (G7)
    q_i = q + sum_j A_ij q_j (0, omega_j)/2,   x_i = x + sum_j A_ij q_j v_j q_j*,   [omega; v] = W y (G8)
    J = sum_i b_i [R_i m_i + (x_i - x) x R_i f_i; R_i f_i],   [m; f] = h^2 F                         (G9)

J is what the forces add to the spatial momentum in a step. After one step, or several, the pose is made consistent with
both: the old spatial momentum and the sum of all J are what the new pose carries to the new body momentum c'. What a
force leaves alone, such as the momentum about the vertical under weight and buoyancy, is therefore exact to round-off.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_position,
    pose_renormalise,
)
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_add,
    quaternion_conjugate,
    quaternion_dot,
    quaternion_multiply,
    rotate_inverse,
)
from dq_marine.algebra.selection import negation, select, smallest_normal, some, spread
from dq_marine.algebra.spatial import (
    ZERO,
    Spatial,
    quadratic_form,
    spatial_add,
    spatial_add_scaled,
    spatial_dot,
    spatial_scale,
)
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, scale
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift import transport_momentum
from dq_marine.integrator.drift_report import (
    DriftReport,
    SolverReport,
    nothing_solved,
    report_of_either,
    worst,
)
from dq_marine.integrator.forced_stages import (
    ForcedStage,
    Place,
    Surroundings,
    follow,
    make_evaluate,
    make_forced_sweep,
    moved_place,
    place_extent,
)
from dq_marine.integrator.gauss_landing import Land, keeps_account_of_energy, left_alone, make_landing
from dq_marine.integrator.gauss_stages import make_continued, squared_length, weighted_square
from dq_marine.integrator.increment import AT_ONCE, Increment, as_pose, consistent, unit
from dq_marine.integrator.staged import Step
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.integrator.sweeps import BRISKLY, CAREFULLY, Ending, make_sweeps, same

Steps: TypeAlias = Callable[
    [Any, float, float, int, DualQuaternion, Spatial, Spatial],
    tuple[DualQuaternion, Spatial, DriftReport],
]
"""(the step's parameters, time, h, number of steps, pose, momentum, wrench) -> (pose, momentum, report)."""


def turned_to_world(q: Quaternion, a: Vector3) -> Vector3:
    """Return R a, R the rotation of a q of any length near 1: stages keep the length only to their own order."""
    axis = (q[1], q[2], q[3])
    turn = add(scale(q[0], cross(axis, a)), cross(axis, cross(axis, a)))
    return add_scaled(a, 2.0 / quaternion_dot(q, q), turn)


def impulse(stage: ForcedStage, way: Vector3) -> Spatial:
    """Return a stage's h^2 F in world axes, about the step's start (G9)."""
    force = turned_to_world(stage.attitude, stage.wrench.linear)
    moment = turned_to_world(stage.attitude, stage.wrench.angular)
    return Spatial(add(moment, cross(way, force)), force)


class Marched(NamedTuple):
    """What steps have come to.

    Attributes:
        place: at their end; its way is that since the start of the first.
        given: what the forces have added to the spatial momentum, times h: the sum of all J (G9).
        work: of the constant wrench, times h^2.
        report: how the sweeps fared.
        first: the evaluations at all stages that the sweeps of the step that follows begin with.
    """

    place: Place
    given: Spatial
    work: float
    report: SolverReport
    first: ForcedStage


March: TypeAlias = Callable[[Surroundings, bool, Marched, Ending], Marched]


def make_following(method: Collocation) -> Callable[[Surroundings, Place, ForcedStage], ForcedStage]:
    """Return (start, stages of the step before) -> the evaluations that their rates lead to in a step (G12)."""
    ahead = method.ahead
    columns = tuple(zip(*ahead, strict=True))
    onward = tuple(
        tuple(sum(a * e for a, e in zip(row, column, strict=True)) for column in columns)
        for row in method.matrix
    )

    continued = make_continued(method)

    def following(around: Surroundings, start: Place, found: ForcedStage) -> Any:
        turn = stage_product(onward, found.rate.attitude)
        rate = Place(
            continued(around.length_squared, around.size, found.rate.momentum),
            stage_product(ahead, found.rate.attitude),
            found.rate.way,
        )
        attitude = each_stage(method.weights, quaternion_add, (start.attitude, turn))
        return ForcedStage(rate, found.wrench, found.twist, attitude)

    return following


def make_march(composition: Composition, method: Collocation) -> March:
    """Return (surroundings of the step's start, whether a step was before, what is before, ending) -> a step more."""
    weights, nodes = method.weights, method.nodes
    sweep, following = make_forced_sweep(composition, method), make_following(method)
    sweeps = make_sweeps(method, sweep, moved_place, place_extent)

    def march(at_start: Surroundings, ahead: bool, before: Marched, ending: Ending) -> Marched:
        parameters, length_squared, pushing, h, position, wrench, began, elapsed = at_start
        start = before.place
        size = weighted_square(length_squared, start.momentum) + pushing
        at_nodes = each_stage(nodes, later, (elapsed, h, stage_constants(nodes, start.momentum.linear[0])))
        around = Surroundings(parameters, length_squared, size, h, position, wrench, began, at_nodes)
        found, report = sweeps(around, start, before.first, size, ahead, ending)
        end = follow(start, stage_sum(weights, found.rate))  # (G3), (G8)
        # The ways are computed after the sweeps: where no force asks for the position, these go without them.
        ways = each_stage(weights, add, (start.way, stage_product(method.matrix, found.rate.way)))
        given = stage_sum(weights, each_stage(weights, impulse, (found, ways)))  # (G9)
        place = Place(end.momentum, unit(end.attitude), end.way)
        return Marched(
            place,
            spatial_add(before.given, given),
            before.work + spatial_dot(wrench, stage_sum(weights, found.twist)),
            worst(before.report, report),
            following(around, place, found),
        )

    return march


class ForcedRun(NamedTuple):
    """Steps with forces.

    Attributes:
        increment: of all, made consistent and levelled.
        given: what the forces have added to the momentum, in the axes at the start, times h.
        report: how the sweeps fared.
        settled: see `Landed`.
    """

    increment: Increment
    given: Spatial
    report: DriftReport
    settled: bool


def make_forced_run(composition: Composition, method: Collocation, land: Land) -> Callable[..., ForcedRun]:
    """Return (parameters, time, h, steps, pose, momentum, wrench, ending of the sweeps) -> steps with forces.

    What their pose is made consistent with, at the end of all, is the impulse of all.
    """
    evaluate, march = make_evaluate(composition), make_march(composition, method)
    nodes = method.nodes

    def forced_run(
        parameters: StepParameters,
        time: float,
        h: float,
        steps: int,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
        ending: Ending,
    ) -> ForcedRun:
        inertia = parameters.inertia
        like = momentum.linear[0]
        length_squared = squared_length(inertia)
        start = Place(spatial_scale(h, momentum), pose.real, spread((0.0, 0.0, 0.0), like))
        position = pose_position(pose)
        at_start = Surroundings(parameters, length_squared, like, h, position, wrench, time, 0.0)
        begun = evaluate(at_start, start)
        pushing = weighted_square(length_squared, begun.wrench) + smallest_normal(like)
        first = each_stage(nodes, same, (begun,))
        reached = Marched(start, spread(ZERO, like), spread(0.0, like), nothing_solved(like), first)
        for step in range(steps):
            at_start = Surroundings(parameters, length_squared, pushing, h, position, wrench, time, step * h)
            reached = march(at_start, step > 0, reached, ending)
            if not some(reached.report.on_rest_branch):
                break
        given = to_body(pose.real, reached.given)
        pushed = spatial_add(start.momentum, given)
        moved = motion(start, reached.place)
        increment = consistent_twice(math.sqrt(length_squared), moved, pushed, reached.place.momentum)
        energy = 0.5 * quadratic_form(inertia.inverse, start.momentum)
        landing = Surroundings(parameters, length_squared, energy, h, position, wrench, time, steps * h)
        landed = land(landing, start, pose, increment, pushed, reached.work)
        report = DriftReport(reached.report, spread(True, like))
        return ForcedRun(landed.increment, given, report, landed.settled)

    return forced_run


def better(wanted: bool, run: ForcedRun, before: ForcedRun) -> ForcedRun:
    """Return a run where it is wanted, else that before; iterations are those of both."""
    increment = select(wanted, run.increment, before.increment)
    given = select(wanted, run.given, before.given)
    report = report_of_either(wanted, run.report, before.report)
    return ForcedRun(increment, given, report, select(wanted, run.settled, before.settled))


def make_forced_steps(composition: Composition, method: Collocation) -> Steps:
    """Return (parameters, time, h, steps, pose, momentum, wrench) -> (pose, momentum, report): steps of order 2s.

    Where the scene keeps account of its energy, sweeps end early, and steps that leave too much of it over are taken
    once more, carefully.
    """
    told = keeps_account_of_energy(composition)
    run_of = make_forced_run(composition, method, make_landing(composition) if told else left_alone)
    attempts, hastily = (2, BRISKLY) if told else (1, CAREFULLY)
    carry = composition.water.at_stages.carry

    def forced_steps(
        parameters: StepParameters,
        time: float,
        h: float,
        steps: int,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        like = momentum.linear[0]
        wanted, ending = spread(True, like), hastily
        report = DriftReport(nothing_solved(like), wanted)
        found = ForcedRun(spread(AT_ONCE, like), spread(ZERO, like), report, wanted)
        for _ in range(attempts):
            run = run_of(parameters, time, h, steps, pose, momentum, wrench, ending)
            found = better(wanted, run, found)
            wanted = run.report.solver.on_rest_branch & negation(run.settled)
            ending = CAREFULLY
            if not some(wanted):
                break
        step_taken = as_pose(found.increment)
        after = pose_renormalise(dual_multiply(pose, step_taken))
        impulsive = spatial_add_scaled(momentum, 1.0 / h, found.given)
        given_on = transport_momentum(pose.real, after.real, pose_position(step_taken), impulsive)
        return carry(parameters.water, time, steps * h, after), given_on, found.report

    return forced_steps


def one_of(steps: Steps) -> Step:
    """Return one step, from a function that takes any number."""

    def one(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        return steps(parameters, time, h, 1, pose, momentum, wrench)

    return one


def later(elapsed: float, h: float, node: float) -> float:
    """Return the time of a stage."""
    return elapsed + h * node


def to_body(q: Quaternion, momentum: Spatial) -> Spatial:
    """Return a momentum about the body's origin, in its axes."""
    return Spatial(rotate_inverse(q, momentum.angular), rotate_inverse(q, momentum.linear))


def motion(start: Place, end: Place) -> Increment:
    """Return the motion from one place to another."""
    rotation = quaternion_multiply(quaternion_conjugate(start.attitude), end.attitude)
    return Increment(rotation, rotate_inverse(end.attitude, end.way))


def consistent_twice(length: float, increment: Increment, before: Spatial, after: Spatial) -> Increment:
    """Return the increment that carries one momentum to another: two steps of Newton's method (G6)."""
    return consistent(length, consistent(length, increment, before, after), before, after)
