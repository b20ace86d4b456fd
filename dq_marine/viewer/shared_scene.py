"""Flights that are shown in one scene, and what they share: the sea, the things around, perhaps goal and current."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from dq_marine.errors import InvalidInputError
from dq_marine.task.things import Thing
from dq_marine.viewer.models.paint import FLIGHT_COLORS
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot

REMEDY = "show them side by side (dq_marine.viewer.side_by_side, or dq-marine compare --side-by-side)"

SAME = 1e-6
"""Difference of two numbers up to which two flights tell the same [SI], and of two times [s]."""


@dataclass(frozen=True, eq=False)
class Flight:
    """A recorded flight among others.

    Attributes:
        name: in the legend; no two flights have the same.
        snapshots: one or more, in the order of increasing time.
        shape: of the vehicle.
        caption: what else is to be known, such as why it ended; below the name.
        plots: numbers against time, by what they are, such as "speed [m/s]": one for each snapshot. What is not finite
            is left out of the plot.
    """

    name: str
    snapshots: Sequence[Snapshot]
    shape: Shape
    caption: str = ""
    plots: Mapping[str, ArrayLike] = field(default_factory=dict)

    @property
    def end(self) -> float:
        """The time of the last snapshot [s]."""
        return self.snapshots[-1].time


def check_number(flights: int) -> None:
    """Check that there are flights to show, and no more than can be told apart in one scene.

    Raises:
        InvalidInputError: there are none or too many.
    """
    if not flights:
        raise InvalidInputError("there are 0 flights; give at least 1: record some first")
    if flights > len(FLIGHT_COLORS):
        raise InvalidInputError(
            f"there are {flights} flights, and colours for {len(FLIGHT_COLORS)}; give fewer, or {REMEDY}"
        )


def check_one_scene(flights: Sequence[Flight]) -> None:
    """Check that flights can be shown in one scene.

    Raises:
        InvalidInputError: they do not begin together, some float and others do not, or their seas or the things
            around them differ.
    """
    first = flights[0]
    for other in flights[1:]:
        both = f"the flights {first.name!r} and {other.name!r}"
        begun, begins = first.snapshots[0], other.snapshots[0]
        if abs(begun.time - begins.time) > SAME:
            raise InvalidInputError(
                f"{both} begin at {begun.time:g} s and {begins.time:g} s; on one time axis they begin together: give "
                "their snapshots the same clock"
            )
        if first.shape.floats != other.shape.floats:
            raise InvalidInputError(
                f"of {both} one is of a vessel that floats, which is seen from above the water; {REMEDY}"
            )
        if (begun.sea, begun.sea_start) != (begins.sea, begins.sea_start):
            raise InvalidInputError(f"{both} are in different seas, and one scene has one sea; {REMEDY}")
        for one, another in at_common_times(first, other):
            if not _same_things(one.things, another.things):
                raise InvalidInputError(
                    f"{both} have different things around them at {one.time:g} s, and one scene has each once; {REMEDY}"
                )


def same_goal(one: Flight, other: Flight) -> bool:
    """Return whether two flights have the same goal, whenever both are seen."""
    return all(
        _same(mine.goal_position_ned, theirs.goal_position_ned)
        and _same(mine.goal_quaternion_body_to_ned, theirs.goal_quaternion_body_to_ned)
        for mine, theirs in at_common_times(one, other)
    )


def stage_of(flights: Sequence[Flight]) -> list[Snapshot]:
    """Return the snapshots by which the scene is drawn: the first flight's, until the longest flight ends.

    After its end the first vehicle stands still, while the things around and a goal that it shares go on. Thrust and
    beams are left out, and so is a current or a wind that is not the same in all flights.
    """
    first = flights[0]
    longest = max(flights, key=lambda flight: flight.end)  # the first of those as long
    last = first.snapshots[-1]
    own_goal = not same_goal(first, longest)
    standing = [
        replace(
            last if own_goal else later,
            time=later.time,
            things=later.things,
            current_ned=later.current_ned,
            wind_ned=later.wind_ned,
            position_ned=last.position_ned,
            quaternion_body_to_ned=last.quaternion_body_to_ned,
        )
        for later in longest.snapshots
        if later.time > last.time + SAME
    ]
    pairs = [pair for other in flights[1:] for pair in at_common_times(first, other)]
    flowing = all(_same(one.current_ned, other.current_ned) for one, other in pairs)
    blowing = all(_same(one.wind_ned, other.wind_ned) for one, other in pairs)
    return [
        replace(
            one,
            wrench_body=np.zeros(6),
            thrusts=(),
            beams=(),
            current_ned=one.current_ned if flowing else np.zeros(3),
            wind_ned=one.wind_ned if blowing else None,
        )
        for one in (*first.snapshots, *standing)
    ]


def at_common_times(one: Flight, other: Flight) -> Iterator[tuple[Snapshot, Snapshot]]:
    """Yield pairs of snapshots of two flights that were taken at the same time."""
    theirs = {round(snapshot.time / SAME): snapshot for snapshot in other.snapshots}
    for mine in one.snapshots:
        found = theirs.get(round(mine.time / SAME))
        if found is not None:
            yield mine, found


def _same(one: FloatArray | None, other: FloatArray | None) -> bool:
    if one is None or other is None:
        return one is other
    return bool(np.abs(one - other).max() <= SAME)


def _same_things(some: Sequence[Thing], others: Sequence[Thing]) -> bool:
    return len(some) == len(others) and all(
        one.form == other.form
        and _same(np.array(one.position_ned), np.array(other.position_ned))
        and _same(np.array(one.attitude), np.array(other.attitude))
        for one, other in zip(some, others, strict=True)
    )
