"""What an environment shows of its episode: a live page, pictures, a recorded replay."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.util.announce import announce
from dq_marine.vehicles import Vehicle
from dq_marine.viewer.snapshot import Shape, Snapshot, Thruster

if TYPE_CHECKING:
    from dq_marine.envs.core.marine_env import MarineEnv
    from dq_marine.viewer.live import LiveViewer
    from dq_marine.viewer.offscreen import OffscreenViewer
    from dq_marine.viewer.playback import Playback
    from dq_marine.viewer.replay import Replay
    from dq_marine.viewer.shared_scene import Flight


AHEAD = (1.0, 0.0, 0.0)
"""Azimuths are drawn as they stand at the angle 0."""


def shape_of(vehicle: Vehicle) -> Shape:
    """Return what a viewer needs to draw a vehicle."""
    size = vehicle.dimensions
    return Shape(
        length=size.length,
        width=size.width,
        height=size.height,
        kind=size.shape,
        draft=size.draft,
        max_force=float(vehicle.wrench_limits[:3].max()) or 1.0,
        max_thrust=_largest_thrust(vehicle),
        appearance=vehicle.appearance,
        thrusters=tuple(
            Thruster(np.array(position), np.array(direction))
            for position, direction in (
                *((thruster.position, thruster.direction) for thruster in vehicle.thrusters),
                *((azimuth.position, AHEAD) for azimuth in vehicle.azimuths),
            )
        ),
    )


def _largest_thrust(vehicle: Vehicle) -> float | None:
    """Return a thrust that is large for a propeller [N]: its largest at rest, if it is not more than the vehicle needs.

    None where no propeller says it.
    """
    actuators = vehicle.actuators
    ranges = [one.thrust_range for one in (*actuators.thrusters, *actuators.azimuths)]
    largest = max((max(-low, high) for low, high in ranges), default=0.0)
    limit = float(vehicle.wrench_limits[:3].max())
    return (min(largest, limit) if limit else largest) or None


def checked_render_mode(mode: str | None, known: list[str]) -> str | None:
    """Return the mode.

    Raises:
        InvalidInputError: it is none of those known.
    """
    if mode is not None and mode not in known:
        raise InvalidInputError(f"render_mode = {shown(mode)}; give None or one of {known}")
    return mode


def open_page(shape: Shape, title: str) -> LiveViewer:
    """Open a live page and say where it is."""
    from dq_marine.viewer.live import LiveViewer

    page = LiveViewer(shape, title=title, open_browser=True)
    announce(f"the live page is at {page.url}")
    return page


class EpisodeView:
    """Draws and records the episodes of one environment; opens nothing before it is needed."""

    def __init__(self, env: MarineEnv) -> None:
        self._mode = env.render_mode
        self._record = env.record
        self._shape = shape_of(env.vehicle)
        self._title = env.vehicle.name
        self.remark = ""
        self._snapshots: list[Snapshot] = []
        self._live: LiveViewer | None = None
        self._playback: Playback | None = None
        self._offscreen: OffscreenViewer | None = None
        self.wants_frames = self._record or self._mode == "human"

    def begin(self, env: MarineEnv) -> None:
        """Start a new episode at the environment's present state."""
        self._snapshots, self.remark = [], ""
        if self._playback is not None:
            self._playback.begin()
        if self._live is not None:
            self._live.clear_trail()
        if self._offscreen is not None:
            self._offscreen.clear_trail()
        if self.wants_frames:
            self.show(env)

    def show(self, env: MarineEnv) -> None:
        """Record the present state, and draw it at its time if a page is to follow."""
        snapshot = env.snapshot()
        if self._record:
            self._snapshots.append(snapshot)
        if self._mode == "human":
            self._draw_live(snapshot)

    def render(self, env: MarineEnv) -> NDArray[np.uint8] | None:
        """Return a picture in mode "rgb_array"."""
        if self._mode != "rgb_array":
            return None
        return self._pictures().render(env.snapshot())

    def render_still(self, env: MarineEnv) -> NDArray[np.uint8]:
        """Return a picture without a trail."""
        self._pictures().clear_trail()
        return self._pictures().render(env.snapshot())

    def save_html(self, path: str | os.PathLike[str]) -> None:
        """Write the recorded episode as a standalone page."""
        from dq_marine.viewer.replay import save_replay

        save_replay(path, self._recorded("save_html"), self._shape, title=self._titled)

    def save_mp4(
        self, path: str | os.PathLike[str], fps: float | None, progress: Callable[[float], None]
    ) -> None:
        """Write the recorded episode as a video."""
        from dq_marine.viewer.video import save_video

        save_video(path, self._recorded("save_mp4"), self._shape, fps=fps, progress=progress)

    def replay(self) -> Replay:
        """Return the recorded episode as a page."""
        from dq_marine.viewer.replay import make_replay

        return make_replay(self._recorded("replay"), self._shape, title=self._titled)

    @property
    def _titled(self) -> str:
        return f"{self._title}, {self.remark}" if self.remark else self._title

    def flight(self, name: str) -> Flight:
        """Return the recorded episode as one flight among others."""
        from dq_marine.viewer.shared_scene import Flight

        return Flight(name, tuple(self._recorded("recorded_flight")), self._shape)

    @property
    def url(self) -> str | None:
        """Address of the live page; None where none is open."""
        return None if self._live is None else self._live.url

    def close(self) -> None:
        """Close page and pictures; both open again when asked for."""
        for viewer in (self._live, self._offscreen):
            if viewer is not None:
                viewer.close()
        self._live = self._offscreen = self._playback = None

    def _recorded(self, door: str) -> list[Snapshot]:
        if not self._record:
            raise InvalidInputError(
                f"nothing was recorded; make the environment with record=True, then {door}() after some steps"
            )
        return self._snapshots

    def _pictures(self) -> OffscreenViewer:
        if self._offscreen is None:
            from dq_marine.viewer.offscreen import OffscreenViewer

            self._offscreen = OffscreenViewer(self._shape)
        return self._offscreen

    def _draw_live(self, snapshot: Snapshot) -> None:
        from dq_marine.viewer.controls import Group
        from dq_marine.viewer.playback import Playback

        if self._live is None or self._playback is None:
            self._live, self._playback = open_page(self._shape, self._title), Playback()
            self._live.show_controls((Group("Simulation", self._playback.controls()),))
        self._live.draw(snapshot)
        self._playback.wait(snapshot.time, self._hear)

    def _hear(self) -> None:
        """Hand over what a person did in the page."""
        if self._live is not None and self._playback is not None:
            for event in self._live.events():
                self._playback.take(event)
