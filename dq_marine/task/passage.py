"""A passage through a field of pillars to a goal beyond it: where all is, how near the hull is, what was gained."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, norm, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.protocol import Start
from dq_marine.task.world.pillars import FieldPlan, Hull, footprint, make_drifted, make_field, make_nearest


class Passage(NamedTuple):
    """A passage that is under way.

    Attributes:
        goal_ned: as far beyond the field as the start is before it [m].
        pillars: of the field.
        gained: way towards the goal that the last period made good [m].
        distance: to the goal [m].
        clearance: of the hull from the nearest pillar [m].
        impact_speed: at which that was hit, or 0 [m/s].
    """

    goal_ned: Vector3
    pillars: Any
    gained: float
    distance: float
    clearance: float
    impact_speed: float


class Passages(NamedTuple):
    """The functions of passages through a field of so many rows and columns.

    Attributes:
        length: (spacing [m]) -> distance from the start to the goal [m].
        drawn: (plan of the field, depth [m], hull, start, uniforms, index of the field's) -> passage; the first uniform
            number gives its course.
        onward: (passage, hull, motion, period [s]) -> passage a period on.
    """

    length: Callable[[float], float]
    drawn: Callable[[FieldPlan, float, Hull, Start, tuple[float, ...], int], Passage]
    onward: Callable[[Passage, Hull, Motion, float], Passage]


def make_passages(rows: int, columns: int) -> Passages:
    """Return the functions of passages through a field of so many rows and columns."""
    pillars = rows * columns
    drawn_field, drifted, nearest = make_field(rows, columns), make_drifted(pillars), make_nearest(pillars)

    def length(spacing: float) -> float:
        return (rows + 1.0) * spacing

    def drawn(
        plan: FieldPlan, depth: float, hull: Hull, begun: Start, uniforms: tuple[float, ...], index: int
    ) -> Passage:
        course, distance = 2.0 * math.pi * uniforms[0], length(plan.spacing)
        goal = (distance * math.cos(course), distance * math.sin(course), depth)
        field = drawn_field(course, plan, uniforms, index)
        closest = nearest(field, footprint(begun.position_ned, begun.attitude), hull)
        return Passage(goal, field, 0.0, distance, closest.clearance, 0.0)

    def onward(passage: Passage, hull: Hull, motion: Motion, period: float) -> Passage:
        field = drifted(passage.pillars, period)
        closest = nearest(field, footprint(motion.position_ned, motion.attitude), hull)
        over_ground = rotate(motion.attitude, motion.velocity.linear)
        relative = subtract(over_ground, (closest.north_velocity, closest.east_velocity, 0.0))
        distance = norm(subtract(passage.goal_ned, motion.position_ned))
        impact_speed = select(closest.clearance < 0.0, norm(relative), 0.0)
        gained = passage.distance - distance
        return Passage(passage.goal_ned, field, gained, distance, closest.clearance, impact_speed)

    return Passages(length, drawn, onward)
