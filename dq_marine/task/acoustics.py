"""Acoustic modems that take turns: when a packet is heard, what range it gives, and what it says of its sender.

By time division, each of several senders has a slot of its own, one after the other, and sends a packet as it begins
(Stojanovic & Preisig 2009, IEEE Communications Magazine 47(1), 84). Sound that leaves a sender at the time 0 meets
a receiver, which is the vector d away and goes at v, after the time tau at which |d + v tau| = c tau:

    (c^2 - v^2) tau^2 - 2 (d . v) tau - d^2 = 0.                                                        (1)

Clocks are synchronised, so tau is measured and c tau is a range: from where the receiver is then to where the sender
was. The packet is understood when all of it has come, its duration later. What a few bytes say is rounded.

A navigation errs by a Gauss-Markov process, of standard deviation s, that forgets in the time T. Seen at times t apart,
whatever they are, it is

    e' = k e + s sqrt(1 - k^2) n,    k = exp(-t / T),                                                   (2)

with normal numbers n (Gillespie 1996, Phys. Rev. E 54, 2084). One's own is shown in every control period; that of a
sender is known only by what it sends, so it is drawn as it sends, with k since it sent last.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import arctangent, sine_and_cosine
from dq_marine.algebra.level import Level, level_cross, level_dot
from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import negation, rounded, select, some
from dq_marine.algebra.vector3 import Vector3, bounded, dot, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, next_turn

SOUND_SPEED = 1500.0
"""c [m/s]."""

UNHEARD = 60.0
"""Age of what has not been heard yet, and the oldest that is told [s]."""

LENGTH_STEP, SPEED_STEP, COURSE_STEP = 0.1, 0.02, math.tau / 256.0
"""What two bytes resolve of a place or a depth [m], and one of a speed [m/s] and of a course [rad]."""

DRIFT_DRAWS, ERRING_DRAWS = 8, 6
"""Uniform random numbers that `first_modem` takes for the errors of all navigations, and `erring` in a period."""

SENDERS = 3

CONTENTS = ("none", "course", "position")
"""What packets may tell besides the range, each with what those before tell: course, speed and depth; the place."""

SLOT_TIME, PACKET_TIME = 1.0, 0.2
"""Of a sender's turn; and that 16 bytes take at 640 bit/s [s]. What is left is for sound to go a kilometre."""

DRIFT_TIME = 100.0
"""In which an error of navigation fades [s]."""


class Link(NamedTuple):
    """What is the same for all packets.

    Attributes:
        noise: standard deviation of ranges [m].
        dropout: probability that a packet is lost.
        drift: standard deviation of each component of a navigation's error [m].
        kept: share of such an error that is left after a control period.
        slot: time of a sender's turn [s].
        packet: time that a packet takes [s].
        course_told: 1 if packets tell depth, course and speed, else 0.
        position_told: 1 if they tell the place, else 0.
    """

    noise: float
    dropout: float
    drift: float
    kept: float
    slot: float
    packet: float
    course_told: float
    position_told: float


class Sender(NamedTuple):
    """A vehicle with a modem: position [m] and velocity [m/s] in NED."""

    position_ned: Vector3
    velocity_ned: Vector3


class Message(NamedTuple):
    """What a sender says of itself, by its own navigation.

    Attributes:
        place: north and east [m].
        depth: [m].
        course: over ground, as a level unit vector.
        speed: over ground, seen from above [m/s].
    """

    place: Level
    depth: float
    course: Level
    speed: float


class Heard(NamedTuple):
    """The last packet of a sender: range [m], time since it was sent [s], 1 if there has been one, what it said."""

    range: float
    age: float
    heard: float
    message: Message


class Packet(NamedTuple):
    """A packet under way: the range that it will give [m], its age, that at which it is understood [s], its message.

    `due` is negative of one that is lost or has been understood.
    """

    range: float
    age: float
    due: float
    message: Message


class Modem(NamedTuple):
    """A receiver.

    Attributes:
        clock: time since the slot began [s].
        turn: whose slot it is, from 0 on.
        packet: that in the slot.
        last: the last packet of each sender.
        error: of the range of the last packet that was sent [m].
        lost: 1 if that packet is lost, else 0.
        drifts: errors of navigations in north and east [m]: one's own, and of each sender as it sent last.
        left: shares of the senders' errors that are left since then.
    """

    clock: float
    turn: float
    packet: Packet
    last: tuple[Heard, Heard, Heard]
    error: float
    lost: float
    drifts: tuple[Level, Level, Level, Level]
    left: tuple[float, float, float]


def travel_time(offset: Vector3, velocity: Vector3) -> float:
    """Return how long sound takes to a receiver [s], by (1).

    Args:
        offset: of the receiver from the sender, as the sound leaves [m].
        velocity: of the receiver, slower than sound [m/s].
    """
    along, slower = dot(offset, velocity), SOUND_SPEED * SOUND_SPEED - dot(velocity, velocity)
    return (along + math.sqrt(along * along + slower * dot(offset, offset))) / slower


