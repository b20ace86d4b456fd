"""Docks that heave, and how a bow comes into them.

A dock is a cone that opens towards the vehicle, about the level x axis of a frame at its throat. There the bow of a
docked vehicle is. Up to the funnel's length before the throat, at x < 0, the wall is at the radius

    r(x) = r_throat - x tan(angle).                                                                    (1)
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.elementary import arctangent, exponential, sine_and_cosine
from dq_marine.algebra.level import level_cross, level_dot
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, add, cross, norm, subtract
from dq_marine.integrator.body import Motion


class Dock(NamedTuple):
    """A dock, now.

    Attributes:
        north, east: where its axis leads, as a level unit vector.
        depth: of the middle of its heave [m].
        heave: amplitude [m].
        phase: of the heave [rad].
        rate: of the phase [rad/s].
    """

    north: float
    east: float
    depth: float
    heave: float
    phase: float
    rate: float


class Funnel(NamedTuple):
    """Its shape (1): radius of the throat, length [m], tangent of the wall's angle."""

    throat: float
    length: float
    flare: float


class Approach(NamedTuple):
    """A bow seen from a dock: place and velocity along, to starboard, down [m, m/s]; angle of bow and axis [rad]."""

    place: Vector3
    velocity: Vector3
    angle: float


class Limits(NamedTuple):
    """Of contact: speed along the axis, and across it [m/s]; angle of bow and axis [rad]."""

    ahead: float
    across: float
    angle: float


class Contact(NamedTuple):
    """What came of an approach: how far the bow is beyond the throat [m]; whether docked, or struck (0 or 1).

    Also the speed [m/s] with which the bow has met the dock, 0 where it has not.
    """

    ahead: float
    docked: float
    struck: float
    speed: float


def later(dock: Dock, period: float) -> Dock:
    """Return a dock a time [s] later."""
    return Dock(dock.north, dock.east, dock.depth, dock.heave, dock.phase + dock.rate * period, dock.rate)


def heave_of(dock: Dock) -> tuple[float, float, float]:
    """Return depth [m] of the throat, its velocity [m/s] and its acceleration [m/s^2] downwards."""
    sine, cosine = sine_and_cosine(dock.phase)
    wave, slope = dock.heave * sine, dock.heave * cosine
    return dock.depth + wave, dock.rate * slope, -(dock.rate * dock.rate * wave)


def along_dock(dock: Dock, a_ned: Vector3) -> Vector3:
    """Return a vector's components along a dock's axis, to its starboard, and down."""
    axis, level = (dock.north, dock.east), (a_ned[0], a_ned[1])
    return (level_dot(axis, level), level_cross(axis, level), a_ned[2])


def across(a: Vector3) -> float:
    """Return the length of what of a vector is across the axis."""
    return math.sqrt(a[1] * a[1] + a[2] * a[2])


def approach(dock: Dock, motion: Motion, to_bow: float) -> Approach:
    """Return how the bow of a vehicle, which is ahead of its origin [m], is before a dock, and moves there."""
    depth, sinking, _ = heave_of(dock)
    linear, angular, arm = motion.velocity.linear, motion.velocity.angular, (to_bow, 0.0, 0.0)
    bow_ned = rotate(motion.attitude, arm)
    velocity_ned = rotate(motion.attitude, add(linear, cross(angular, arm)))
    place = along_dock(dock, subtract(add(motion.position_ned, bow_ned), (0.0, 0.0, depth)))
    heading = along_dock(dock, bow_ned)
    velocity = along_dock(dock, subtract(velocity_ned, (0.0, 0.0, sinking)))
    return Approach(place, velocity, arctangent(across(heading), heading[0]))


def merits(funnel: Funnel, limits: Limits, far: float, bow: Approach) -> Vector3:
    """Return how near a bow is, how well it is in the cone before the dock, and how well aligned: each 1 at the throat.

    Rewards are for their changes: then waiting before the dock earns nothing. A reward for being near would make it
    worth while never to arrive (Ng, Harada and Russell, "Policy invariance under reward transformations", ICML 1999).

    Args:
        funnel: whose cone it is, carried on from its mouth.
        limits: of contact; that of the angle is the scale of the alignment.
        far: distance at which the nearness is 1/e [m].
        bow: seen from the dock.
    """
    distance = norm(bow.place)
    wide = across(bow.place) / (funnel.throat + funnel.flare * distance)
    turned = bow.angle / limits.angle
    return (exponential(-distance / far), exponential(-wide * wide), exponential(-turned * turned))


def contact(funnel: Funnel, limits: Limits, ahead_before: float, bow: Approach) -> Contact:
    """Return what came of an approach: docked where the bow passes the throat's plane in the throat, within the limits.

    It strikes the dock where it is in the wall (1), which is as thick as the funnel is long, or passes the plane in any
    other way, no farther from the axis than the mouth is wide.
    """
    ahead, off = bow.place[0], across(bow.place)
    wall, mouth = funnel.throat - ahead * funnel.flare, funnel.throat + funnel.length * funnel.flare
    in_wall = (ahead < 0.0) & (ahead > -funnel.length) & (off > wall) & (off < wall + funnel.length)
    through = (ahead_before < 0.0) & (ahead >= 0.0) & (off < mouth)
    slow = (bow.velocity[0] <= limits.ahead) & (across(bow.velocity) <= limits.across)
    docked = through & (off <= funnel.throat) & slow & (bow.angle <= limits.angle)
    met = in_wall | through
    return Contact(
        ahead,
        select(docked, 1.0, 0.0),
        select(docked, 0.0, select(met, 1.0, 0.0)),
        select(met, norm(bow.velocity), 0.0),
    )
