"""Shows vehicles in the sea with meshcat: live in a web page, as pictures, or as a replay or a video file.

Importing this package loads no drawing library; the first viewer or replay does, and names the extra
to install where one is missing: `pip install "dq-marine[render]"`.
"""

from __future__ import annotations

from dq_marine.viewer.errors import ViewerError
from dq_marine.viewer.live import LiveViewer
from dq_marine.viewer.offscreen import OffscreenViewer
from dq_marine.viewer.overlay import make_overlay, save_overlay
from dq_marine.viewer.pacing import RealTimePacer
from dq_marine.viewer.replay import Replay, make_replay, save_replay
from dq_marine.viewer.shared_scene import Flight
from dq_marine.viewer.snapshot import Shape, Snapshot, Thruster
from dq_marine.viewer.transport.browser import find_chromium
from dq_marine.viewer.video import save_video

__all__ = [
    "Flight",
    "LiveViewer",
    "OffscreenViewer",
    "RealTimePacer",
    "Replay",
    "Shape",
    "Snapshot",
    "Thruster",
    "ViewerError",
    "find_chromium",
    "make_overlay",
    "make_replay",
    "save_overlay",
    "save_replay",
    "save_video",
]
