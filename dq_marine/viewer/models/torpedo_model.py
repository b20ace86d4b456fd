"""A torpedo-shaped AUV, after the REMUS 100: a yellow body of revolution with fins fore and aft.

Everything is a fraction of the vehicle's length L and of its largest radius, in body axes
(x forward, y starboard, z down).
"""

from __future__ import annotations

import math

from dq_marine.viewer.meshes import Mesh, cylinder, plate, revolved
from dq_marine.viewer.models.paint import BOW_VIOLET, DARK, YELLOW
from dq_marine.viewer.placement import Y_TO_X, Placement
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.three_json import Painted

HULL, BOW = YELLOW, BOW_VIOLET

NOSE = 0.14
TAIL = 0.26
"""Lengths of the rounded nose and of the tapered tail, as fractions of L."""

TAIL_RADIUS = 0.25
"""Radius of the tail's end, as a fraction of the largest one."""

CURVE_STEPS = 12


def torpedo_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The parts of the vehicle without its thrusters, by name."""
    return {"hull": _hull(shape), "fins": _fins(shape), "heading_mark": _heading_mark(shape)}


def thruster_radius(shape: Shape) -> float:
    """Outer radius of a duct [m] in proportion to the hull."""
    return 0.6 * _radius(shape)


def _radius(shape: Shape) -> float:
    return min(shape.width, shape.height) / 2


def _hull(shape: Shape) -> list[Painted]:
    """Tail cone and cylindrical middle, with two dark bands where the sections join."""
    L, radius = shape.length, _radius(shape)
    shares = [step / CURVE_STEPS for step in range(CURVE_STEPS + 1)]
    bulges = [TAIL_RADIUS + (1 - TAIL_RADIUS) * math.sin(s * math.pi / 2) for s in shares]
    tail = [(b * radius, (s * TAIL - 0.5) * L) for b, s in zip(bulges, shares, strict=True)]
    stern = [(0.0, -0.5 * L), tail[0]]
    middle = [tail[-1], (radius, (0.5 - NOSE) * L)]
    band = cylinder(1.015 * radius, 0.012 * L)
    return [
        Painted(_along(revolved(stern), 0.0), DARK),
        Painted(_along(revolved([*tail, *middle[1:]], smooth=True), 0.0), HULL),
        Painted(_along(band, (TAIL - 0.5) * L), DARK),
        Painted(_along(band, 0.18 * L), DARK),
    ]


def _fins(shape: Shape) -> list[Painted]:
    """A cross of four fins at the tail and a smaller one behind the nose."""
    L, radius = shape.length, _radius(shape)
    chord, span = min(0.11 * L, 1.6 * radius), 1.9 * radius
    rear = _cross(_fin(chord, span, 0.08 * radius), (0.6 * TAIL - 0.5) * L)
    front = _cross(_fin(0.6 * chord, 0.8 * span, 0.08 * radius), (0.47 - NOSE) * L)
    return [Painted(fin, DARK) for fin in rear + front]


def _heading_mark(shape: Shape) -> list[Painted]:
    """The nose in violet, and a violet arrow along the back that points to it."""
    L, radius = shape.length, _radius(shape)
    angles = [step / CURVE_STEPS * math.pi / 2 for step in range(CURVE_STEPS + 1)]
    nose = [(radius * math.cos(angle), (0.5 - NOSE + NOSE * math.sin(angle)) * L) for angle in angles]
    tip, neck, rear = 0.16 * L, 0.16 * L - 1.2 * radius, -0.1 * L
    outline = [
        (tip, 0.0),
        (neck, 0.7 * radius),
        (neck, 0.25 * radius),
        (rear, 0.25 * radius),
        (rear, -0.25 * radius),
        (neck, -0.25 * radius),
        (neck, -0.7 * radius),
    ]
    arrow = plate(outline, 0.05 * radius).placed(Placement((0.0, 0.0, -1.04 * radius)))
    return [Painted(_along(revolved(nose, smooth=True), 0.0), BOW), Painted(arrow, BOW)]


def _fin(chord: float, span: float, thickness: float) -> Mesh:
    """One swept fin in the xy plane, out along +y from the axis, leading edge towards +x."""
    return plate([(0.0, 0.0), (chord, 0.0), (0.55 * chord, span), (0.0, span)], thickness)


def _cross(fin: Mesh, x: float) -> list[Mesh]:
    """Four copies of a fin at `x` [m], a quarter turn apart about the vehicle's axis."""
    half_turns = [quarter * math.pi / 4 for quarter in range(4)]
    turns = [(math.cos(half), math.sin(half), 0.0, 0.0) for half in half_turns]
    return [fin.placed(Placement((x, 0.0, 0.0), turn)) for turn in turns]


def _along(mesh: Mesh, x: float) -> Mesh:
    """A mesh that was built along y, laid along the vehicle and moved to `x` [m]."""
    return mesh.placed(Placement((x, 0.0, 0.0), Y_TO_X))
