"""What the `info` of an episode says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from dq_marine.envs.core.episode import Episode

FLAGS = (np.array(False), np.array(True))
"""What infos say of a condition, to be copied: arrays, which Gymnasium's vector environments merge into arrays."""

NO_FALLBACKS = np.int64(0)
"""What nearly all infos say of the steps by the fallback, made once."""


@dataclass(frozen=True, slots=True)
class Infos:
    """Makes infos out of what compiled code reports.

    Attributes:
        names: of the numbers of a report, up to the success.
        has_choice: whether episodes fly different vehicles.
    """

    names: tuple[str, ...]
    has_choice: bool

    def of(self, episode: Episode, refused: bool, fallbacks: int) -> dict[str, Any]:
        """Return the info of an episode, whose numbers later steps do not change.

        Args:
            episode: after a reset or a step.
            refused: whether the integrator refused the step.
            fallbacks: steps in it that plain Newton did not solve.
        """
        names, numbers = self.names, episode.report.copy()
        success = len(names)
        info: dict[str, Any] = dict(zip(names, numbers))  # noqa: B905 - `strict` costs as much as a number
        info["is_success"] = FLAGS[numbers.item(success) > 0.0].copy()
        info["current_ned"] = numbers[success + 1 :]
        info["refused"] = FLAGS[refused].copy()
        info["fallback_substeps"] = np.int64(fallbacks) if fallbacks else NO_FALLBACKS
        if self.has_choice:
            info["vehicle"] = np.int64(episode.vehicle)
        return info
