"""What a recorded motion looks like at any time, also between two snapshots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from dq_marine.algebra.dual_quaternion import pose_from_parts, pose_position
from dq_marine.algebra.screw import sclerp
from dq_marine.task.things import Thing
from dq_marine.viewer.placement import Quaternion, Vector3, quaternion_wxyz, vector3
from dq_marine.viewer.snapshot import FloatArray, Snapshot, Thrust

ROUNDING = 1e-9
"""Of a count of pictures, and of the share of the way between two snapshots."""


def at_even_times(snapshots: Sequence[Snapshot], rate: float) -> Iterator[Snapshot]:
    """Yield the motion at even times, from that of the first snapshot on and not beyond the last.

    Args:
        snapshots: one or more, in the order of increasing time.
        rate: of those that are yielded [1/s].
    """
    begin, end, later = snapshots[0].time, snapshots[-1].time, 0
    for number in range(picture_count(snapshots, rate)):
        time = min(begin + number / rate, end)
        while snapshots[later].time < time:
            later += 1
        yield between(snapshots[max(later - 1, 0)], snapshots[later], time)


def picture_count(snapshots: Sequence[Snapshot], rate: float) -> int:
    """Return how many snapshots `at_even_times` yields."""
    return int((snapshots[-1].time - snapshots[0].time) * rate + ROUNDING) + 1


def between(earlier: Snapshot, later: Snapshot, time: float) -> Snapshot:
    """Return the motion at a time between two snapshots [s].

    Poses follow the one screw that leads from the one to the other; forces and water change evenly. A goal does not
    travel: the earlier one stands until the later snapshot, and so does what beams tell, and
    a thing that is not there in both.
    """
    length = later.time - earlier.time
    share = (time - earlier.time) / length if length > 0.0 else 1.0
    if share > 1.0 - ROUNDING:
        return later
    if share < ROUNDING:
        return earlier
    position, attitude = _on_the_way(_pose_of(earlier), _pose_of(later), share)
    return replace(
        earlier,
        time=time,
        position_ned=np.array(position),
        quaternion_body_to_ned=np.array(attitude),
        wrench_body=_mixed(earlier.wrench_body, later.wrench_body, share),
        current_ned=_mixed(earlier.current_ned, later.current_ned, share),
        thrusts=tuple(_thrusts_between(earlier.thrusts, later.thrusts, share)),
        things=tuple(_things_between(earlier.things, later.things, share)),
    )


def _thrusts_between(earlier: Sequence[Thrust], later: Sequence[Thrust], share: float) -> Iterable[Thrust]:
    if len(earlier) != len(later):
        return earlier
    return (
        Thrust(
            _mixed(one.position_body, other.position_body, share),
            _mixed(one.force_body, other.force_body, share),
        )
        for one, other in zip(earlier, later, strict=True)
    )


def _things_between(earlier: Sequence[Thing], later: Sequence[Thing], share: float) -> Iterable[Thing]:
    for slot, thing in enumerate(earlier):
        if slot < len(later) and later[slot].form == thing.form:
            way = _on_the_way(thing[1:], later[slot][1:], share)
            yield Thing(thing.form, *way)
        else:
            yield thing


def _pose_of(snapshot: Snapshot) -> tuple[Vector3, Quaternion]:
    return vector3(snapshot.position_ned), quaternion_wxyz(snapshot.quaternion_body_to_ned)


def _on_the_way(
    start: tuple[Vector3, Quaternion], end: tuple[Vector3, Quaternion], share: float
) -> tuple[Vector3, Quaternion]:
    """Return position [m] and attitude at a share of the way from one pose to another."""
    begun, ended = (pose_from_parts(attitude, position) for position, attitude in (start, end))
    pose = sclerp(begun, ended, share)
    return pose_position(pose), pose.real


def _mixed(earlier: FloatArray, later: FloatArray, share: float) -> FloatArray:
    mixed: FloatArray = earlier + share * (later - earlier)
    return mixed
