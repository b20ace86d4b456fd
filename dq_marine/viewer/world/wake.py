"""The wake of a vessel that floats: lines of foam on the surface where it came from.

Python draws a mesh of three bands that are still folded up; the page lays them along the recent track at every picture
(`transport/page/wake.js`), so that replays have them, too.
"""

from __future__ import annotations

import numpy as np

from dq_marine.viewer.meshes import Mesh, grid_triangles
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import Look, rgb, surface
from dq_marine.viewer.world.water import surroundings_of

WAKE = "/world/wake"
WAKE_LOOK = Look(opacity=0.5, lit=False, both_sides=True)
FOAM = 0xF4FBFF

STATIONS = 48
"""Along each band."""

BANDS = 3
"""One behind the vessel, and one to each side, which spread."""


def draw_wake(shape: Shape) -> list[Message]:
    """The bands, of no extent yet, of a vessel that floats; none of a vehicle under water.

    The page reads the size of the hull, and into which colour of the sea the foam fades.
    """
    if not shape.floats:
        return []
    count = 2 * STATIONS
    triangles = [grid_triangles(STATIONS, 2) + band * count for band in range(BANDS)]
    vertices = np.zeros((BANDS * count, 3))
    mesh = Mesh(vertices, np.tile([0.0, 0.0, -1.0], (len(vertices), 1)), np.vstack(triangles))
    data = {
        "length": shape.length,
        "width": shape.width,
        "stations": STATIONS,
        "foam": rgb(FOAM).tolist(),
        "sea": rgb(surroundings_of(shape).surface).tolist(),
    }
    colors = np.tile(rgb(FOAM), (len(vertices), 1))
    return [set_object(WAKE, surface(WAKE, mesh, colors, WAKE_LOOK, data))]
