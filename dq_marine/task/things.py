"""What surrounds a vehicle, for drawing only: things of a fixed form, each at a place, and the beams that see them.

A task says by `scenery(parameters, memory)` which things there are now, and by `beams(parameters, memory)` what its
beams show the agent; what it computes with is its own affair.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.vector3 import Vector3

LEVEL: Quaternion = (1.0, 0.0, 0.0, 0.0)


class Column(NamedTuple):
    """A standing cylinder about its middle: radius and height [m]."""

    radius: float
    height: float


class Cage(NamedTuple):
    """A standing cylinder of net about its middle, with a floating collar at its top: radius and height [m]."""

    radius: float
    height: float


class ShipHull(NamedTuple):
    """Another vessel, its bow ahead, its waterline at its origin: length and width [m]."""

    length: float
    width: float


class TorpedoHull(NamedTuple):
    """Another vehicle under water, its bow ahead, about its middle: length and width [m]."""

    length: float
    width: float


class Cone(NamedTuple):
    """A funnel, open at both ends: its throat at the origin, its mouth astern of it; radii and length [m]."""

    throat: float
    mouth: float
    length: float


class Block(NamedTuple):
    """A wall, as a box about its middle: sizes along x, y and z [m]."""

    along_x: float
    along_y: float
    along_z: float


class Line(NamedTuple):
    """What is to be followed, through points [m], at least two; and how thick it is drawn, as a radius [m]."""

    points: tuple[Vector3, ...]
    radius: float


class Tube(NamedTuple):
    """A round pipe through points [m], at least two; its radius [m]."""

    points: tuple[Vector3, ...]
    radius: float


class Sphere(NamedTuple):
    """A ball about its middle: radius [m]."""

    radius: float


class Faces(NamedTuple):
    """A surface of triangles: corners of each, anticlockwise seen from outside [m]."""

    triangles: tuple[tuple[Vector3, Vector3, Vector3], ...]


class Relief(NamedTuple):
    """A seabed: depths [m] over a grid of places [m], row by row from the south and each from the west."""

    norths: tuple[float, ...]
    easts: tuple[float, ...]
    depths: tuple[float, ...]


Form = Column | Cage | ShipHull | TorpedoHull | Cone | Block | Line | Tube | Sphere | Faces | Relief


class Thing(NamedTuple):
    """A form at a place: its origin in NED [m], its attitude to NED (w, x, y, z).

    Forms with ahead and astern have x ahead, y to starboard, z down. Equal forms are drawn once, wherever they go.
    """

    form: Form
    position_ned: Vector3 = (0.0, 0.0, 0.0)
    attitude: Quaternion = LEVEL


class Beam(NamedTuple):
    """A beam of a range sensor, and what it tells.

    Attributes:
        direction_body: unit vector in body axes.
        distance: that it tells [m]; its reach where no echo came back.
        reach: the largest distance that it can tell [m].
        origin_body: where it begins in body axes [m].
    """

    direction_body: Vector3
    distance: float
    reach: float
    origin_body: Vector3 = (0.0, 0.0, 0.0)
