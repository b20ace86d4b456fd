"""Circles of position: on which a partner may be, by ranges that were measured a while ago.

A range puts the partner on a circle about where the vehicle was. While both go on, the circle is advanced, as for a
running fix (`dq_marine.task.running_fix`): with the partner's velocity v, as it was told last, and one's own velocity u
over ground, its centre c, seen from the vehicle, moves by

    dc/dt = v - u.                                                                                      (1)

Where packets tell no velocities, nothing is plotted.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.level import Level, from_above, level_length
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select, some
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import UNHEARD, Heard, Link

CIRCLES = 8
"""That are kept."""

SPACING = 0.25
"""How far apart the centres of those after the newest are, at least, over the radius: all are seen from other sides."""


class Circle(NamedTuple):
    """A circle of position.

    Attributes:
        centre: seen from the vehicle, in north and east [m].
        radius: [m]; less than 0 where there is no circle yet.
        age: time since the range was measured [s].
    """

    centre: Level
    radius: float
    age: float


Plot: TypeAlias = tuple[Circle, Circle, Circle, Circle, Circle, Circle, Circle, Circle]
"""The circles, the newest first."""


def empty_plot() -> Plot:
    """Return a plot without circles."""
    none = Circle((0.0, 0.0), -1.0, 0.0)
    return (none, none, none, none, none, none, none, none)


def plotted(link: Link, plot: Plot, heard: Any, last: Heard, measured: Motion, period: float) -> Plot:
    """Return the plot a control period [s] later.

    Args:
        link: which tells whether packets tell of courses.
        plot: as it was.
        heard: whether a packet has just been understood.
        last: the last packet.
        measured: one's own motion now.
        period: of control [s].
    """
    own = from_above(rotate(measured.attitude, measured.velocity.linear))
    speed, course = last.message.speed, last.message.course
    velocity = (speed * course[0] - own[0], speed * course[1] - own[1])
    a, b, c, d, e, f, g, h = plot
    a, b = advanced(a, velocity, period), advanced(b, velocity, period)
    c, d = advanced(c, velocity, period), advanced(d, velocity, period)
    e, f = advanced(e, velocity, period), advanced(f, velocity, period)
    g, h = advanced(g, velocity, period), advanced(h, velocity, period)
    later = (a, b, c, d, e, f, g, h)
    heard = heard & (link.course_told > 0.5)
    if some(heard):
        new = circle_of(last, measured, velocity)
        # The newest before it is kept where it tells more than the one before that.
        kept = (b.radius < 0.0) | (distance_between(a, b) > SPACING * new.radius)
        later = select(heard, select(kept, (new, a, b, c, d, e, f, g), (new, b, c, d, e, f, g, h)), later)
    return later


def advanced(circle: Circle, velocity: Level, period: float) -> Circle:
    """Return a circle whose centre moves [m/s], some time later [s]."""
    centre = (circle.centre[0] + period * velocity[0], circle.centre[1] + period * velocity[1])
    return Circle(centre, circle.radius, min(UNHEARD, circle.age + period))


def circle_of(last: Heard, measured: Motion, velocity: Level) -> Circle:
    """Return the circle of a packet that has just been understood.

    Args:
        last: the packet.
        measured: one's own motion.
        velocity: of the partner less one's own, in north and east [m/s].
    """
    deeper = last.message.depth - measured.position_ned[2]
    level = math.sqrt(max(0.0, last.range * last.range - deeper * deeper))
    return Circle((last.age * velocity[0], last.age * velocity[1]), level, last.age)


def distance_between(a: Circle, b: Circle) -> float:
    """Return how far apart the centres of two circles are [m]."""
    return level_length((a.centre[0] - b.centre[0], a.centre[1] - b.centre[1]))
