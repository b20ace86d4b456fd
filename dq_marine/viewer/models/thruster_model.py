"""A thruster: a duct with a hub and blades, around the direction in which it pushes."""

from __future__ import annotations

import math

from dq_marine.viewer.meshes import Mesh, cuboid, joined, revolved
from dq_marine.viewer.placement import Y_AXIS, Placement, rotation_between, vector3
from dq_marine.viewer.snapshot import Thruster
from dq_marine.viewer.transport.three_json import Painted

DUCT = 0x23292F
HUB = 0x3A444C
BLADE = 0x37C5D8

BLADES = 3


def thruster_model(thruster: Thruster, radius: float) -> list[Painted]:
    """One thruster in body axes.

    Args:
        thruster: where it sits and which way it pushes.
        radius: outer radius of the duct [m].
    """
    direction = vector3(thruster.direction)
    place = Placement(vector3(thruster.position), rotation_between(Y_AXIS, direction))
    parts = {DUCT: _duct(radius), HUB: _hub(radius), BLADE: _blades(radius)}
    return [Painted(mesh.placed(place), color) for color, mesh in parts.items()]


def _duct(radius: float) -> Mesh:
    """A ring around y whose front lip is rounder and wider than its rear."""
    profile = [
        (0.86, -0.45),
        (0.92, -0.45),
        (1.00, 0.30),
        (0.94, 0.45),
        (0.86, 0.25),
        (0.86, -0.45),
    ]
    return revolved([(radius * away, radius * along) for away, along in profile])


def _hub(radius: float) -> Mesh:
    """The motor on the axis, rounded in front."""
    profile = [(0.0, -0.50), (0.28, -0.50), (0.28, 0.40), (0.18, 0.58), (0.0, 0.64)]
    return revolved([(radius * away, radius * along) for away, along in profile])


def _blades(radius: float) -> Mesh:
    """Blades across the axis, each twisted like a propeller's."""
    pitch = Placement(quaternion=(math.cos(0.3), math.sin(0.3), 0.0, 0.0))
    outwards = Placement((0.55 * radius, 0.15 * radius, 0.0))
    blade = cuboid(0.6 * radius, 0.06 * radius, 0.34 * radius).placed(pitch).placed(outwards)
    half_turns = [math.pi * number / BLADES for number in range(BLADES)]
    turns = [(math.cos(half), 0.0, math.sin(half), 0.0) for half in half_turns]
    return joined([blade.placed(Placement(quaternion=turn)) for turn in turns])
