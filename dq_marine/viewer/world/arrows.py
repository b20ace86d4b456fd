"""Arrows for what acts on the vehicle: the thrust of its actuators, and the current in the water around it.

Where a snapshot has the force of each actuator, each has an arrow, which begins where it is mounted; else one arrow
shows the net force, from the hull on.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from dq_marine.viewer.meshes import revolved
from dq_marine.viewer.placement import Y_AXIS, Placement, hidden_at, rotation_between, vector3
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import Look, Painted, painted_surface

THRUST = "/world/thrust"
NET_THRUST = f"{THRUST}/net"
CURRENT = "/world/current"

THRUST_RED = 0xFF4A3A
NET_LOOK = Look(foggy=False)
THRUST_LOOK = Look(opacity=0.9, lit=False, foggy=False, on_top=True)
"""Of an actuator's arrow: it is seen through the hull and the surface, which most actuators are behind."""

CURRENT_WHITE = 0xE8FBFF
CURRENT_LOOK = Look(opacity=0.7)

NET_THRUST_IN_LENGTHS = 0.9
"""Length of the net arrow at `Shape.max_force`, in vehicle lengths; it grows no longer."""

ONE_THRUST_IN_LENGTHS = 0.6
"""Length of an actuator's arrow at `Shape.max_thrust`, in vehicle lengths; it grows no longer."""

CURRENT_OF_ONE_LENGTH = 0.5
"""Speed of the water [m/s] whose arrow is as long as the vehicle."""

LONGEST_CURRENT_IN_LENGTHS = 2.0

FAINTEST = 0.01
"""An arrow shorter than this share of the vehicle's length is not drawn."""

CURRENT_PLACES = np.array([[1.5, 1.5, 1.0], [1.5, -1.5, 1.0], [-1.5, 1.5, 1.0], [-1.5, -1.5, 1.0]])
"""Middles of the current arrows as seen from the vehicle: north, east, down, in vehicle lengths.

They lie below the vehicle, so that none comes between it and the camera above it.
"""


CURRENT_PATHS = [f"{CURRENT}/{number}" for number in range(len(CURRENT_PLACES))]


class ForceScale(NamedTuple):
    """How forces become lengths.

    Attributes:
        newtons_per_metre: force over the length of its arrow [N/m].
        longest: no arrow is longer [m].
    """

    newtons_per_metre: float
    longest: float

    @classmethod
    def of(cls, largest: float, longest: float) -> ForceScale:
        """Return the scale by which the largest force [N] has the longest arrow [m]."""
        return cls(largest / longest, longest)


class Arrows:
    """Which arrows have been drawn, and where each is at a snapshot."""

    def __init__(self, shape: Shape) -> None:
        """Draw nothing yet, for a vehicle of a shape."""
        self._shape = shape
        self._drawn = 0
        largest = shape.max_force if shape.max_thrust is None else shape.max_thrust
        self._one = ForceScale.of(largest, ONE_THRUST_IN_LENGTHS * shape.length)
        self._net = ForceScale.of(shape.max_force, NET_THRUST_IN_LENGTHS * shape.length)

    def scenery(self) -> list[Message]:
        """The arrows that there always are, one unit long along y, to be turned and scaled by their placements."""
        net, water = self._net.newtons_per_metre, CURRENT_OF_ONE_LENGTH / self._shape.length
        return [
            _arrow(NET_THRUST, THRUST_RED, NET_LOOK, 0.04, tail=0.0, per_metre=net),
            *(
                _arrow(path, CURRENT_WHITE, CURRENT_LOOK, 0.03, tail=-0.5, per_metre=water)
                for path in CURRENT_PATHS
            ),
        ]

    def appear(self, snapshot: Snapshot) -> list[Message]:
        """Draw the arrows of actuators that no snapshot before had."""
        paths = [thrust_path(number) for number in range(self._drawn, len(snapshot.thrusts))]
        self._drawn += len(paths)
        scale = self._one.newtons_per_metre
        return [_arrow(path, THRUST_RED, THRUST_LOOK, 0.05, tail=0.0, per_metre=scale) for path in paths]

    def placements(self, snapshot: Snapshot, body_to_ned: FloatArray) -> dict[str, Placement]:
        """Where each arrow is, by path; those of forces begin where the force acts and point where it pushes.

        Args:
            snapshot: gives forces, current and position.
            body_to_ned: rotation matrix, shape (3, 3).
        """
        paths = [NET_THRUST, *map(thrust_path, range(self._drawn))]
        places = dict.fromkeys(paths, hidden_at(vector3(snapshot.position_ned)))
        if snapshot.thrusts:
            scale = self._one
            forces = [(thrust.position_body, thrust.force_body) for thrust in snapshot.thrusts]
            paths = paths[1:]
        else:
            scale = self._net
            force = snapshot.wrench_body[:3]
            forces = [(_on_the_hull(force, self._shape), force)]
        for path, (start, force) in zip(paths, forces, strict=False):
            start_ned = snapshot.position_ned + body_to_ned @ start
            places[path] = _force_placement(start_ned, body_to_ned @ force, scale, self._shape)
        return places | _current_placements(snapshot, self._shape)


def thrust_path(number: int) -> str:
    """Where the arrow of an actuator is drawn, by its place among `Snapshot.thrusts`."""
    return f"{THRUST}/{number}"


def _force_placement(
    start_ned: FloatArray, force_ned: FloatArray, scale: ForceScale, shape: Shape
) -> Placement:
    length = min(float(np.linalg.norm(force_ned)) / scale.newtons_per_metre, scale.longest)
    if length < FAINTEST * shape.length:
        return hidden_at(vector3(start_ned))
    return Placement(vector3(start_ned), rotation_between(Y_AXIS, vector3(force_ned)), length)


def _current_placements(snapshot: Snapshot, shape: Shape) -> dict[str, Placement]:
    """The arrows of the current around the vehicle, by path."""
    speed = float(np.linalg.norm(snapshot.current_ned))
    lengths = min(speed / CURRENT_OF_ONE_LENGTH, LONGEST_CURRENT_IN_LENGTHS)
    middles = map(vector3, snapshot.position_ned + shape.length * CURRENT_PLACES)
    if lengths < FAINTEST:
        return dict(zip(CURRENT_PATHS, map(hidden_at, middles), strict=True))
    turn = rotation_between(Y_AXIS, vector3(snapshot.current_ned))
    placements = (Placement(middle, turn, lengths * shape.length) for middle in middles)
    return dict(zip(CURRENT_PATHS, placements, strict=True))


def _arrow(path: str, color: int, look: Look, thickness: float, *, tail: float, per_metre: float) -> Message:
    """Draw an arrow of length 1 along y that starts at y = `tail`; the page's legend reads what a metre of it means."""
    shaft, head = 0.72, 0.28
    profile = [
        (0.0, tail),
        (thickness, tail),
        (thickness, tail + shaft),
        (2.6 * thickness, tail + shaft),
        (0.0, tail + shaft + head),
    ]
    arrow = [Painted(revolved(profile), color)]
    return set_object(path, painted_surface(path, arrow, look, {"per_metre": per_metre}))


def _on_the_hull(direction: FloatArray, shape: Shape) -> FloatArray:
    """Where a ray from the origin leaves the ellipsoid around the vehicle, in body axes [m]; the origin for no ray."""
    half_axes = np.array([shape.length, shape.width, shape.height]) / 2
    reach = math.hypot(*(direction / half_axes))
    return direction / reach if reach > 0.0 else np.zeros(3)
