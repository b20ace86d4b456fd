"""Sine and cosine by arithmetic alone, which lanes compute side by side where the library's take one number at a time.

They are within 1e-14 of the library's for angles of up to thousands of turns, and are for worlds of many waves. Angles
are reduced to within an eighth of a turn by Cody and Waite's subtraction in two parts (Cody & Waite 1980, Software
Manual for the Elementary Functions, 8), and the series is cut where its terms are below the last digit.
"""

from __future__ import annotations

import math

from dq_marine.algebra.selection import rounded, select

QUARTER, REST = 1.5707963267341256, 6.077100506506192e-11
"""A quarter turn [rad] in two parts, of which the first has so few digits that its products are exact."""


def sine_cosine(angle: float) -> tuple[float, float]:
    """Return sine and cosine of an angle [rad]."""
    quarters = rounded(angle * (2.0 / math.pi))
    r = (angle - quarters * QUARTER) - quarters * REST
    x = r * r
    s = r * (1.0 + x * (-1.0 / 6.0 + x * (1.0 / 120.0 + x * (-1.0 / 5040.0 + x * _sine_tail(x)))))
    c = 1.0 + x * (-0.5 + x * (1.0 / 24.0 + x * (-1.0 / 720.0 + x * _cosine_tail(x))))
    quadrant = quarters - 4.0 * rounded(0.25 * quarters - 0.375)
    odd = (quadrant == 1.0) | (quadrant == 3.0)
    sine, cosine = select(odd, c, s), select(odd, s, c)
    behind = (quadrant == 1.0) | (quadrant == 2.0)
    return select(quadrant >= 2.0, -sine, sine), select(behind, -cosine, cosine)


def _sine_tail(x: float) -> float:
    return 1.0 / 362880.0 + x * (-1.0 / 39916800.0 + x * (1.0 / 6227020800.0 - x / 1307674368000.0))


def _cosine_tail(x: float) -> float:
    return 1.0 / 40320.0 + x * (-1.0 / 3628800.0 + x * (1.0 / 479001600.0 + x * _last_cosines(x)))


def _last_cosines(x: float) -> float:
    return -1.0 / 87178291200.0 + x / 20922789888000.0
