"""Circles of position: on which a partner may be, by ranges that were measured a while ago.

A range puts the partner on a circle about where the vehicle was. While both go on, the circle is advanced, as in a
running fix (Bowditch 2019, The American Practical Navigator, chapter 10): with the partner's velocity v, as it was told
last, and one's own velocity u over ground, its centre c, seen from the vehicle, moves by

    dc/dt = v - u,                                                                                      (1)

and the partner is where the circles meet. Two meet twice; which side it is on shows when the vehicle has turned.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, from_above, level_cross, level_dot
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select, some
from dq_marine.algebra.vector3 import bounded
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Heard, Link

CIRCLES = 8
"""That are kept, of every other packet: of slots of 2 s, half a minute's."""


class Circle(NamedTuple):
    """Centre, seen from the vehicle, in north and east [m]; radius [m], less than 0 where there is no circle yet."""

    centre: Level
    radius: float


class Plot(NamedTuple):
    """The circles.

    Attributes:
        circles: the newest first.
        passed_over: 1 if the last packet gave none, so that the next will, else 0.
    """

    circles: tuple[Circle, Circle, Circle, Circle, Circle, Circle, Circle, Circle]
    passed_over: float


def empty_plot() -> Plot:
    """Return a plot without circles."""
    none = Circle((0.0, 0.0), -1.0)
    return Plot((none, none, none, none, none, none, none, none), 1.0)


def plotted(link: Link, plot: Plot, heard: Any, last: Heard, measured: Motion, period: float) -> Plot:
    """Return the plot a control period [s] later.

    Args:
        link: which tells whether packets tell of courses; else the partner is taken to stand still.
        plot: as it was.
        heard: whether a packet has just been understood.
        last: the last packet.
        measured: one's own motion now.
        period: of control [s].
    """
    own = from_above(rotate(measured.attitude, measured.velocity.linear))
    speed = link.course_told * last.message.speed
    velocity = (speed * last.message.course[0] - own[0], speed * last.message.course[1] - own[1])
    way = (period * velocity[0], period * velocity[1])
    a, b, c, d, e, f, g, h = plot.circles
    a, b, c, d = advanced(a, way), advanced(b, way), advanced(c, way), advanced(d, way)
    e, f, g, h = advanced(e, way), advanced(f, way), advanced(g, way), advanced(h, way)
    later = Plot((a, b, c, d, e, f, g, h), plot.passed_over)
    if some(heard):
        new = circle_of(link, last, measured, velocity)
        circles = select(plot.passed_over > 0.5, (new, a, b, c, d, e, f, g), later.circles)
        later = select(heard, Plot(circles, 1.0 - plot.passed_over), later)
    return later


def advanced(circle: Circle, way: Level) -> Circle:
    """Return a circle whose centre has moved [m]."""
    return Circle((circle.centre[0] + way[0], circle.centre[1] + way[1]), circle.radius)


def circle_of(link: Link, last: Heard, measured: Motion, velocity: Level) -> Circle:
    """Return the circle of a packet that has just been understood.

    Args:
        link: which tells whether packets tell of depths; else the partner is taken to be as deep as the vehicle.
        last: the packet.
        measured: one's own motion.
        velocity: of the partner less one's own, in north and east [m/s].
    """
    deeper = link.course_told * (last.message.depth - measured.position_ned[2])
    level = math.sqrt(max(0.0, last.range * last.range - deeper * deeper))
    return Circle((last.age * velocity[0], last.age * velocity[1]), level)


def circles_told(plot: Plot, bow: Level, far: float) -> Any:
    """Return of each circle 1 if there is one, else 0; its centre, ahead and to starboard; its radius: bounded [m]."""
    a, b, c, d, e, f, g, h = plot.circles
    return (
        (
            circle_told(a, bow, far),
            circle_told(b, bow, far),
            circle_told(c, bow, far),
            circle_told(d, bow, far),
        ),
        (
            circle_told(e, bow, far),
            circle_told(f, bow, far),
            circle_told(g, bow, far),
            circle_told(h, bow, far),
        ),
    )


def circle_told(circle: Circle, bow: Level, far: float) -> Any:
    """Return what is told of one."""
    there = select(circle.radius < 0.0, 0.0, 1.0)
    return (
        there,
        bounded(there * level_dot(bow, circle.centre), far),
        bounded(there * level_cross(bow, circle.centre), far),
        bounded(there * circle.radius, far),
    )
