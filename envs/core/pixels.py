"""Pictures as observations, for one environment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import numpy as np
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from dq_marine.checks import shown, whole_number
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.view import shape_of
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.viewer.offscreen import OffscreenViewer

WIDTH, HEIGHT = 320, 240
"""Of pictures whose size is not given [pixels]."""

SMALLEST_SIDE, LARGEST_SIDE = 32, 2048
"""Of pictures [pixels]."""


def picture_size(observation: Any) -> tuple[int, int] | None:
    """Return the width and height of pictures that are asked for [pixels]; None where numbers are.

    Args:
        observation: "numbers", "pixels", or {"pixels": [width, height]}.

    Raises:
        InvalidInputError: it is none of these.
    """
    if isinstance(observation, str) and observation in ("numbers", "pixels"):
        return None if observation == "numbers" else (WIDTH, HEIGHT)
    wanted = "give 'numbers', 'pixels' or {'pixels': [width, height]}"
    if not isinstance(observation, Mapping) or list(observation) != ["pixels"]:
        raise InvalidInputError(f"observation = {shown(observation)}; {wanted}")
    size = observation["pixels"]
    if not isinstance(size, list | tuple) or len(size) != 2:
        raise InvalidInputError(f"observation['pixels'] = {shown(size)}; {wanted}")
    width, height = (
        whole_number(f"observation['pixels'][{place}]", side, least=SMALLEST_SIDE, most=LARGEST_SIDE)
        for place, side in enumerate(size)
    )
    return width, height


class PixelObservation(
    gym.ObservationWrapper[NDArray[np.uint8], Action, Observation],
    RecordConstructorArgs,
):
    """An environment that is observed by pictures: uint8 of shape (height, width, 3).

    Each is what `render` draws, without the trail, the time and the depth in it: it follows from the state alone. A
    browser draws it, which takes as long as hundreds of steps. Action, reward, info and `unwrapped` are those of the
    environment inside.
    """

    def __init__(self, env: MarineEnv, width: int = WIDTH, height: int = HEIGHT) -> None:
        """Prepare; the browser starts with the first picture.

        Args:
            env: whose pictures.
            width: of the pictures [pixels].
            height: of the pictures [pixels].

        Raises:
            InvalidInputError: observations are to be late, which pictures of the present state are not.
        """
        if env.settings.observation_delay:
            raise InvalidInputError(
                f"observation_delay = {env.settings.observation_delay}, and pictures are observed, which it does not "
                "hold back; wrap the environment in gymnasium.wrappers.DelayObservation"
            )
        RecordConstructorArgs.__init__(self, width=width, height=height)
        gym.ObservationWrapper.__init__(self, env)
        self._marine, self._size = env, (width, height)
        self._viewer: OffscreenViewer | None = None
        self.observation_space = gym.spaces.Box(0, 255, (height, width, 3), np.uint8)

    def observation(self, observation: Observation) -> NDArray[np.uint8]:
        """Return the picture of the present state.

        Raises:
            MissingDependencyError: meshcat or a Chromium is not installed.
        """
        from dq_marine.viewer.offscreen import OffscreenViewer  # here: numbers do without a viewer

        if self._viewer is None:
            self._viewer = OffscreenViewer(shape_of(self._marine.vehicle), *self._size, caption=False)
        self._viewer.clear_trail()
        return self._viewer.render(self._marine.snapshot())

    def close(self) -> None:
        """End the browser, and whatever rendering started."""
        if self._viewer is not None:
            self._viewer.close()
            self._viewer = None
        super().close()

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the browser, which cannot travel."""
        return {**self.__dict__, "_viewer": None}
