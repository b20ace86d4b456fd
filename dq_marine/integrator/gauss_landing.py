"""Where steps of Gauss's collocation with forces land: on the energy's level, in scenes that keep account of energy.

A landing takes away what sweeps that end early have left over of the energy (docs/theory.md, eq. G10).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, dual_multiply, pose_renormalise
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import negation, select, some, spread
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_add_scaled, spatial_dot
from dq_marine.integrator.energy_level import MOST_LEVELLINGS, Nearer, is_far_from_level, levelling
from dq_marine.integrator.forced_stages import Place, Surroundings
from dq_marine.integrator.forces import join_pose_forces, join_potentials
from dq_marine.integrator.increment import Increment, as_pose, carried, shifted
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import Composition
from dq_marine.integrator.water import as_it_is


def keeps_account_of_energy(composition: Composition) -> bool:
    """Whether all forces of a scene have potentials.

    Kinetic and potential energy together change by the work of the constant wrench alone then.
    """
    pushed_by_water = composition.water.at_stages.forces is not as_it_is
    lacks_potentials = len(composition.potentials) < len(composition.pose_forces)
    forces = composition.forces
    return not (forces.of_time or forces.of_velocity or lacks_potentials or pushed_by_water)


class Landed(NamedTuple):
    """An increment, and whether its energy says that sweeps have left little over."""

    increment: Increment
    settled: bool


Land: TypeAlias = Callable[[Surroundings, Place, DualQuaternion, Increment, Spatial, float], Landed]
"""(surroundings, start, pose, increment, momentum it carries, work) -> where it lands."""


def left_alone(
    around: Surroundings,
    start: Place,
    pose: DualQuaternion,
    increment: Increment,
    pushed: Spatial,
    work: float,
) -> Landed:
    """Return the increment as it is, of a scene whose energy is not known."""
    return Landed(increment, spread(True, around.size))


def make_landing(composition: Composition) -> Land:
    """Return the increment on the energy's level (G10), for a scene that keeps account of it."""
    potential = join_potentials(composition.potentials)
    add_pose_forces = join_pose_forces(composition.pose_forces)
    carry = composition.water.at_stages.carry

    def nearer(
        around: Surroundings,
        start: Place,
        pose: DualQuaternion,
        increment: Increment,
        pushed: Spatial,
        work: float,
    ) -> Nearer:
        parameters, square = around.parameters, around.h * around.h
        inertia, forces = parameters.inertia, parameters.forces.of_pose
        reached = pose_renormalise(dual_multiply(pose, as_pose(increment)))
        momentum = carried(increment, pushed)
        twist = twist_from_momentum(inertia, momentum)
        had = 0.5 * quadratic_form(inertia.inverse, start.momentum)
        has = 0.5 * spatial_dot(twist, momentum)
        gained = potential(forces, reached) - potential(forces, pose) - work
        there = carry(parameters.water, around.began, around.elapsed, reached)
        force = add_pose_forces(forces, there, around.began + around.elapsed, around.wrench)
        rate = spatial_add_scaled(momentum_bracket(twist, momentum), square, force)
        excess = (has - had) + square * gained
        delta = levelling(around.length_squared, rate, excess, around.size)
        return Nearer(shifted(increment, delta.angular, delta.linear), excess, had + has)

    def levelled(
        around: Surroundings,
        start: Place,
        pose: DualQuaternion,
        increment: Increment,
        pushed: Spatial,
        work: float,
    ) -> Landed:
        first = nearer(around, start, pose, increment, pushed, work)
        level, far = first.increment, is_far_from_level(first)
        count = 1
        while some(far) and count < MOST_LEVELLINGS:
            again = nearer(around, start, pose, level, pushed, work)
            level = select(far, again.increment, level)
            far = far & is_far_from_level(again)
            count += 1
        return Landed(level, negation(far))

    return levelled
