"""What each of several vessels sees of the others: the lookout of a task's memory, with where they really are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from dq_marine.algebra.level import Level, level_bow, level_length
from dq_marine.algebra.quaternion import rotate
from dq_marine.integrator.body import Motion
from dq_marine.task.colregs import NO_RULE, gives_way, leaves_to_port, meeting
from dq_marine.task.lookout import Lookout
from dq_marine.task.traffic import FAR_ASTERN, SLOTS, OtherVessel, Own


class Seen(NamedTuple):
    """A vessel from above: place [m], velocity [m/s] and where the bow points, in north and east."""

    place: Level
    velocity: Level
    bow: Level


class Passage(NamedTuple):
    """The least distance to a vessel so far [m], and how the line of sight turned there."""

    least: float
    turning: float


def seen_from_above(motion: Motion, origin: Level) -> Seen:
    """Return a vessel that moves so, in a frame whose origin is at a place [m] of the one to return it in."""
    north, east, _ = motion.position_ned
    velocity = rotate(motion.attitude, motion.velocity.linear)
    place = (north + origin[0], east + origin[1])
    return Seen(place, (velocity[0], velocity[1]), level_bow(motion.attitude))


class Watch:
    """The watch of one vessel, for the nearest of the others.

    By which rule two vessels meet is settled when they first come nearer to each other, and holds from then on,
    whatever either does (rule 13d of COLREG says so of overtaking). What came of a vessel so far is kept while others
    are nearer, and goes on when it is shown again.
    """

    def __init__(self, own: Own, origin: Level) -> None:
        """Take the vessel, and where the origin of its own frame is [m]."""
        self._own, self._origin = own, origin
        self._slots: list[str | None] = [None] * SLOTS
        self._rules: dict[str, float] = {}
        self._passages: dict[str, Passage] = {}

    def first(self, own: Seen, others: Mapping[str, Seen]) -> Lookout:
        """Return the lookout at the start of an episode."""
        far = -FAR_ASTERN * self._own.way
        nobody = OtherVessel((far * own.bow[0], far * own.bow[1]), (0.0, 0.0), 0.0, 0.0, 0.0)
        return self.kept(Lookout((nobody,) * 3, (-far,) * 3, (0.0,) * 3), own, others, 0.0)

    def kept(self, lookout: Lookout, own: Seen, others: Mapping[str, Seen], period: float) -> Lookout:
        """Return a lookout in which the others are where they come from.

        Args:
            lookout: the vessel's, as it is.
            own: the vessel, some time later.
            others: those that there are then.
            period: that time [s], in which the lookout goes on with the others' velocities.
        """
        self._settle(own, others)
        for slot, name in enumerate(self._slots):
            if name is not None:
                self._passages[name] = Passage(lookout.least[slot], lookout.turning[slot])
        self._assign(own, others)
        vessels, passages = (
            list(lookout.vessels),
            [Passage(*both) for both in zip(lookout.least, lookout.turning, strict=True)],
        )
        for slot, name in enumerate(self._slots):
            if name is None:
                vessels[slot] = vessels[slot]._replace(
                    velocity=(0.0, 0.0), present=0.0, give_way=0.0, to_port=0.0
                )
            else:
                vessels[slot] = self._vessel(name, others[name], period)
                new = Passage(_distance(own, others[name]), 0.0)
                passages[slot] = self._passages.get(name, new)
        (a, b, c), (p, q, r) = vessels, passages
        return Lookout((a, b, c), (p.least, q.least, r.least), (p.turning, q.turning, r.turning))

    def _settle(self, own: Seen, others: Mapping[str, Seen]) -> None:
        """Find out by which rule vessels meet that now come nearer."""
        for name, other in others.items():
            if self._rules.get(name, NO_RULE) == NO_RULE:
                offset = (other.place[0] - own.place[0], other.place[1] - own.place[1])
                velocity = (other.velocity[0] - own.velocity[0], other.velocity[1] - own.velocity[1])
                self._rules[name] = meeting(own.bow, other.bow, offset, velocity)

    def _assign(self, own: Seen, others: Mapping[str, Seen]) -> None:
        """Give the slots to the nearest; who has one and still is among them keeps it."""
        nearest = sorted(others, key=lambda name: _distance(own, others[name]))[:SLOTS]
        self._slots = [name if name in nearest else None for name in self._slots]
        new = [name for name in nearest if name not in self._slots]
        for slot, name in enumerate(self._slots):
            if name is None and new:
                self._slots[slot] = new.pop(0)

    def _vessel(self, name: str, other: Seen, period: float) -> OtherVessel:
        """Return a vessel as it has to be so that it is where it is after a period [s], in the watch's own frame."""
        rule, (north, east) = self._rules[name], other.velocity
        place = (
            other.place[0] - self._origin[0] - period * north,
            other.place[1] - self._origin[1] - period * east,
        )
        return OtherVessel(place, other.velocity, 1.0, gives_way(rule), leaves_to_port(rule))


def _distance(own: Seen, other: Seen) -> float:
    return level_length((other.place[0] - own.place[0], other.place[1] - own.place[1]))
