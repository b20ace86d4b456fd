"""A modem that hears one partner, who sends a packet as each slot begins.

Packets are those of `dq_marine.task.acoustics`, and their ranges are plotted as circles of position. Of navigations,
what counts is by how much two of them differ, so their errors are one: drawn anew as a packet is sent, because nobody
hears of it at other times.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level
from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.selection import select, some
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import (
    UNHEARD,
    Heard,
    Link,
    Message,
    Packet,
    Sender,
    last_heard,
    link_of,
    packet_sent,
    packet_told,
    slot_then,
    wandered,
)
from dq_marine.task.position_circles import Plot, empty_plot, plotted
from dq_marine.task.running_fix import fix_told, running_fix

FIRST_DRAWS, HEARING_DRAWS = 2, 5
"""Uniform random numbers that `first_hearing` and `disturbed` take."""

BOTH = math.sqrt(2.0)
"""Standard deviation of the difference of two navigations, over that of one."""


class Hearing(NamedTuple):
    """A receiver.

    Attributes:
        clock: time since the slot began [s].
        packet: that in the slot.
        last: the last packet that was understood.
        error: of the range of the last packet that was sent [m].
        lost: 1 if that packet is lost, else 0.
        drift: by how much both navigations differ, in north and east [m].
        plot: circles on which the partner may be.
    """

    clock: float
    packet: Packet
    last: Heard
    error: float
    lost: float
    drift: Level
    plot: Plot


def partner_link(noise: float, dropout: float, contents: str, drift: float, slot: float) -> Link:
    """Return the link with a partner who sends once in a slot [s], in which a share `kept` of errors is left."""
    return link_of(noise, dropout, contents, drift, slot)._replace(slot=slot)


def first_hearing(link: Link, uniforms: tuple[float, ...], index: int) -> Hearing:
    """Return a modem that has heard nothing, by `FIRST_DRAWS` uniform numbers from `index` on."""
    nothing = Message((0.0, 0.0), 0.0, (1.0, 0.0), 0.0)
    drift = wandered((0.0, 0.0), BOTH * link.drift, 0.0, uniforms, index)
    packet, last = Packet(0.0, 0.0, -1.0, nothing), Heard(0.0, UNHEARD, 0.0, nothing)
    return Hearing(0.0, packet, last, 0.0, 0.0, drift, empty_plot())


def disturbed(link: Link, hearing: Hearing, uniforms: tuple[float, ...], period: float) -> Hearing:
    """Return a modem with errors drawn for a packet, by `HEARING_DRAWS` uniform numbers, if one is sent next."""
    clock, packet, last, error, lost, drift, plot = hearing
    begins, _ = slot_then(link, clock, period)
    if some(begins):
        normal, _ = normal_pair(uniforms[0], uniforms[1])
        drawn = (
            link.noise * normal,
            select(uniforms[2] < link.dropout, 1.0, 0.0),
            wandered(drift, BOTH * link.drift, link.kept, uniforms, 3),
        )
        error, lost, drift = select(begins, drawn, (error, lost, drift))
    return Hearing(clock, packet, last, error, lost, drift, plot)


def heard_from(
    link: Link, hearing: Hearing, motion: Motion, measured: Motion, sender: Sender, period: float
) -> Hearing:
    """Return a modem some time later [s], no longer than a slot, with its motion and the partner of then.

    Args:
        link: with the partner.
        hearing: the modem before.
        motion: its own.
        measured: likewise, as its navigation has it.
        sender: the partner.
        period: how much later [s].
    """
    before = hearing.packet
    begins, clock = slot_then(link, hearing.clock, period)
    packet = Packet(before.range, before.age + period, before.due, before.message)
    if some(begins):
        sent = packet_sent(link, motion, sender, hearing.drift, hearing.error, hearing.lost)
        packet = select(begins, sent, packet)
    understood = (packet.due > 0.0) & (packet.age >= packet.due)
    last = last_heard(hearing.last, packet, understood, period)
    return Hearing(
        clock,
        Packet(packet.range, packet.age, select(understood, -1.0, packet.due), packet.message),
        last,
        hearing.error,
        hearing.lost,
        hearing.drift,
        plotted(link, hearing.plot, understood, last, measured, period),
    )


def partner_told(link: Link, hearing: Hearing, measured: Motion, bow: Level, far: float) -> Any:
    """Return what is told of the partner: by its last packet (`acoustics.packets_told`), and where ranges put it."""
    packet = packet_told(link, hearing.last, measured.position_ned, bow, far)
    likelier, other = running_fix(link, hearing.plot, bow)
    return (*packet, fix_told(likelier, bow, far), fix_told(other, bow, far))
