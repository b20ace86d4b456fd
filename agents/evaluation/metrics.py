"""The numbers that an episode is measured by: those that its task names, as `info` has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.definition import TaskDefinition

Array = NDArray[np.float64]

REWARD_PREFIX = "reward/"
"""Of the entries of `info` that are a period's reward terms."""

SUCCESS = "is_success"
"""The entry of `info` that says whether the task counts as done."""


@dataclass(frozen=True)
class Metric:
    """A number that `info` has at every instant.

    Attributes:
        name: its key in `info`.
        unit: in `info`, as in "m", "rad"; "" where there is none or it is not known.
        tolerance: magnitude within which an episode counts as settled, in that unit; None if it does not matter.
    """

    name: str
    unit: str = ""
    tolerance: float | None = None

    @property
    def label(self) -> str:
        """The name in words."""
        return self.name.replace("_", " ")

    @property
    def shown_unit(self) -> str:
        """The unit that people read: degrees for angles."""
        return "deg" if self.unit == "rad" else self.unit

    @property
    def shown_name(self) -> str:
        """The name with the unit that people read at its end."""
        return f"{self.name}_{self.shown_unit}" if self.unit else self.name

    def heading(self, part: str = "") -> str:
        """Return name, part and the unit that people read, in words: "depth error final [m]"."""
        unit = f"[{self.shown_unit}]" if self.unit else ""
        return " ".join(word for word in (self.label, part, unit) if word)

    def shown(self, value: Any) -> Any:
        """Return a value, or an array of them, in the unit that people read."""
        return np.degrees(value) if self.unit == "rad" else value

    def text(self, value: float, *, unit: bool = True) -> str:
        """Return a value of the shown unit as people read it."""
        digits = {"m": ".3f", "deg": ".2f"}.get(self.shown_unit, ".4g")
        return f"{value:{digits}} {self.shown_unit}".rstrip() if unit else f"{value:{digits}}"


def metrics_of(definition: TaskDefinition) -> tuple[Metric, ...]:
    """Return the metrics of a task, in its order."""
    return tuple(
        Metric(name, definition.units.get(name, ""), definition.tolerances.get(name))
        for name in definition.metric_names
    )


def reward_term_names(info: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the entries of an info that are reward terms, with their prefix."""
    return tuple(name for name in info if name.startswith(REWARD_PREFIX))
