"""Draw a ship, an ROV and an AUV from above and from below the water: `python docs/site/draw_views.py`.

It needs the extra `render` and a Chromium.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.envs.core.view import shape_of
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import Jonswap
from dq_marine.vehicles import load_vehicle
from dq_marine.viewer.offscreen import OffscreenViewer
from dq_marine.viewer.snapshot import Snapshot

FOLDER = Path(__file__).parents[1] / "images"
WIDTH, HEIGHT = 640, 480

TIME = 20.0
"""Into the sea [s]."""


class View(NamedTuple):
    """One picture.

    Attributes:
        name: of its file, without the ending.
        vehicle: of the catalogue.
        depth: of its origin below the surface where it is [m].
        camera: from the vehicle, in its lengths: north, east and down.
        height: significant, of the sea [m].
        period: of the sea's peak [s].
    """

    name: str
    vehicle: str
    depth: float
    camera: tuple[float, float, float]
    height: float
    period: float


VIEWS = (
    View("ship_above", "supply_vessel", 0.0, (-1.1, 1.2, -0.55), 3.0, 9.0),
    View("ship_below", "supply_vessel", 0.0, (1.1, 1.1, 0.45), 3.0, 9.0),
    View("rov_above", "bluerov2_heavy", 0.05, (-1.8, 2.0, -0.9), 0.1, 2.0),
    View("rov_below", "bluerov2_heavy", 1.2, (-1.8, 2.0, 0.6), 0.1, 2.0),
    View("auv_above", "remus100", 0.05, (-1.1, 1.4, -0.6), 0.15, 2.5),
    View("auv_below", "remus100", 2.0, (-1.1, 1.4, 0.5), 0.15, 2.5),
)


def main(folder: Path = FOLDER) -> None:
    """Draw all views."""
    for view in VIEWS:
        Image.fromarray(drawn(view)).save(folder / f"{view.name}.png", optimize=True)


def drawn(view: View) -> np.ndarray:
    """Return a picture, shape (height, width, 3)."""
    vehicle = load_vehicle(view.vehicle)
    sea = Sea(Jonswap(view.height, view.period), direction=0.6, seed=4)
    surface = float(sea.elevation(TIME, 0.0, 0.0))
    moment = Snapshot(
        time=TIME,
        position_ned=np.array([0.0, 0.0, view.depth - surface]),
        quaternion_body_to_ned=np.array(quaternion_from_euler(0.02, 0.03, 0.5)),
        wrench_body=np.zeros(6),
        current_ned=np.zeros(3),
        sea=sea,
    )
    with OffscreenViewer(shape_of(vehicle), WIDTH, HEIGHT, caption=False, smooth=True) as viewer:
        viewer.render(moment)
        viewer.look_from(vehicle.dimensions.length * np.array(view.camera))
        return viewer.render(moment)


if __name__ == "__main__":
    main()