def link_of(noise: float, dropout: float, contents: str, drift: float, period: float) -> Link:
    """Return the link with packets of one of `CONTENTS`, for a control period [s]; for the rest see `Link`."""
    told, kept = CONTENTS.index(contents), math.exp(-period / DRIFT_TIME)
    return Link(noise, dropout, drift, kept, SLOT_TIME, PACKET_TIME, float(told > 0), float(told > 1))


def silent(drifts: tuple[Level, Level, Level, Level]) -> Modem:
    """Return a modem that has heard nothing, with errors of navigations; the first sender's turn is next."""
    nothing = Message((0.0, 0.0), 0.0, (1.0, 0.0), 0.0)
    unheard = Heard(0.0, UNHEARD, 0.0, nothing)
    packet = Packet(0.0, 0.0, -1.0, nothing)
    return Modem(0.0, SENDERS - 1.0, packet, (unheard, unheard, unheard), 0.0, 0.0, drifts, (1.0, 1.0, 1.0))


def first_modem(link: Link, uniforms: tuple[float, ...], index: int) -> Modem:
    """Return a modem that has heard nothing; navigations err as in the long run, by `DRIFT_DRAWS` uniform numbers."""
    none = (0.0, 0.0)
    return silent(
        (
            wandered(none, link.drift, 0.0, uniforms, index),
            wandered(none, link.drift, 0.0, uniforms, index + 2),
            wandered(none, link.drift, 0.0, uniforms, index + 4),
            wandered(none, link.drift, 0.0, uniforms, index + 6),
        )
    )


def slot_then(link: Link, clock: float, period: float) -> tuple[Any, float]:
    """Return whether a slot begins some time later [s], and the time since the slot of then began [s].

    Args:
        link: which has the time of a slot.
        clock: time since the slot of now began [s].
        period: how much later, at most a slot [s].
    """
    # The clock is a sum of periods: half of one decides what rounding would.
    later = clock + period
    begins = later > link.slot - 0.5 * period
    return begins, select(begins, later - link.slot, later)


def turn_then(modem: Modem, begins: Any) -> float:
    """Return whose slot it is, after one may have begun."""
    return select(begins, next_turn(modem.turn, SENDERS), modem.turn)


def erring(link: Link, modem: Modem, uniforms: tuple[float, ...], period: float) -> Modem:
    """Return a modem with the errors of a control period later [s]: one's own, and those of who sends then, by (2)."""
    begins, _ = slot_then(link, modem.clock, period)
    turn = turn_then(modem, begins)
    (own, of_a, of_b, of_c), (a, b, c), kept = modem.drifts, modem.left, link.kept
    errors = (modem.error, modem.lost, (of_a, of_b, of_c), (kept * a, kept * b, kept * c))
    if some(begins):
        errors = select(begins, _sending(link, turn, errors[2], errors[3], uniforms), errors)
    error, lost, (of_a, of_b, of_c), left = errors
    drifts = (wandered(own, link.drift, kept, uniforms, 0), of_a, of_b, of_c)
    return Modem(modem.clock, modem.turn, modem.packet, modem.last, error, lost, drifts, left)


def wandered(error: Level, deviation: float, kept: float, uniforms: tuple[float, ...], index: int) -> Level:
    """Return a navigation's error [m] a while later: a Gauss-Markov process in north and east.

    Args:
        error: before.
        deviation: standard deviation of each component in the long run [m].
        kept: exp(-t / T) for a while t and the time T in which an error fades; 0 draws one that is independent.
        uniforms: random numbers in [0, 1), of which two are used.
        index: of the first.
    """
    north, east = normal_pair(uniforms[index], uniforms[index + 1])
    new = deviation * math.sqrt(1.0 - kept * kept)
    return (kept * error[0] + new * north, kept * error[1] + new * east)


def message_of(sender: Sender, drift: Level) -> Message:
    """Return what a sender says, whose navigation has an error [m]."""
    (x, y, z), (north, east, _) = sender
    sine, cosine = sine_and_cosine(_to_step(arctangent(east, north), COURSE_STEP))
    return Message(
        (_to_step(x + drift[0], LENGTH_STEP), _to_step(y + drift[1], LENGTH_STEP)),
        _to_step(z, LENGTH_STEP),
        (cosine, sine),
        _to_step(math.sqrt(north * north + east * east), SPEED_STEP),
    )


