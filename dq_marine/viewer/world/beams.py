"""The beams of range sensors: bright to a mark at each echo, faint where none came back.

Python hands over where beams begin and point in body axes, and what they tell; the page lays all of them as one object
of line segments (`transport/page/beams.js`). A replay has what they tell at each of its times in the same object.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dq_marine.task.things import Beam
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import line_segments, packed_floats, rgb

BEAMS = "/world/beams"
PINK = 0xFF4FC8

MARK_IN_LENGTHS = 0.06
"""From the middle of the mark of an echo to its corners, in vehicle lengths."""

ABSENT = Beam((0.0, 0.0, 0.0), 0.0, 0.0)
"""Stands for a beam that a snapshot does not have and others have: of no reach, it is not drawn."""


def draw_beams(snapshots: Sequence[Snapshot], shape: Shape) -> list[Message]:
    """Draw the beams of snapshots in the order of their times; nothing where there are none."""
    most = max(len(snapshot.beams) for snapshot in snapshots)
    if not most:
        return []
    rows = [[*one.beams, *[ABSENT] * (most - len(one.beams))] for one in snapshots]
    data = {
        "times": packed_floats(np.array([one.time for one in snapshots])),
        "distances": packed_floats(np.array([[beam.distance for beam in row] for row in rows])),
        "mounts": packed_floats(_mounts(rows)),
        "count": most,
        "color": rgb(PINK).tolist(),
        "mark": MARK_IN_LENGTHS * shape.length,
    }
    return [set_object(BEAMS, line_segments(BEAMS, data))]


def _mounts(rows: Sequence[Sequence[Beam]]) -> FloatArray:
    """Return origin, direction and reach of each beam, shape (rows, beams, 7): one row where they stay the same."""
    mounts = np.array(
        [[[*beam.origin_body, *beam.direction_body, beam.reach] for beam in row] for row in rows]
    )
    return mounts[:1] if (mounts == mounts[0]).all() else mounts
