"""What an environment has to show besides pictures: replays, videos, and itself in a notebook."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING

from dq_marine.envs.core.card import card
from dq_marine.envs.core.composed_task import ComposedTask
from dq_marine.envs.core.view import EpisodeView

if TYPE_CHECKING:
    from dq_marine.viewer.replay import Replay
    from dq_marine.viewer.shared_scene import Flight


class ShownTask(ComposedTask):
    """A `ComposedTask` whose episodes can be seen. `MarineEnv` runs it."""

    _view: EpisodeView

    def save_html(self, path: str | os.PathLike[str]) -> None:
        """Write the episode so far as a standalone page with a timeline (play, pause, scrub).

        Raises:
            InvalidInputError: the environment was made without `record=True`, or the folder does not exist.
            MissingDependencyError: meshcat is not installed.
        """
        self._view.save_html(path)

    def save_mp4(
        self,
        path: str | os.PathLike[str],
        *,
        fps: float | None = None,
        progress: Callable[[float], None] = lambda done: None,
    ) -> None:
        """Write the episode so far as a video that runs in real time.

        Args:
            path: of the MP4 file; its folder must exist.
            fps: pictures a second; None for one in each control period, up to 60 a second.
            progress: is told what part is done, from 0 to 1.

        Raises:
            InvalidInputError: the environment was made without `record=True`, the folder does not exist, or a rate
                that videos do not have.
            MissingDependencyError: meshcat, imageio-ffmpeg or Chromium is not installed.
        """
        self._view.save_mp4(path, fps, progress)

    def replay(self) -> Replay:
        """Return the episode so far as a page with a timeline, which a notebook shows inline.

        Raises:
            InvalidInputError: the environment was made without `record=True`.
            MissingDependencyError: meshcat is not installed.
        """
        return self._view.replay()

    def recorded_flight(self, name: str) -> Flight:
        """Return the episode so far as a flight that `dq_marine.viewer.make_overlay` shows in one scene with others.

        Args:
            name: of the flight, in the legend.

        Raises:
            InvalidInputError: the environment was made without `record=True`.
        """
        return self._view.flight(name)

    @property
    def viewer_url(self) -> str | None:
        """Address of the live page, for this computer only; None where none is open.

        One opens with the first `reset` of an environment with `render_mode="human"`.
        """
        return self._view.url

    def annotate(self, remark: str) -> None:
        """Have the title of the episode's replay say something, until the next episode begins."""
        self._view.remark = remark

    def close(self) -> None:
        """End whatever rendering started."""
        self._view.close()

    def _repr_html_(self) -> str:
        return card(self, self.viewer_url)
