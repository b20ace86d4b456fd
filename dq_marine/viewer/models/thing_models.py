"""Things around a vehicle to draw: pillars, other vessels, docks, quays, pipes and lines, seabeds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dq_marine.task.things import (
    Block,
    Cage,
    Column,
    Cone,
    Faces,
    Form,
    Line,
    Relief,
    ShipHull,
    Sphere,
    TorpedoHull,
    Tube,
)
from dq_marine.viewer.meshes import Mesh, cuboid, cylinder, grid_triangles, joined, revolved, sphere
from dq_marine.viewer.models.paint import SIGNAL_ORANGE
from dq_marine.viewer.models.ship_model import HULL, ship_parts
from dq_marine.viewer.models.torpedo_model import HULL as TORPEDO_HULL
from dq_marine.viewer.models.torpedo_model import torpedo_parts
from dq_marine.viewer.placement import Y_AXIS, Y_TO_X, Placement, rotation_between
from dq_marine.viewer.snapshot import FloatArray, Shape
from dq_marine.viewer.transport.three_json import Look, Painted

RUST = 0xA4553A
BAND = 0xF1F3F4
GREY = 0x5E6A75
FUNNEL = 0xE8ECEF
CONCRETE = 0xB4B2AA
NET = 0x3F5A4C
PIPE = 0xE0A100
SAND = 0xA99A78
ROUTE = 0x5CFFA0

SOLID = Look()
HOLLOW = Look(both_sides=True)
FAINT = Look(opacity=0.6, lit=False)
DULL = Look(shininess=0.0)  # from above only: what casts shadows by both sides darkens itself in stripes

UPRIGHT = rotation_between(Y_AXIS, (0.0, 0.0, -1.0))

BAND_HEIGHT = 1.0
"""Of the light band round the middle of a column, over its radius."""

RIM = 0.04
"""Of the orange rim of a funnel's mouth, over its radius."""

DRAFT, HEIGHT = 0.045, 0.14
"""Of another vessel, from keel to deck, over its length."""

TUBE_SECTORS = 8

CAGE_ROPES, CAGE_RINGS = 24, 2.0
"""Of a net that is drawn: ropes down, and rings over each length of the radius."""

CAGE_ROPE, CAGE_COLLAR = 0.008, 0.04
"""Their radii, and that of the collar that floats, over the radius of the cage."""


def thing_model(form: Form) -> tuple[list[Painted], Look]:
    """Return the surfaces of a form about its origin, and how they look."""
    match form:
        case Column():
            return _column(form), SOLID
        case Cage():
            return _cage(form), HOLLOW
        case ShipHull():
            return _ship(form), SOLID
        case TorpedoHull():
            return _torpedo(form), SOLID
        case Cone():
            return _cone(form), HOLLOW
        case Block():
            return [Painted(cuboid(form.along_x, form.along_y, form.along_z), CONCRETE)], SOLID
        case Line():
            return [Painted(tube(np.array(form.points), form.radius), ROUTE)], FAINT
        case Tube():
            return [Painted(tube(np.array(form.points), form.radius), PIPE)], SOLID
        case Sphere():
            return [Painted(sphere(form.radius), GREY)], SOLID
        case Faces():
            return [Painted(_faces(form), RUST)], HOLLOW
        case Relief():
            return [Painted(_relief(form), SAND)], DULL


def _column(form: Column) -> list[Painted]:
    upright = Placement(quaternion=UPRIGHT)
    band = cylinder(1.02 * form.radius, min(BAND_HEIGHT * form.radius, form.height))
    return [
        Painted(cylinder(form.radius, form.height).placed(upright), RUST),
        Painted(band.placed(upright), BAND),
    ]