def listened(
    link: Link, modem: Modem, motion: Motion, senders: tuple[Sender, Sender, Sender], period: float
) -> Modem:
    """Return a modem some time later [s], which is shorter than a slot, with its motion and all senders of then."""
    begins, clock = slot_then(link, modem.clock, period)
    turn = turn_then(modem, begins)
    (a, b, c), (_, of_a, of_b, of_c) = senders, modem.drifts
    before, first, second, third = modem.packet, modem.last[0], modem.last[1], modem.last[2]
    packet = Packet(before.range, before.age + period, before.due, before.message)
    if some(begins):
        sender, drift = select(turn < 0.5, (a, of_a), select(turn < 1.5, (b, of_b), (c, of_c)))
        sent = packet_sent(link, motion, sender, drift, modem.error, modem.lost)
        packet = select(begins, sent, packet)
    understood = (packet.due > 0.0) & (packet.age >= packet.due)
    return Modem(
        clock,
        turn,
        Packet(packet.range, packet.age, select(understood, -1.0, packet.due), packet.message),
        (
            last_heard(first, packet, understood & (turn < 0.5), period),
            last_heard(second, packet, understood & (turn > 0.5) & (turn < 1.5), period),
            last_heard(third, packet, understood & (turn > 1.5), period),
        ),
        modem.error,
        modem.lost,
        modem.drifts,
        modem.left,
    )


def packets_told(link: Link, modem: Modem, measured: Motion, bow: Level, far: float) -> Any:
    """Return what is told of the last packets: places up to `far` [m], level, ahead and to starboard of `bow`.

    They are seen from where one's own navigation has the receiver. What packets do not tell is 0.
    """
    (a, b, c), (x, y, z), own = modem.last, measured.position_ned, modem.drifts[0]
    here = (x + own[0], y + own[1], z)
    return (
        packet_told(link, a, here, bow, far),
        packet_told(link, b, here, bow, far),
        packet_told(link, c, here, bow, far),
    )


def packet_told(link: Link, last: Heard, here: Vector3, bow: Level, far: float) -> Any:
    """Return what is told of a sender's last packet, seen from a place [m]; see `packets_told`."""
    said = last.message
    course, position = link.course_told * last.heard, link.position_told * last.heard
    offset = (said.place[0] - here[0], said.place[1] - here[1])
    return (
        (last.heard, course, position),
        last.age,
        bounded(last.range, far),
        bounded(position * level_dot(bow, offset), far),
        bounded(position * level_cross(bow, offset), far),
        bounded(course * (said.depth - here[2]), far),
        (course * level_dot(bow, said.course), course * level_cross(bow, said.course)),
        bounded(course * said.speed, SPEED_BOUND),
    )


def packet_sent(
    link: Link, motion: Motion, sender: Sender, drift: Level, error: float, lost: float
) -> Packet:
    """Return a packet that is sent now.

    Args:
        link: between the two.
        motion: of the receiver.
        sender: where it is.
        drift: error of its navigation [m].
        error: of the range [m].
        lost: 1 if the packet is lost, else 0.
    """
    offset = subtract(motion.position_ned, sender.position_ned)
    delay = travel_time(offset, rotate(motion.attitude, motion.velocity.linear))
    measured = max(0.0, SOUND_SPEED * delay + error)
    due = select(lost > 0.5, -1.0, delay + link.packet)
    return Packet(measured, 0.0 * delay, due, message_of(sender, drift))


def last_heard(before: Heard, packet: Packet, understood: Any, period: float) -> Heard:
    """Return the last packet of a sender, some time later [s]."""
    aged = Heard(before.range, min(UNHEARD, before.age + period), before.heard, before.message)
    return select(understood, Heard(packet.range, packet.age, 1.0, packet.message), aged)


def _sending(link: Link, turn: float, drifts: Any, left: Any, uniforms: tuple[float, ...]) -> Any:
    """Return errors as a packet is sent: of its range, whether it is lost; of all senders, and shares left of them.

    Args:
        link: by which it is sent.
        turn: whose slot it is.
        drifts: errors of the senders' navigations as they sent last [m].
        left: shares of them that are left.
        uniforms: random numbers in [0, 1), of which those from the third on are used.
    """
    (of_a, of_b, of_c), (a, b, c), dropout = drifts, left, link.dropout
    first, third = turn < 0.5, turn > 1.5
    second = negation(first | third)
    before, share = select(first, (of_a, a), select(second, (of_b, b), (of_c, c)))
    now = wandered(before, link.drift, share, uniforms, 2)
    # What is left of a number above the dropout is uniform again, and a lost packet's range is never told.
    normal, _ = normal_pair(max(0.0, uniforms[4] - dropout) / (1.0 - dropout), uniforms[5])
    return (
        link.noise * normal,
        select(uniforms[4] < dropout, 1.0, 0.0),
        (select(first, now, of_a), select(second, now, of_b), select(third, now, of_c)),
        (select(first, 1.0, a), select(second, 1.0, b), select(third, 1.0, c)),
    )


def _to_step(value: float, step: float) -> float:
    """Return the whole multiple of a step that is next to a value."""
    return step * rounded(value / step)
