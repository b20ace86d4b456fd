"""A whole ship in its vehicle file: polynomials about its service speed, propeller and rudder in them.

Notation and numbers as published: forces over rho/2 L^2 U^2, moments over rho/2 L^3 U^2, and derivatives by the letters
of u', v', r' and d, the rudder's angle in radians, such as `vvr` for Y'_vvr; `"0"` for a constant. The body origin must
be where the derivatives were measured about. The density is that of `buoyancy`.
"""

from __future__ import annotations

import math
import re
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from dq_marine.physics.fields import NonNegative, Positive, Table

ORDER = "0uvrd"
"""Of letters in a name."""

LETTERS = re.compile("0|[uvrd]{1,4}")

LARGEST = 10.0
"""Of a dimensionless derivative; those of ships are below 1."""


class Derivatives(dict[str, float]):
    """Coefficients of a polynomial by their letters; like all of a vehicle they stay, and so it has a hash."""

    def __hash__(self) -> int:  # type: ignore[override]
        """Return a hash that equal ones have."""
        return hash(frozenset(self.items()))


def checked_polynomial(coefficients: dict[str, float]) -> Derivatives:
    """Return the coefficients in one order, by letters in the order u, v, r, d.

    Raises:
        ValueError: a name has other letters, two names mean the same, or a value is no dimensionless derivative.
    """
    found: dict[str, float] = {}
    for name, value in coefficients.items():
        if not LETTERS.fullmatch(name):
            raise ValueError(f'{name!r} is no derivative; give one to four of the letters u, v, r, d, or "0"')
        letters = "".join(sorted(name, key=ORDER.index))
        if letters in found:
            raise ValueError(f"{name!r} is there twice, its letters in another order; give their sum")
        if abs(value) > LARGEST:
            raise ValueError(
                f"{name!r} is {value:g}, beyond {LARGEST:g}, as no derivative is; write those that are published in "
                "units of 1e-5 as -1160e-5"
            )
        found[letters] = value
    return Derivatives(sorted(found.items(), key=lambda item: (len(item[0]), [*map(ORDER.index, item[0])])))


Polynomial = Annotated[dict[str, float], AfterValidator(checked_polynomial)]
"""A field with the coefficients of a polynomial."""


class WholeShipRange(Table):
    """The motions that the polynomials know; beyond, they are continued.

    Attributes:
        loss: largest loss of speed, -u'.
        gain: largest gain of speed, u'.
        drift_deg: largest drift angle [deg].
        turn: largest |r'|.
    """

    loss: Annotated[float, Field(gt=0.05, le=0.9)] = 0.6
    gain: Annotated[float, Field(gt=0.0, le=0.5)] = 0.2
    drift_deg: Annotated[float, Field(ge=5.0, le=45.0)] = 25.0
    turn: Annotated[float, Field(ge=0.1, le=2.0)] = 0.8


class WholeShipRudder(Table):
    """The rudder, whose force is in the polynomials.

    Attributes:
        positive_to: the side to which the published angle turns the ship where it is positive.
        limit_deg: largest angle.
        rate_limit_deg_s: largest rate of the angle.
        time_constant: of the first-order lag of the angle [s]; 0 for none.
    """

    positive_to: Literal["port", "starboard"]
    limit_deg: Annotated[float, Field(gt=0.0, le=60.0)]
    rate_limit_deg_s: Positive | None = None
    time_constant: NonNegative = 0.0

    @property
    def limit(self) -> float:
        """Largest angle [rad]."""
        return math.radians(self.limit_deg)


class WholeShip(Table):
    """A ship by polynomials about its service speed.

    Attributes:
        length: L between perpendiculars [m].
        service_speed: U_0 [m/s], which the ship holds with its rudder amidships.
        depth: z at which surge and sway force act [m].
        surge: X'.
        sway: Y'.
        yaw: N'.
        rudder: in them.
        range: that they know.
    """

    length: Positive
    service_speed: Positive
    depth: float = 0.0
    surge: Polynomial
    sway: Polynomial
    yaw: Polynomial
    rudder: WholeShipRudder
    range: WholeShipRange = WholeShipRange()

    @property
    def slowest(self) -> float:
        """Speed on a straight course below which the polynomials are continued [m/s]."""
        return self.service_speed / (1.0 + self.range.loss)

    @property
    def fastest(self) -> float:
        """Speed on a straight course above which they are continued [m/s]."""
        return self.service_speed / (1.0 - self.range.gain)
