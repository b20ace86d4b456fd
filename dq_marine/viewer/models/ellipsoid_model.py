"""An ellipsoid: a smooth hull with a dark belt that shows roll, a violet nose and an arrow on its back.

Everything is a fraction of the vehicle's length L, width W and height H, in body axes (x forward, y starboard, z down).
"""

from __future__ import annotations

from dq_marine.viewer.meshes import plate, rounded_block
from dq_marine.viewer.models.paint import BOW_VIOLET, DARK, YELLOW
from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.three_json import Painted

HULL, BOW = YELLOW, BOW_VIOLET

ELLIPSOID = 1.0
"""Roundness of a superellipsoid that is an ellipsoid."""


def ellipsoid_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The parts of the vehicle without its thrusters, by name."""
    L, W, H = shape.length, shape.width, shape.height
    hull = rounded_block(L, W, H, ELLIPSOID)
    belt = rounded_block(1.01 * L, 1.02 * W, 0.04 * H, ELLIPSOID)
    return {
        "hull": [Painted(hull, HULL), Painted(belt, DARK)],
        "heading_mark": _heading_mark(shape),
    }


def thruster_radius(shape: Shape) -> float:
    """Outer radius of a duct [m] in proportion to the hull."""
    return 0.15 * min(shape.length, shape.width, shape.height)


def _heading_mark(shape: Shape) -> list[Painted]:
    """A nose that stands out of the bow, and an arrow above the back that points to it."""
    L, W, H = shape.length, shape.width, shape.height
    nose = rounded_block(0.3 * L, 0.5 * W, 0.5 * H, ELLIPSOID).placed(Placement((0.38 * L, 0.0, 0.0)))
    outline = [(0.2 * L, 0.0), (-0.15 * L, 0.15 * W), (-0.15 * L, -0.15 * W)]
    arrow = plate(outline, 0.02 * H).placed(Placement((0.0, 0.0, -0.51 * H)))
    return [Painted(nose, BOW), Painted(arrow, BOW)]
