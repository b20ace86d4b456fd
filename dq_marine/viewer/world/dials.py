"""Numbers for the page's legend: each is the position of a thing that cannot be seen, so that replays have them, too.

| path | its position |
|---|---|
| `/world/dials/force` | net force [N], NED |
| `/world/dials/moment` | net moment about the vehicle's origin [N m], NED |
| `/world/dials/actuators` | its x is the number of actuators that have an arrow |
| `/world/dials/current` | velocity of the water [m/s], NED |
| `/world/dials/wind` | velocity of the mean wind [m/s], NED |
| `/world/dials/waves` | significant height [m] times the direction, north and east, of the waves; peak period [s] |

All are 0 where there is none.
"""

from __future__ import annotations

import math

import numpy as np

from dq_marine.physics.waves.sea import Sea
from dq_marine.viewer.placement import Placement, Vector3, vector3
from dq_marine.viewer.snapshot import FloatArray, Snapshot

DIALS = "/world/dials"
FORCE = f"{DIALS}/force"
MOMENT = f"{DIALS}/moment"
ACTUATORS = f"{DIALS}/actuators"
CURRENT = f"{DIALS}/current"
WIND = f"{DIALS}/wind"
WAVES = f"{DIALS}/waves"


def dial_placements(snapshot: Snapshot, body_to_ned: FloatArray) -> dict[str, Placement]:
    """What the dials show, by path.

    Args:
        snapshot: has the numbers.
        body_to_ned: rotation matrix, shape (3, 3).
    """
    wind = np.zeros(3) if snapshot.wind_ned is None else snapshot.wind_ned
    shown: dict[str, Vector3] = {
        FORCE: vector3(body_to_ned @ snapshot.wrench_body[:3]),
        MOMENT: vector3(body_to_ned @ snapshot.wrench_body[3:]),
        ACTUATORS: (float(len(snapshot.thrusts)), 0.0, 0.0),
        CURRENT: vector3(snapshot.current_ned),
        WIND: vector3(wind),
        WAVES: (0.0, 0.0, 0.0) if snapshot.sea is None else _waves(snapshot.sea),
    }
    return {path: Placement(position) for path, position in shown.items()}


def _waves(sea: Sea) -> Vector3:
    height = sea.spectrum.significant_height
    return height * math.cos(sea.direction), height * math.sin(sea.direction), sea.spectrum.peak_period
