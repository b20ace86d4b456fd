"""Two vessels that meet, seen from above: how near they come, and who gives way by the rules of the road at sea.

The rules are those of the Convention on the International Regulations for Preventing Collisions at Sea (COLREG, IMO
1972), part B, for power-driven vessels in sight of one another.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.level import Level, level_cross, level_dot, level_length, seen_at
from dq_marine.algebra.selection import select, smallest_normal
from dq_marine.algebra.vector3 import bounded

ABAFT = math.radians(112.5)
"""Rule 13: who comes up from more than 22.5 degrees abaft the beam overtakes; sternlights are seen from there [rad]."""

AHEAD = math.radians(10.0)
"""Rule 14: nearly ahead, where each of two sees the other when they meet head-on [rad]; the rule gives no number."""

NO_RULE, HEAD_ON, GIVE_WAY, STAND_ON, OVERTAKING, OVERTAKEN = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
"""What one is to another: nothing; head-on; crossing with the other to starboard, or to port; overtaking; overtaken."""

LATEST = 1e9
"""Bound of the time to the closest point of approach, of vessels that hardly move past each other [s]."""


class Nearest(NamedTuple):
    """The closest point of approach of two vessels that keep course and speed: distance [m], and time to it [s].

    The time is 0, and the distance that of now, where they do not come nearer.
    """

    distance: float
    time: float


def closest_approach(offset: Level, velocity: Level) -> Nearest:
    """Return the closest point of approach, DCPA and TCPA: of r + v t, |r + v t| is least at t = -r.v / v.v.

    Args:
        offset: r, from one's own vessel to the other [m].
        velocity: v, of the other less one's own [m/s].
    """
    squared = level_dot(velocity, velocity)
    closing = -level_dot(offset, velocity)
    time = max(0.0, min(LATEST, closing / max(squared, smallest_normal(squared))))
    there = (offset[0] + time * velocity[0], offset[1] + time * velocity[1])
    return Nearest(level_length(there), time)


class Passing(NamedTuple):
    """How far off another vessel passes [m], with the sign of `sight_turns`, and in what time [s]; negative: it has."""

    distance: float
    time: float


def passing(offset: Level, velocity: Level, farthest: float, longest: float) -> Passing:
    """Return how two vessels that keep course and speed pass, or have passed, as a radar plot shows it.

    Args:
        offset: from one's own vessel to the other [m].
        velocity: of the other less one's own [m/s].
        farthest: bound of the distance [m].
        longest: bound of the time [s].
    """
    squared = level_dot(velocity, velocity)
    squared = max(squared, smallest_normal(squared))
    return Passing(
        bounded(sight_turns(offset, velocity) / math.sqrt(squared), farthest),
        bounded(-level_dot(offset, velocity) / squared, longest),
    )


def sight_turns(offset: Level, velocity: Level) -> float:
    """Return the rate of the line of sight to another vessel times distance squared: positive to starboard.

    Two that pass port to port, and a vessel that is let pass ahead from starboard, have it negative.
    """
    return level_cross(offset, velocity)


def meeting(course: Level, other_course: Level, offset: Level, velocity: Level) -> float:
    """Return what one's own vessel is to another, `NO_RULE` to `OVERTAKEN`, by rules 13 to 15.

    Args:
        course: where one's own vessel heads.
        other_course: where the other heads.
        offset: from one's own vessel to the other [m].
        velocity: of the other less one's own [m/s]. Those that do not come nearer are nothing to each other.
    """
    other_seen = seen_at(course, offset)
    own_seen = seen_at(other_course, (-offset[0], -offset[1]))
    crossing = select(other_seen >= 0.0, GIVE_WAY, STAND_ON)
    head_on = (abs(other_seen) <= AHEAD) & (abs(own_seen) <= AHEAD)
    kind = select(head_on, HEAD_ON, crossing)
    kind = select(abs(other_seen) > ABAFT, OVERTAKEN, kind)
    kind = select(abs(own_seen) > ABAFT, OVERTAKING, kind)
    return select(level_dot(offset, velocity) < 0.0, kind, NO_RULE)


def gives_way(kind: float) -> float:
    """Return 1 where one's own vessel is to keep out of the other's way, else 0: rules 13, 14 and 15."""
    return select((kind == HEAD_ON) | (kind == GIVE_WAY) | (kind == OVERTAKING), 1.0, 0.0)


def leaves_to_port(kind: float) -> float:
    """Return 1 where the other is to pass with the line of sight turning to port, else 0.

    Rule 14: both turn to starboard and pass port to port. Rule 15: one does not cross ahead, and so passes astern.
    Who overtakes may pass on either side (rule 13).
    """
    return select((kind == HEAD_ON) | (kind == GIVE_WAY), 1.0, 0.0)
