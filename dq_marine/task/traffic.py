"""Other vessels that keep course and speed: drawn so that they meet one's own, or given as a case.

One's own vessel goes from the origin along its route at its speed. Another that is met at the time T starts at

    p = U T e - s U T d + m n,                                                                                  (1)

with e one's own course, d its course, n starboard of that, s its speed over one's own, U, and m how far it misses. With
m = 0 both would be at one place at the time T, and until then each sees the other at one bearing.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_turned
from dq_marine.algebra.selection import select
from dq_marine.task.colregs import gives_way, leaves_to_port, meeting
from dq_marine.task.common import make_pick

SLOTS = 3
"""Other vessels at most."""

VESSEL_DRAWS = 5
"""Uniform random numbers for each of them."""

TRAFFIC_DRAWS = 1 + SLOTS * VESSEL_DRAWS
"""Uniform random numbers for all of them, and for how many there are."""

MEETINGS = (
    (180.0, 5.0, 0.6, 1.2),
    (-95.0, 50.0, 0.6, 1.2),
    (95.0, 50.0, 0.6, 1.2),
    (0.0, 20.0, 0.4, 0.7),
    (0.0, 20.0, 1.4, 1.8),
)
"""Head-on, from starboard, from port, overtaken, overtaking: headings less one's own and their spread [degrees,
clockwise], and the least and largest speed over one's own. Vessels that are drawn from a row meet by the same rule."""

DEGREE = math.pi / 180.0

TIME_SPREAD, MISS = 0.15, 0.5
"""Spread of the times at which vessels that are drawn are met, over the set one, and of their misses [lengths]."""

FAR_ASTERN = 10.0
"""Where a slot without a vessel is, astern of the start, over the way to the meeting."""

pick = make_pick(len(MEETINGS))


class OtherVessel(NamedTuple):
    """Another vessel, seen from above: place [m] and velocity [m/s] in north and east, and 1 or 0 for what it is.

    Attributes:
        place: of now.
        velocity: always.
        present: whether there is a vessel at all.
        give_way: whether one's own has to keep out of its way.
        to_port: whether it has to be left to port; see `colregs.leaves_to_port`.
    """

    place: Level
    velocity: Level
    present: float
    give_way: float
    to_port: float


class Own(NamedTuple):
    """One's own vessel as meetings are drawn: course, speed [m/s], length and way to the meeting [m]."""

    course: Level
    speed: float
    length: float
    way: float


def met(own: Own, heading: float, ratio: float, when: float, miss: float, present: float) -> OtherVessel:
    """Return a vessel that is met; see (1).

    Args:
        own: one's own vessel.
        heading: of the other less one's own [rad].
        ratio: s.
        when: T over the time that one's own takes to the meeting.
        miss: m [m].
        present: 1, or 0 for a slot without a vessel, which is far away and stands still.
    """
    course = level_turned(own.course, heading)
    way, across = when * own.way, (-course[1], course[0])
    place = (
        way * (own.course[0] - ratio * course[0]) + miss * across[0],
        way * (own.course[1] - ratio * course[1]) + miss * across[1],
    )
    velocity = (ratio * own.speed * course[0], ratio * own.speed * course[1])
    there = present > 0.5
    relative = (velocity[0] - own.speed * own.course[0], velocity[1] - own.speed * own.course[1])
    kind = meeting(own.course, course, place, relative)
    far = -FAR_ASTERN * own.way
    return OtherVessel(
        select(there, place, (far * own.course[0], far * own.course[1])),
        select(there, velocity, (0.0, 0.0)),
        present,
        present * gives_way(kind),
        present * leaves_to_port(kind),
    )


def drawn(own: Own, present: float, uniforms: tuple[float, ...], index: int) -> OtherVessel:
    """Return a vessel that is drawn: rule, heading, speed, time and miss by `VESSEL_DRAWS` numbers from `index` on."""
    middle, spread, least, most = pick(len(MEETINGS) * uniforms[index] - 0.5, MEETINGS)
    heading = DEGREE * (middle + spread * (2.0 * uniforms[index + 1] - 1.0))
    ratio = least + (most - least) * uniforms[index + 2]
    when = 1.0 + TIME_SPREAD * (2.0 * uniforms[index + 3] - 1.0)
    miss = MISS * own.length * (2.0 * uniforms[index + 4] - 1.0)
    return met(own, heading, ratio, when, miss, present)


def traffic(
    own: Own, case: Any, from_case: float, most: float, uniforms: tuple[float, ...], index: int
) -> tuple[OtherVessel, OtherVessel, OtherVessel]:
    """Return the vessels that are met: those of a case, or up to `most` that are drawn.

    Args:
        own: one's own vessel.
        case: of each slot heading less one's own [rad], speed over it, and 1 for present.
        from_case: 1 for the case, 0 to draw.
        most: 1 to `SLOTS`; the number of vessels is drawn from 1 on.
        uniforms: random numbers in [0, 1).
        index: of the first of the `TRAFFIC_DRAWS` numbers that are used.
    """
    count, first = most * uniforms[index], index + 1
    second, third = first + VESSEL_DRAWS, first + 2 * VESSEL_DRAWS
    return (
        _slot(own, case[0], from_case, 1.0, uniforms, first),
        _slot(own, case[1], from_case, select(count >= 1.0, 1.0, 0.0), uniforms, second),
        _slot(own, case[2], from_case, select(count >= 2.0, 1.0, 0.0), uniforms, third),
    )


def _slot(
    own: Own,
    case: tuple[float, float, float],
    from_case: float,
    present: float,
    uniforms: tuple[float, ...],
    index: int,
) -> OtherVessel:
    """Return the vessel of a slot."""
    by_draw = drawn(own, present, uniforms, index)
    return select(from_case > 0.5, met(own, case[0], case[1], 1.0, 0.0, case[2]), by_draw)


def moved(vessel: OtherVessel, period: float) -> OtherVessel:
    """Return a vessel some time later [s]."""
    north = vessel.place[0] + period * vessel.velocity[0]
    east = vessel.place[1] + period * vessel.velocity[1]
    return OtherVessel((north, east), vessel.velocity, vessel.present, vessel.give_way, vessel.to_port)
