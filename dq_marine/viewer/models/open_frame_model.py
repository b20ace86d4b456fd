"""An open-frame ROV, after the BlueROV2: dark side frames, blue floats, a glass-domed tube.

Everything is a fraction of the vehicle's length L, width W and height H, in body axes
(x forward, y starboard, z down), so that it fits any ROV.
"""

from __future__ import annotations

from dq_marine.viewer.meshes import Mesh, cuboid, cylinder, plate, rounded_block, sphere
from dq_marine.viewer.models.paint import BOW_VIOLET, DARK, LAMP
from dq_marine.viewer.placement import Y_TO_X, Placement
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.three_json import Painted

FRAME, BOW = DARK, BOW_VIOLET
FLOAT = 0x1F78E0
TUBE = 0xD5DEE4
FLANGE = 0x4A555E
LENS = 0x0A0D10
GLASS = 0xBFE9FF

SIDES = (-1, 1)


def open_frame_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The solid parts of the vehicle without its thrusters, by name."""
    return {
        "frame": _frame(shape),
        "floats": _floats(shape),
        "tubes": _tubes(shape),
        "heading_mark": _heading_mark(shape),
    }


def dome(shape: Shape) -> list[Painted]:
    """The glass dome at the bow end of the electronics tube."""
    return [Painted(_at(sphere(_tube_radius(shape)), 0.31 * shape.length, 0.0, 0.0), GLASS)]


def thruster_radius(shape: Shape) -> float:
    """Outer radius of a duct [m] in proportion to the frame."""
    return 0.11 * min(shape.length, shape.width, 2 * shape.height)


def _frame(shape: Shape) -> list[Painted]:
    """Two side panels with openings, their skids, and the bars between them."""
    L, W, H = shape.length, shape.width, shape.height
    thick = 0.04 * W
    bars = []
    for side in SIDES:
        y = side * (W - thick) / 2
        bars.append(_at(cuboid(0.96 * L, thick, 0.15 * H), 0.0, y, -0.30 * H))
        bars.append(_at(cuboid(1.00 * L, thick, 0.13 * H), 0.0, y, 0.435 * H))
        bars.append(_at(cuboid(1.00 * L, 2.2 * thick, 0.06 * H), 0.0, y, 0.48 * H))
        uprights = (-0.42 * L, 0.0, 0.42 * L)
        bars += [_at(cuboid(0.09 * L, thick, 0.75 * H), x, y, 0.07 * H) for x in uprights]
    for x in (-0.38 * L, 0.38 * L):
        bars += [_at(cuboid(0.05 * L, W, 0.06 * H), x, 0.0, z * H) for z in (-0.27, 0.44)]
    return [Painted(bar, FRAME) for bar in bars]


def _floats(shape: Shape) -> list[Painted]:
    """Two blocks of foam under blue covers, with a gap between them."""
    L, W, H = shape.length, shape.width, shape.height
    block = rounded_block(0.90 * L, 0.43 * W, 0.30 * H, roundness=0.35)
    return [Painted(_at(block, 0.0, side * 0.235 * W, -0.35 * H), FLOAT) for side in SIDES]


def _tubes(shape: Shape) -> list[Painted]:
    """The electronics tube with its camera, the battery tube below it, and two lamps."""
    L, W, H = shape.length, shape.width, shape.height
    radius = _tube_radius(shape)
    flange = cylinder(1.12 * radius, 0.04 * L)
    parts = [
        Painted(_along(cylinder(radius, 0.62 * L), 0.0, 0.0, 0.0), TUBE),
        Painted(_along(flange, -0.31 * L, 0.0, 0.0), FLANGE),
        Painted(_along(flange, 0.30 * L, 0.0, 0.0), FLANGE),
        Painted(_along(cylinder(0.4 * radius, radius), 0.31 * L, 0.0, 0.0), LENS),
        Painted(_along(cylinder(0.65 * radius, 0.5 * L), 0.0, 0.0, 0.32 * H), FLANGE),
    ]
    for side in SIDES:
        x, y, z = 0.46 * L, side * 0.25 * W, 0.28 * H
        parts.append(Painted(_along(cylinder(0.045 * W, 0.08 * L), x, y, z), FRAME))
        parts.append(Painted(_at(sphere(0.042 * W), x + 0.04 * L, y, z), LAMP))
    return parts


def _heading_mark(shape: Shape) -> list[Painted]:
    """A violet arrow on top that points to the bow, and a violet bar across the bow."""
    L, W, H = shape.length, shape.width, shape.height
    outline = [
        (0.40 * L, 0.0),
        (0.12 * L, 0.20 * W),
        (0.12 * L, 0.08 * W),
        (-0.25 * L, 0.08 * W),
        (-0.25 * L, -0.08 * W),
        (0.12 * L, -0.08 * W),
        (0.12 * L, -0.20 * W),
    ]
    arrow = _at(plate(outline, 0.03 * H), 0.0, 0.0, -0.52 * H)
    bar = _at(cuboid(0.04 * L, 0.9 * W, 0.07 * H), 0.46 * L, 0.0, -0.27 * H)
    return [Painted(arrow, BOW), Painted(bar, BOW)]


def _tube_radius(shape: Shape) -> float:
    return min(0.23 * shape.height, 0.2 * shape.width, 0.15 * shape.length)


def _at(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    """A mesh moved to (x, y, z) [m] in body axes."""
    return mesh.placed(Placement((x, y, z)))


def _along(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    """A mesh that was built along y, laid along the vehicle and moved to (x, y, z) [m]."""
    return mesh.placed(Placement((x, y, z), Y_TO_X))
