"""A small catamaran, after the Otter: two light pontoons, a dark deck between them, a box and a mast on it.

Everything follows from length L, width W, height H from keel to deck and draft T, in body axes (x forward, y starboard,
z down) with the still waterline at z = 0.
"""

from __future__ import annotations

from dq_marine.viewer.meshes import Mesh, cuboid, cylinder, plate, sphere
from dq_marine.viewer.models.hull_mesh import Level, lofted
from dq_marine.viewer.models.paint import BOW_VIOLET, DARK, LAMP
from dq_marine.viewer.placement import Y_AXIS, Placement, rotation_between
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.three_json import Painted

PONTOON, BOX = 0xF6C516, 0xE9EDEF
DECK, BOW = DARK, BOW_VIOLET

SIDES = (-1, 1)
PONTOON_WIDTH = 0.25
"""Of one, over W."""


def catamaran_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The parts of the vessel without its thrusters, by name."""
    return {
        "pontoons": _pontoons(shape),
        "deck": _deck(shape),
        "mast": _mast(shape),
        "heading_mark": _heading_mark(shape),
    }


def thruster_radius(shape: Shape) -> float:
    """Outer radius of a duct [m] in proportion to the hull."""
    return 0.4 * shape.keel


def _pontoons(shape: Shape) -> list[Painted]:
    L, T, half = shape.length, shape.keel, 0.5 * PONTOON_WIDTH * shape.width
    rim = T - 0.72 * shape.height
    pontoon = lofted(
        [
            Level(T, -0.42 * L, 0.38 * L, 0.4 * half, 0.5),
            Level(0.5 * T, -0.47 * L, 0.45 * L, 0.9 * half, 0.5),
            Level(rim, -0.5 * L, 0.5 * L, half, 0.55, 0.1 * shape.height),
        ]
    )
    away = 0.5 * shape.width - half
    return [Painted(_at(pontoon, 0.0, side * away, 0.0), PONTOON) for side in SIDES]


def _deck(shape: Shape) -> list[Painted]:
    """A platform on two beams, and the box with the electronics."""
    L, W, H = shape.length, shape.width, shape.height
    top = shape.keel - H
    beams = [_at(cuboid(0.06 * L, 0.9 * W, 0.12 * H), x * L, 0.0, top + 0.22 * H) for x in (-0.25, 0.22)]
    platform = _at(cuboid(0.62 * L, 0.62 * W, 0.12 * H), 0.0, 0.0, top + 0.12 * H)
    box = _at(cuboid(0.3 * L, 0.36 * W, 0.35 * H), -0.1 * L, 0.0, top - 0.1 * H)
    return [*(Painted(part, DECK) for part in (*beams, platform)), Painted(box, BOX)]


def _mast(shape: Shape) -> list[Painted]:
    L, H = shape.length, shape.height
    top = shape.keel - H
    pole = cylinder(0.012 * L, 0.9 * H).placed(
        Placement((-0.16 * L, 0.0, top - 0.7 * H), rotation_between(Y_AXIS, (0.0, 0.0, -1.0)))
    )
    return [Painted(pole, DECK), Painted(_at(sphere(0.025 * L), -0.16 * L, 0.0, top - 1.17 * H), LAMP)]


def _heading_mark(shape: Shape) -> list[Painted]:
    """A violet arrow on the platform that points to the bow, and a violet bar across it."""
    L, W, H = shape.length, shape.width, shape.height
    top = shape.keel - H
    outline = [(0.29 * L, 0.0), (0.12 * L, 0.14 * W), (0.12 * L, -0.14 * W)]
    arrow = _at(plate(outline, 0.03 * H), 0.0, 0.0, top + 0.04 * H)
    bar = _at(cuboid(0.03 * L, 0.62 * W, 0.1 * H), 0.32 * L, 0.0, top + 0.12 * H)
    return [Painted(arrow, BOW), Painted(bar, BOW)]


def _at(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    return mesh.placed(Placement((x, y, z)))