def _cage(form: Cage) -> list[Painted]:
    angles = np.linspace(0.0, 2.0 * np.pi, 4 * CAGE_ROPES + 1)
    circle = form.radius * np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    top, bottom = -0.5 * form.height, 0.5 * form.height
    rope = CAGE_ROPE * form.radius
    levels = np.linspace(top, bottom, 1 + max(2, round(form.height / form.radius * CAGE_RINGS)))
    rings = [tube(circle + np.array([0.0, 0.0, level]), rope) for level in levels[1:]]
    ropes = [tube(np.array([[x, y, top], [x, y, bottom]]), rope) for x, y, _ in circle[:-1:4]]
    collar = tube(circle + np.array([0.0, 0.0, top]), CAGE_COLLAR * form.radius)
    return [Painted(joined([*rings, *ropes]), NET), Painted(collar, BAND)]


def _ship(form: ShipHull) -> list[Painted]:
    height, draft = HEIGHT * form.length, DRAFT * form.length
    shape = Shape(form.length, form.width, height, kind="ship", draft=draft)
    parts = [painted for part in ship_parts(shape).values() for painted in part]
    return [replace(one, color=GREY) if one.color == HULL else one for one in parts]


def _torpedo(form: TorpedoHull) -> list[Painted]:
    shape = Shape(form.length, form.width, form.width, kind="torpedo")
    parts = [painted for part in torpedo_parts(shape).values() for painted in part]
    return [replace(one, color=GREY) if one.color == TORPEDO_HULL else one for one in parts]


def _cone(form: Cone) -> list[Painted]:
    wall = revolved([(form.mouth, -form.length), (form.throat, 0.0)])
    rim = revolved([(form.mouth, -form.length), ((1.0 + RIM) * form.mouth, -form.length - RIM * form.mouth)])
    ring = revolved([(form.throat, 0.0), (form.throat, 0.5 * form.throat)])
    along = Placement(quaternion=Y_TO_X)
    return [
        Painted(wall.placed(along), FUNNEL),
        Painted(rim.placed(along), SIGNAL_ORANGE),
        Painted(ring.placed(along), SIGNAL_ORANGE),
    ]


def tube(points: FloatArray, radius: float) -> Mesh:
    """Return the surface of a round tube through points, shape (n, 3) [m], open at its ends."""
    along = np.gradient(points, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    beside = np.cross(along, [0.0, 0.0, 1.0])
    steep = np.linalg.norm(beside, axis=1) < 1e-6
    beside[steep] = [1.0, 0.0, 0.0]
    beside /= np.linalg.norm(beside, axis=1, keepdims=True)
    upward = np.cross(along, beside)
    angles = np.linspace(0.0, 2.0 * np.pi, TUBE_SECTORS + 1)[:, None]
    outward = np.cos(angles) * beside[:, None, :] + np.sin(angles) * upward[:, None, :]
    vertices = points[:, None, :] + radius * outward
    triangles = grid_triangles(len(points), TUBE_SECTORS + 1)
    return Mesh(vertices.reshape(-1, 3), outward.reshape(-1, 3), triangles)


def _faces(form: Faces) -> Mesh:
    corners = np.array(form.triangles).reshape(-1, 3, 3)
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-300)
    numbers = np.arange(3 * len(corners)).reshape(-1, 3)
    return Mesh(corners.reshape(-1, 3), np.repeat(facing, 3, axis=0), numbers)


def _relief(form: Relief) -> Mesh:
    norths, easts = np.array(form.norths), np.array(form.easts)
    depths = np.array(form.depths).reshape(len(norths), len(easts))
    slope_north, slope_east = np.gradient(depths, norths, easts)
    up = np.stack([slope_north, slope_east, -np.ones_like(depths)], axis=-1)
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    places = np.stack([*np.meshgrid(norths, easts, indexing="ij"), depths], axis=-1)
    # Rows go north and columns east, so that the cells' corners run anticlockwise seen from above, where z is down.
    return Mesh(places.reshape(-1, 3), up.reshape(-1, 3), grid_triangles(len(norths), len(easts)))
