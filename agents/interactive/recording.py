"""What is flown in a live page, as Minari datasets: one for each environment, with all its episodes.

Each step's info has `by_person`, whether the person was at the helm: an imitation of them may leave out the rest; and
`pushed`, whether they pulled the vehicle by hand: what it did then does not follow from its action alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym

from dq_marine.agents.datasets.dataset_folder import DatasetFolder

BY_PERSON, PUSHED = "by_person", "pushed"


def noted(by_person: Callable[[], bool], pushed: Callable[[], bool]) -> Callable[[bool], dict[str, Any]]:
    """Return what joins the info: of a step, who was at the helm and whether it was pushed; a reset is no step."""
    return lambda stepped: {BY_PERSON: by_person(), PUSHED: stepped and pushed()}


class Recorder(DatasetFolder):
    """Keeps what is flown in a live page in a folder of Minari datasets."""

    def recording_of(
        self, env: gym.Env[Any, Any], by_person: Callable[[], bool], pushed: Callable[[], bool]
    ) -> gym.Env[Any, Any]:
        """Return an environment around one of this package that keeps what is flown in it.

        Args:
            env: whose episodes are kept.
            by_person: whether a person flies it now.
            pushed: whether a person pulled it by hand in the last step.
        """
        return self.recording(env, noted(by_person, pushed))

    def keep_flown(self, recorded: gym.Env[Any, Any]) -> None:
        """Write the episodes of an environment that `recording_of` returned, if any, as one dataset.

        Raises:
            InvalidInputError: it cannot be written.
        """
        self.keep(
            recorded,
            agent=None,
            algorithm="flown in the live page",
            description=(
                f"flown in the live page of dq-marine; {BY_PERSON} tells who was at the helm, {PUSHED} in "
                "which steps the vehicle was pulled by hand"
            ),
        )
