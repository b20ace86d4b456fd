"""A vehicle to draw: its own mesh, or else its hull by kind and its thrusters one by one; its ghost at the goal."""

from __future__ import annotations

from collections.abc import Callable

from dq_marine.viewer.meshes import Mesh, sphere
from dq_marine.viewer.models import (
    catamaran_model,
    ellipsoid_model,
    open_frame_model,
    ship_model,
    torpedo_model,
)
from dq_marine.viewer.models.own_mesh import OwnMesh, own_mesh
from dq_marine.viewer.models.paint import tinted, tinted_colors
from dq_marine.viewer.models.thruster_model import thruster_model
from dq_marine.viewer.snapshot import Shape, ShapeKind
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import Look, Painted, painted_surface, surface

VEHICLE = "/world/vehicle"
GOAL_GHOST = "/world/goal/ghost"
GOAL_BALL = "/world/goal/ball"

SOLID = Look()
GLASS = Look(opacity=0.45, shininess=120.0)
GHOST = Look(opacity=0.35, foggy=False, yielding=True)
"""The murk of the water does not dim a far goal; a vehicle that has reached it is seen in its place."""

GHOST_GREEN = 0x5CFFA0
BALL_RADIUS_IN_LENGTHS = 0.3

HULLS: dict[ShapeKind, Callable[[Shape], dict[str, list[Painted]]]] = {
    "open_frame": open_frame_model.open_frame_parts,
    "torpedo": torpedo_model.torpedo_parts,
    "ellipsoid": ellipsoid_model.ellipsoid_parts,
    "catamaran": catamaran_model.catamaran_parts,
    "ship": ship_model.ship_parts,
}

THRUSTER_RADII: dict[ShapeKind, Callable[[Shape], float]] = {
    "open_frame": open_frame_model.thruster_radius,
    "torpedo": torpedo_model.thruster_radius,
    "ellipsoid": ellipsoid_model.thruster_radius,
    "catamaran": catamaran_model.thruster_radius,
    "ship": ship_model.thruster_radius,
}


def draw_vehicle(shape: Shape, path: str = VEHICLE, tint: int | None = None) -> list[Message]:
    """Draw a vehicle, part by part, in body axes; in shades of a tint, 0xRRGGBB, or in its own colours."""
    own = _own(shape)
    if own is not None:
        hull = f"{path}/hull"
        return [set_object(hull, surface(hull, own.mesh, tinted_colors(own.colors, tint), SOLID))]
    parts = {**_hull_parts(shape), **_thrusters(shape)}
    messages = [_draw(f"{path}/{name}", tinted(painted, tint), SOLID) for name, painted in parts.items()]
    if shape.kind == "open_frame":
        # Glass comes after what can be seen through it.
        messages.append(_draw(f"{path}/dome", open_frame_model.dome(shape), GLASS))
    return messages


def draw_goal(
    shape: Shape, ghost_path: str = GOAL_GHOST, ball_path: str = GOAL_BALL, color: int = GHOST_GREEN
) -> list[Message]:
    """Draw the hull as a ghost of one colour, and a ball of that colour for a goal without an attitude."""
    ghost = [Painted(mesh, color) for mesh in _hull_meshes(shape)]
    ball = [Painted(sphere(BALL_RADIUS_IN_LENGTHS * shape.length), color)]
    return [_draw(ghost_path, ghost, GHOST), _draw(ball_path, ball, GHOST)]


def _own(shape: Shape) -> OwnMesh | None:
    return None if shape.appearance is None else own_mesh(shape.appearance)


def _hull_meshes(shape: Shape) -> list[Mesh]:
    own = _own(shape)
    if own is not None:
        return [own.mesh]
    return [painted.mesh for part in _hull_parts(shape).values() for painted in part]


def _hull_parts(shape: Shape) -> dict[str, list[Painted]]:
    """The solid parts of a vehicle but its thrusters, by name, such as `frame`."""
    return HULLS[shape.kind](shape)


def _thrusters(shape: Shape) -> dict[str, list[Painted]]:
    """All thrusters of a vehicle, as `thrusters/0` and so on."""
    radius = THRUSTER_RADII[shape.kind](shape)
    return {
        f"thrusters/{number}": thruster_model(thruster, radius)
        for number, thruster in enumerate(shape.thrusters)
    }


def _draw(path: str, painted: list[Painted], look: Look) -> Message:
    return set_object(path, painted_surface(path, painted, look))
