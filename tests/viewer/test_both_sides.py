"""Above the surface there is sky, below it murk: by where the camera is, whatever the vehicle is at home in."""

from __future__ import annotations

import numpy as np
import pytest
from viewer.samples import AUV, snapshot

from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import Jonswap
from dq_marine.viewer import OffscreenViewer
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.world.water import ON_THE_SURFACE

pytestmark = pytest.mark.browser

SHIP = Shape(length=80.0, width=18.0, height=12.0, kind="ship", draft=5.0)
SKY = 255.0 * np.array(ON_THE_SURFACE.above)


def upper_edge(viewer: OffscreenViewer, moment, offset) -> np.ndarray:
    """The colour of the picture's upper edge: of what is behind all else there, as the camera looks down or level."""
    viewer.look_from(offset)
    return viewer.render(moment)[0].mean(axis=0)


@pytest.mark.parametrize("shape", [AUV, SHIP], ids=["auv", "ship"])
def test_the_sky_is_above_and_the_murk_below(shape: Shape) -> None:
    moment = snapshot(position_ned=[0.0, 0.0, 0.0])
    far = 2.0 * shape.length
    with OffscreenViewer(shape, 160, 120, caption=False) as viewer:
        viewer.render(moment)
        for _ in range(2):
            assert np.abs(upper_edge(viewer, moment, [far, 0.0, -0.3 * far]) - SKY).max() < 12.0
            red, green, blue = upper_edge(viewer, moment, [far, 0.0, 0.6 * far])
            assert red < 90.0, "the surface from below, not the sky, whose red is 125"
            assert red < green < blue


def test_the_surface_that_counts_is_the_wave_at_the_camera() -> None:
    sea = Sea(Jonswap(0.8, 4.0), direction=0.3, seed=2)
    place = np.array([2.5, 0.4])
    times = np.arange(0.0, 40.0, 0.1)
    heights = np.array([sea.elevation(time, *place) for time in times])
    with OffscreenViewer(AUV, 160, 120, caption=False) as viewer:
        for time, height in (
            (times[heights.argmax()], heights.max()),
            (times[heights.argmin()], heights.min()),
        ):
            moment = snapshot(time=float(time), position_ned=[0.0, 0.0, 0.0], sea=sea)
            viewer.render(moment)
            above = upper_edge(viewer, moment, [*place, -height - 0.05])
            below = upper_edge(viewer, moment, [*place, -height + 0.05])
            assert np.abs(below - above).max() > 30.0, "10 cm of the camera's height decide"
