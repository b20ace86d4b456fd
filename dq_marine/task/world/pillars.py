"""Fields of vertical pillars or net cages, still or adrift: where they stand, what is nearest, what a beam meets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_bow, level_cross, level_dot, level_length, level_turned
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3
from dq_marine.task.world.rays import ray_to_pillar

PILLAR_DRAWS = 5
"""Uniform random numbers that a pillar of a field takes; and each row takes one more."""


class Layout(NamedTuple):
    """What stands in a field, in shares of the spacing.

    Attributes:
        thinnest: least radius.
        thickest: largest radius.
        off_row: the farthest that one is from its row.
        off_place: the farthest that one is from its place in the row.
        netted: 1 for net cages, 0 for pillars, which look otherwise.
    """

    thinnest: float
    thickest: float
    off_row: float
    off_place: float
    netted: float


LAYOUTS: Mapping[str, Layout] = MappingProxyType(
    {
        "pillars": Layout(0.08, 0.2, 0.15, 0.1, 0.0),
        "cages": Layout(0.2, 0.25, 0.05, 0.05, 1.0),
    }
)
"""Of fields, by what stands in them: cages are wide, and stand in order."""


class FieldPlan(NamedTuple):
    """A field to be drawn: spacing of rows and columns [m], largest speed of pillars [m/s], and their layout."""

    spacing: float
    speed: float
    layout: Layout


class Pillar(NamedTuple):
    """A vertical cylinder without ends: where its axis is, its radius [m], and its velocity [m/s]."""

    north: float
    east: float
    radius: float
    north_velocity: float
    east_velocity: float


class Hull(NamedTuple):
    """A vehicle seen from above, as all that is within half its beam of a line along it: half the sizes [m]."""

    half_length: float
    half_beam: float


class Footprint(NamedTuple):
    """Where a hull is [m], and the unit vector that its bow points along, seen from above."""

    place: Level
    bow: Level


class Nearest(NamedTuple):
    """Clearance between a hull and the nearest pillar [m], and that pillar's velocity [m/s]."""

    clearance: float
    north_velocity: float
    east_velocity: float


def footprint(position_ned: Vector3, attitude: Quaternion) -> Footprint:
    """Return what is seen of a vehicle from above; of one that stands on end, a point is all there is."""
    return Footprint((position_ned[0], position_ned[1]), level_bow(attitude))


def clearance(pillar: Pillar, own: Footprint, hull: Hull) -> float:
    """Return how far a hull's side is from a pillar's [m]; less than 0 where they overlap."""
    offset = (pillar.north - own.place[0], pillar.east - own.place[1])
    beyond = max(abs(level_dot(own.bow, offset)) - max(hull.half_length - hull.half_beam, 0.0), 0.0)
    return level_length((beyond, level_cross(own.bow, offset))) - hull.half_beam - pillar.radius


def make_nearest(count: int, first: int = 0) -> Callable[[Any, Footprint, Hull], Nearest]:
    """Return (pillars, footprint, hull) -> the nearest of so many pillars."""

    def one(pillars: Any, place: Footprint, hull: Hull) -> Nearest:
        pillar = pillars[first]
        return Nearest(clearance(pillar, place, hull), pillar.north_velocity, pillar.east_velocity)

    if first == count - 1:
        return one
    rest = make_nearest(count, first + 1)

    def nearest(pillars: Any, place: Footprint, hull: Hull) -> Nearest:
        here, others = one(pillars, place, hull), rest(pillars, place, hull)
        return select(here.clearance <= others.clearance, here, others)

    return nearest


def pillars_cast(pillars: Any, origin: Vector3, direction: Vector3, reach: float) -> float:
    """Return the range to the first of the pillars that a ray meets; a loop, for beams are many to be compiled."""
    nearest = reach + 0.0 * origin[0]
    for pillar in pillars:
        found = ray_to_pillar(origin, direction, pillar.north, pillar.east, pillar.radius, reach)
        nearest = min(nearest, found)
    return nearest


def make_drifted(count: int, first: int = 0) -> Callable[[Any, float], Any]:
    """Return (pillars, time [s]) -> where so many pillars are after that time."""

    def one(pillars: Any, time: float) -> Any:
        old = pillars[first]
        north, east = old.north + time * old.north_velocity, old.east + time * old.east_velocity
        return (Pillar(north, east, old.radius, old.north_velocity, old.east_velocity),)

    if first == count - 1:
        return one
    rest = make_drifted(count, first + 1)

    def drifted(pillars: Any, time: float) -> Any:
        return (*one(pillars, time), *rest(pillars, time))

    return drifted


def field_draws(rows: int, columns: int) -> int:
    """Return how many uniform random numbers a field takes."""
    return rows * (1 + columns * PILLAR_DRAWS)


def make_field(rows: int, columns: int) -> Callable[[float, FieldPlan, tuple[float, ...], int], Any]:
    """Return (course [rad], plan, uniforms, index) -> pillars in rows across a course.

    The rows are a spacing apart, the first a spacing from the origin. Each is shifted along itself by up to half a
    spacing, and its pillars, a spacing apart, are scattered. Every other pillar goes at up to the speed, any way.
    """
    return _make_field_from(rows, columns, 0)


def _make_field_from(rows: int, columns: int, number: int) -> Callable[..., Any]:
    row, column = divmod(number, columns)
    along, across, moving = row + 1.0, column - 0.5 * (columns - 1), float(number % 2)
    shift, own = row * (1 + columns * PILLAR_DRAWS), 1 + column * PILLAR_DRAWS

    def one(course: float, plan: FieldPlan, uniforms: tuple[float, ...], index: int) -> Any:
        at, spacing, layout = index + shift + own, plan.spacing, plan.layout
        ahead = spacing * (along + layout.off_row * (2.0 * uniforms[at] - 1.0))
        off_place = layout.off_place * (2.0 * uniforms[at + 1] - 1.0)
        aside = spacing * (across + uniforms[index + shift] - 0.5 + off_place)
        radius = spacing * (layout.thinnest + (layout.thickest - layout.thinnest) * uniforms[at + 2])
        way, pace = 2.0 * math.pi * uniforms[at + 3], moving * plan.speed * uniforms[at + 4]
        north, east = level_turned((ahead, aside), course)
        return (Pillar(north, east, radius, pace * math.cos(way), pace * math.sin(way)),)

    if number == rows * columns - 1:
        return one
    rest = _make_field_from(rows, columns, number + 1)

    def field(course: float, plan: FieldPlan, uniforms: tuple[float, ...], index: int) -> Any:
        return (*one(course, plan, uniforms, index), *rest(course, plan, uniforms, index))

    return field
