"""Shows vehicles in the sea with meshcat: live in a web page, as pictures, or as a replay file.

Importing this package loads no drawing library; the first viewer or replay does, and names the extra
to install where one is missing: `pip install "dq-marine[render]"`.
"""

from __future__ import annotations

from dq_marine.viewer.errors import ViewerError
from dq_marine.viewer.live import LiveViewer
from dq_marine.viewer.offscreen import OffscreenViewer
from dq_marine.viewer.pacing import RealTimePacer
from dq_marine.viewer.replay import save_replay
from dq_marine.viewer.snapshot import Shape, Snapshot, Thruster
from dq_marine.viewer.transport.browser import find_chromium

__all__ = [
    "LiveViewer",
    "OffscreenViewer",
    "RealTimePacer",
    "Shape",
    "Snapshot",
    "Thruster",
    "ViewerError",
    "find_chromium",
    "save_replay",
]
