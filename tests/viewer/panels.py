"""A live page with a panel, and the page in a browser."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import Group

CAMERA_PLACED = "viewer.camera.matrixWorld.elements[0] !== 0"
"""In a page. Before its scene has placed it, the camera looks along an axis."""


@contextmanager
def live_panel(groups: Sequence[Group]) -> Iterator[LiveViewer]:
    """An ROV at 1 s, with groups of controls."""
    with LiveViewer(ROV, title="An ROV") as shown:
        shown.draw(snapshot(time=1.0))
        shown.show_controls(groups)
        yield shown


@contextmanager
def panel_page(viewer: LiveViewer, groups: Sequence[Group]) -> Iterator[Page]:
    """Its page, once it has the groups and the vehicle."""
    with open_page(viewer.url, width=1000, height=700) as shown:
        shown.wait_until(f"document.querySelectorAll('#panel-controls details').length === {len(groups)}")
        shown.wait_until("viewer.scene_tree.find(['world', 'vehicle']).object.children.length > 0")
        yield shown
