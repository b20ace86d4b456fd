"""A ship: a red bottom and a dark hull with a raised bow, a white bridge, a funnel, a violet mark ahead.

Everything follows from length L, width W, height H from keel to deck and draft T, in body axes (x forward, y starboard,
z down) with the still waterline at z = 0.
"""

from __future__ import annotations

from dq_marine.viewer.meshes import Mesh, cuboid, cylinder, plate
from dq_marine.viewer.models.hull_mesh import Level, lofted
from dq_marine.viewer.models.paint import BOW_VIOLET
from dq_marine.viewer.placement import Y_AXIS, Placement, rotation_between, vector3
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.three_json import Painted

BOTTOM = 0x9E2F27
HULL = 0x1F3A5F
DECK = 0x58775F
HOUSE = 0xF1F3F4
WINDOWS = 0x18222C
BOW = BOW_VIOLET

LARGE = 120.0
"""Length [m] from which the bridge stands aft, as on tankers, instead of forward, as on supply ships."""


def ship_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The parts of the vessel without its thrusters, by name."""
    return {
        "hull": [*_hull(shape), *_struts(shape)],
        "deck": _deck(shape),
        "bridge": _bridge(shape),
        "heading_mark": _heading_mark(shape),
    }


def thruster_radius(shape: Shape) -> float:
    """Outer radius of a duct [m] in proportion to the hull."""
    return 0.3 * shape.keel


def _hull(shape: Shape) -> list[Painted]:
    """Below the waterline, and from there to the deck."""
    L, half, T, deck = shape.length, 0.5 * shape.width, shape.keel, shape.keel - shape.height
    line = Level(0.0, -0.5 * L, 0.47 * L, half)
    below = [
        Level(T, -0.36 * L, 0.42 * L, 0.75 * half),
        Level(0.8 * T, -0.41 * L, 0.45 * L, 0.95 * half),
        Level(0.2 * T, -0.48 * L, 0.46 * L, half),
        line,
    ]
    above = [line, _edge(shape, deck)]
    return [Painted(lofted(below), BOTTOM), Painted(lofted(above), HULL)]


def _edge(shape: Shape, z: float) -> Level:
    """The deck's edge, at a depth [m]."""
    L = shape.length
    return Level(z, -0.5 * L, 0.5 * L, 0.5 * shape.width, 0.62, 0.35 * shape.height)


def _deck(shape: Shape) -> list[Painted]:
    """A thin green layer within the rail."""
    L, z = shape.length, shape.keel - 1.005 * shape.height
    lower, upper = (
        Level(height, -0.49 * L, 0.48 * L, 0.46 * shape.width, 0.62, 0.33 * shape.height)
        for height in (z, z - 0.01 * shape.height)
    )
    return [Painted(lofted([lower, upper]), DECK)]


def _bridge(shape: Shape) -> list[Painted]:
    """A house of three storeys with windows around the upper one, a mast and a funnel."""
    L, W, H = shape.length, shape.width, shape.height
    aft = L > LARGE
    x, length = (-0.38 * L, 0.09 * L) if aft else (0.24 * L, 0.15 * L)
    storey = 0.3 * H
    deck = shape.keel - H
    house = [
        (length, 0.84 * W, 1.6 * storey, 0.8 * storey, HOUSE),
        (0.8 * length, 0.74 * W, storey, 2.1 * storey, HOUSE),
        (0.81 * length, 0.745 * W, 0.35 * storey, 2.2 * storey, WINDOWS),
        (0.7 * length, 0.86 * W, 0.15 * storey, 2.67 * storey, HOUSE),
    ]
    parts = [Painted(_at(cuboid(a, b, c), x, 0.0, deck - up), color) for a, b, c, up, color in house]
    mast = _upright(0.012 * W, 2.0 * storey, x, 0.0, deck - 3.6 * storey)
    funnel = _upright(0.07 * W, 1.6 * storey, x - 0.42 * length, 0.28 * W, deck - 2.2 * storey)
    return [*parts, Painted(mast, WINDOWS), Painted(funnel, BOTTOM)]


def _struts(shape: Shape) -> list[Painted]:
    """From each thruster up to the waterline; those of tunnels are within the hull."""
    struts = []
    for thruster in shape.thrusters:
        x, y, z = vector3(thruster.position)
        if z > 0.0:
            struts.append(Painted(_upright(0.1 * shape.keel, z, x, y, 0.5 * z), BOTTOM))
    return struts


def _heading_mark(shape: Shape) -> list[Painted]:
    """A violet arrow on the open deck that points to the bow."""
    L, W = shape.length, shape.width
    x = 0.1 * L if L > LARGE else -0.17 * L
    tip, wide = min(0.16 * L, 0.8 * W), 0.22 * W
    outline = [(tip, 0.0), (0.0, wide), (0.0, 0.4 * wide), (-tip, 0.4 * wide)]
    outline += [(a, -b) for a, b in reversed(outline[1:])]
    arrow = plate(outline, 0.02 * shape.height)
    return [Painted(_at(arrow, x, 0.0, shape.keel - 1.03 * shape.height), BOW)]


def _upright(radius: float, height: float, x: float, y: float, z: float) -> Mesh:
    """A standing cylinder."""
    return cylinder(radius, height).placed(Placement((x, y, z), rotation_between(Y_AXIS, (0.0, 0.0, -1.0))))


def _at(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    return mesh.placed(Placement((x, y, z)))
