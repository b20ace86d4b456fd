"""For which motions and seas the numbers of a vehicle file hold."""

from __future__ import annotations

import math
from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from dq_marine.physics.fields import Positive, Table
from dq_marine.physics.implausible import Implausible

UNDER_WAY = 0.2
"""Share of the largest speed from which a drift angle means something: slower, a vehicle manoeuvres in place."""


Text = Annotated[str, Field(min_length=1)]


class Validity(Table):
    """The motions and seas that a file's numbers were measured or computed for; what is left out is not known.

    Attributes:
        speed: largest through the water [m/s].
        drift_angle_deg: largest angle between the x axis and the way through the water, under way [deg].
        wave_height: largest significant wave height [m].
        source: of the limits that have none of their own.
        drift_angle_source: of that of the drift angle; without a limit, why there is none.
        wave_height_source: of that of the wave height; without a limit, why there is none.
    """

    speed: Positive | None = None
    drift_angle_deg: Annotated[float, Field(gt=0, le=90)] | None = None
    wave_height: Positive | None = None
    source: Text
    drift_angle_source: Text | None = None
    wave_height_source: Text | None = None

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if self.speed is None and self.drift_angle_deg is None and self.wave_height is None:
            raise Implausible(
                "validity", "no limit", "it says nothing", "give speed, drift_angle_deg or wave_height"
            )
        if self.drift_angle_deg is not None and self.speed is None:
            raise Implausible(
                "validity.drift_angle_deg",
                f"{self.drift_angle_deg:g}",
                "without a speed it is not known when the vehicle is under way",
                "give speed too",
            )
        return self

    def limits(self) -> tuple[str, ...]:
        """Return the limits, or why there is none, each for reading."""
        named = (
            ("through the water", self.speed, "m/s", None),
            ("drift", self.drift_angle_deg, "deg", self.drift_angle_source),
            ("significant wave heights", self.wave_height, "m", self.wave_height_source),
        )
        return tuple(
            f"{name} without a limit: {why}" if value is None else f"{name} up to {value:g} {unit}"
            for name, value, unit, why in named
            if value is not None or why is not None
        )

    def notes(self, through_water: NDArray[np.float64]) -> tuple[str, ...]:
        """Return what is to be said of a run that left the limits.

        Args:
            through_water: linear velocity in the body frame [m/s], shape (n, 3).
        """
        notes = []
        speeds = np.linalg.norm(through_water, axis=1)
        fastest = float(speeds.max(initial=0.0))
        if self.speed is not None and fastest > self.speed:
            notes.append(
                f"It went up to {fastest:.3g} m/s through the water; its numbers hold up to {self.speed:g} m/s "
                f"({self.source})."
            )
        if self.speed is not None and self.drift_angle_deg is not None:
            moving = through_water[speeds > UNDER_WAY * self.speed]
            across = np.hypot(moving[:, 1], moving[:, 2])
            widest = math.degrees(float(np.arctan2(across, moving[:, 0]).max(initial=0.0)))
            if widest > self.drift_angle_deg:
                notes.append(
                    f"It drifted by up to {widest:.0f} deg under way; its numbers hold up to "
                    f"{self.drift_angle_deg:g} deg ({self.drift_angle_source or self.source})."
                )
        return tuple(notes)
