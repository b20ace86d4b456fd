"""Solids as things to draw. Without limits are planes and pillars; they are drawn as far as one looks."""

from __future__ import annotations

from collections.abc import Sequence

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import quaternion_multiply, rotate
from dq_marine.algebra.vector3 import Vector3, add_scaled
from dq_marine.physics.contact.shapes import Ball, Box, Pillar, Plane, Rod
from dq_marine.physics.contact.solid import Solid
from dq_marine.task.things import Block, Column, Faces, Form, Relief, Sphere, Thing, Tube
from dq_marine.viewer.placement import rotation_between
from dq_marine.viewer.snapshot import FloatArray

SIGHT = 60.0
"""How far planes and pillars are drawn, over the vehicle's length."""

THICKNESS = 0.5
"""Of what is drawn of a plane that is no seabed, over the vehicle's length."""

UP: Vector3 = (0.0, 0.0, -1.0)


def things_of(solids: Sequence[Solid], length: float) -> tuple[Thing, ...]:
    """Return solids as things to draw, beside a vehicle of a length [m]; a shape of the user's own is not drawn.

    A `SolidChart` is drawn as the mesh that it is of.
    """
    return tuple(thing for solid in solids for thing in _seen(solid, SIGHT * length, THICKNESS * length))


def _seen(solid: Solid, sight: float, thickness: float) -> list[Thing]:
    turned = quaternion_from_euler(0.0, 0.0, solid.heading)
    match solid.shape:
        case Plane(numbers=normal) if normal == UP:
            return [_level(solid.position_ned, sight)]
        case Plane(numbers=normal):
            attitude = quaternion_multiply(turned, rotation_between((0.0, 0.0, 1.0), normal))
            behind = add_scaled(solid.position_ned, -0.5 * thickness, rotate(turned, normal))
            return [Thing(Block(2.0 * sight, 2.0 * sight, thickness), behind, attitude)]
        case Pillar(radius=radius):
            return [Thing(Column(radius, 2.0 * sight), solid.position_ned)]
        case shape:
            form = _form(shape)
            return [] if form is None else [Thing(form, solid.position_ned, turned)]


def _form(shape: object) -> Form | None:
    """Return the form of a limited shape; None of one that is not known."""
    match shape:
        case Ball(radius=radius):
            return Sphere(radius)
        case Box(size=size):
            return Block(*size)
        case Rod(end=end, radius=radius):
            return Tube(((0.0, 0.0, 0.0), end), radius)
    from dq_marine.charts.solid_chart import SolidChart  # here: it imports what reads and mends meshes

    return Faces(_corners(shape.triangles)) if isinstance(shape, SolidChart) else None


def _corners(triangles: FloatArray) -> tuple[tuple[Vector3, Vector3, Vector3], ...]:
    """Return an array of shape (n, 3, 3) as tuples."""
    return tuple(tuple(map(tuple, three)) for three in triangles.tolist())  # type: ignore[misc]


def _level(position: Vector3, sight: float) -> Thing:
    places, depth = (-sight, 0.0, sight), (0.0,) * 9
    return Thing(Relief(places, places, depth), position)
