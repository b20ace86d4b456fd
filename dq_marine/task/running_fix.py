"""A running fix: where circles of position meet (Bowditch 2019, The American Practical Navigator, chapter 10).

Every circle but the newest meets that twice, or comes nearest to it. Of these places the one is taken that lies best on
all circles, and of those apart from it again the best: along a straight way all circles meet twice, and only a turn
shows which of the two places it is. By errors e of n independent ranges of standard deviation s, a place is likely by

    ln p = -1/2 sum_k min(e_k^2 / s_k^2, m),                                                            (1)

where m bounds what a single one can say. Along the newest circle, of radius r about c, at its unit vector u, each is
brought nearer to where this is largest by steps of Gauss's and Newton's method, in the angle t,

    dt = -sum_k (e_k e_k' / s_k^2) / (1 + sum_k (e_k' / s_k)^2),    e_k = |c + r u - c_k| - r_k,        (2)

with derivatives by t, in which the 1 holds still what no circle tells.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.level import Level, level_along, level_cross, level_dot, level_length
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import bounded
from dq_marine.task.acoustics import LENGTH_STEP, Link
from dq_marine.task.position_circles import Circle, Plot

FIXES = 2
"""Places that are told."""

DRIFT = 0.015
"""By which an advanced circle errs more from second to second [m/s]: the velocities that advance it err."""

MOST = 25.0
"""m of equation (1)."""

PREFERENCE, PREFERRED = 0.5, (math.sqrt(0.5), math.sqrt(0.5))
"""By how much, in ln p, places in a direction, ahead and to starboard, are preferred."""

APART = math.cos(0.3)
"""Cosine of the angle on the newest circle, from which on two places are two."""

LONGEST_STEP = 0.2
"""Of equation (2) [rad]."""

CONCENTRIC = 1e-6
"""Centres no farther apart are taken to be one [m]; circles about one meet nowhere, and a place on them is as good."""

NOWHERE = -1e3
"""ln p of a place that there is no circle for."""


class Line(NamedTuple):
    """A circle about a centre [m] that a place is on, of a radius [m], and 1/s^2 of that [1/m^2]; 0 where none is."""

    centre: Level
    radius: float
    certain: float


Lines: TypeAlias = tuple[Line, Line, Line, Line, Line, Line, Line, Line]
"""Of a plot, the newest first."""


class Place(NamedTuple):
    """A place on the newest circle: the unit vector to it from the centre, and its ln p."""

    direction: Level
    likely: float


class Fix(NamedTuple):
    """Where the partner may be, seen from the vehicle, in north and east [m]; its share of both p; 1 if it is known."""

    place: Level
    share: float
    told: float


Pair: TypeAlias = tuple[Place, Place]

Pairs: TypeAlias = tuple[Pair, Pair, Pair, Pair, Pair, Pair, Pair]
"""Where each circle but the newest meets that."""


def running_fix(link: Link, plot: Plot, bow: Level) -> tuple[Fix, Fix]:
    """Return the two places where circles meet best, the likelier first.

    Of two about as likely, the first is the one more to starboard of the bow: who always tries the same one finds out
    by its turn, and who goes between them never does.

    Args:
        link: which tells how much ranges err.
        plot: circles in north and east.
        bow: where it points: a unit vector.
    """
    lines = lines_of(link, plot)
    pairs = meetings(lines, level_along(PREFERRED, bow))
    one = best_of(pairs)
    other = best_of(all_apart_from(one, pairs))
    one, other = refined(lines, one), refined(lines, other)
    share = 1.0 / (1.0 + exponential(bounded(other.likely - one.likely, MOST)))
    known = select(plot[1].radius < 0.0, 0.0, 1.0)
    return (
        Fix(on_line(lines[0], one.direction), share, known),
        Fix(on_line(lines[0], other.direction), 1.0 - share, known),
    )


def lines_of(link: Link, plot: Plot) -> Lines:
    """Return the circles of a plot, with how certain they are."""
    a, b, c, d, e, f, g, h = plot
    return (
        line_of(link, a),
        line_of(link, b),
        line_of(link, c),
        line_of(link, d),
        line_of(link, e),
        line_of(link, f),
        line_of(link, g),
        line_of(link, h),
    )


def line_of(link: Link, circle: Circle) -> Line:
    """Return one of them."""
    older = DRIFT * circle.age
    variance = link.noise * link.noise + LENGTH_STEP * LENGTH_STEP + older * older
    return Line(circle.centre, circle.radius, select(circle.radius < 0.0, 0.0, 1.0 / variance))


def meetings(lines: Lines, preferred: Level) -> Pairs:
    """Return where each circle but the newest meets that."""
    _, b, c, d, e, f, g, h = lines
    return (
        meeting(lines, b, preferred),
        meeting(lines, c, preferred),
        meeting(lines, d, preferred),
        meeting(lines, e, preferred),
        meeting(lines, f, preferred),
        meeting(lines, g, preferred),
        meeting(lines, h, preferred),
    )


def meeting(lines: Lines, other: Line, preferred: Level) -> Pair:
    """Return where one of the circles meets the newest, or comes nearest to it."""
    newest = lines[0]
    way = (other.centre[0] - newest.centre[0], other.centre[1] - newest.centre[1])
    apart = max(CONCENTRIC, level_length(way))
    along = select(apart > CONCENTRIC, (way[0] / apart, way[1] / apart), (1.0, 0.0))
    # The law of cosines, in the triangle of both centres and the place.
    squares = newest.radius * newest.radius + apart * apart - other.radius * other.radius
    cosine = bounded(squares / max(CONCENTRIC, 2.0 * newest.radius * apart), 1.0)
    sine = math.sqrt(1.0 - cosine * cosine)
    right, left = level_along((cosine, sine), along), level_along((cosine, -sine), along)
    there = other.radius >= 0.0
    return (
        Place(right, select(there, preference(lines, right, preferred), NOWHERE)),
        Place(left, select(there, preference(lines, left, preferred), NOWHERE)),
    )


def preference(lines: Lines, direction: Level, preferred: Level) -> float:
    """Return equation (1) for a place on the newest circle, and what it is preferred by."""
    place = on_line(lines[0], direction)
    towards = level_dot(preferred, place) / max(1e-6, level_length(place))
    return likelihood(lines, direction) + PREFERENCE * towards


def better(a: Place, b: Place) -> Place:
    """Return the likelier of two places, the first of two alike."""
    return select(b.likely > a.likely, b, a)


def best_of(pairs: Pairs) -> Place:
    """Return the likeliest of all."""
    a, b, c, d, e, f, g = pairs
    first = better(better(better(*a), better(*b)), better(better(*c), better(*d)))
    return better(first, better(better(*e), better(better(*f), better(*g))))


def all_apart_from(one: Place, pairs: Pairs) -> Pairs:
    """Return all places, of which those about where one is do not count."""
    a, b, c, d, e, f, g = pairs
    return (
        apart_from(one, a),
        apart_from(one, b),
        apart_from(one, c),
        apart_from(one, d),
        apart_from(one, e),
        apart_from(one, f),
        apart_from(one, g),
    )


def apart_from(one: Place, pair: Pair) -> Pair:
    """Return two of these."""
    a, b = pair
    return (
        Place(a.direction, select(level_dot(a.direction, one.direction) < APART, a.likely, NOWHERE)),
        Place(b.direction, select(level_dot(b.direction, one.direction) < APART, b.likely, NOWHERE)),
    )


def likelihood(lines: Lines, direction: Level) -> float:
    """Return equation (1) for a place on the newest circle."""
    place = on_line(lines[0], direction)
    a, b, c, d, e, f, g, h = lines
    squares = (
        (square_off(a, place) + square_off(b, place)) + (square_off(c, place) + square_off(d, place))
    ) + ((square_off(e, place) + square_off(f, place)) + (square_off(g, place) + square_off(h, place)))
    return -0.5 * squares


def square_off(line: Line, place: Level) -> float:
    """Return how far a place is off a circle, squared and over its variance, as far as that counts."""
    off = level_length((place[0] - line.centre[0], place[1] - line.centre[1])) - line.radius
    return min(MOST, off * off * line.certain)


def refined(lines: Lines, place: Place) -> Place:
    """Return a place brought nearer to where it is likeliest, with what it is likely by alone."""
    direction = nearer(lines, nearer(lines, place.direction))
    there = place.likely > 0.5 * NOWHERE
    return Place(direction, select(there, likelihood(lines, direction), NOWHERE))


def nearer(lines: Lines, direction: Level) -> Level:
    """Return the direction of a place after one step of equation (2)."""
    a, b, c, d, e, f, g, h = lines
    place, across = on_line(a, direction), (-a.radius * direction[1], a.radius * direction[0])
    first = both(pull(b, place, across), pull(c, place, across))
    second = both(pull(d, place, across), pull(e, place, across))
    third = both(pull(f, place, across), pull(g, place, across))
    push, hold = both(both(first, second), both(third, pull(h, place, across)))
    turn = bounded(-push / (1.0 + hold), LONGEST_STEP)
    there = level_along((1.0, turn), direction)
    length = level_length(there)
    return (there[0] / length, there[1] / length)


def pull(line: Line, place: Level, across: Level) -> Level:
    """Return what a circle adds to both sums of equation (2).

    Args:
        line: one but the newest, which all places are on.
        place: from which the step begins [m].
        across: how it moves with the angle [m/rad].
    """
    way = (place[0] - line.centre[0], place[1] - line.centre[1])
    length = max(1e-6, level_length(way))
    slope = level_dot(across, way) / length
    return ((length - line.radius) * slope * line.certain, slope * slope * line.certain)


def both(a: Level, b: Level) -> Level:
    """Return the sum."""
    return (a[0] + b[0], a[1] + b[1])


def fix_told(fix: Fix, bow: Level, far: float) -> Any:
    """Return of a fix 1 if there is one, else 0; where it bears, ahead and to starboard; how far off; and its share."""
    distance = level_length(fix.place)
    scale = fix.told / max(1e-6, distance)
    return (
        fix.told,
        scale * level_dot(bow, fix.place),
        scale * level_cross(bow, fix.place),
        fix.told * min(far, distance),
        fix.told * fix.share,
    )


def on_line(line: Line, direction: Level) -> Level:
    """Return the place on a circle in a direction from its centre."""
    return (
        line.centre[0] + line.radius * direction[0],
        line.centre[1] + line.radius * direction[1],
    )
