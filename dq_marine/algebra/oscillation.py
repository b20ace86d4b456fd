"""Sine, cosine and exponential decay as plain arithmetic: sums over a sea's components ask them by the hundred.

`math.sin` and its likes are library calls, which lanes make one body at a time. These have the same bits for one body
and in lanes, and in lanes they are vector instructions.
"""

from __future__ import annotations

import math

from dq_marine.algebra.selection import by_precision, rounded, select

TWO_OVER_PI = 2.0 / math.pi

QUARTER_TURN = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
"""pi/2 in parts of 33 bits, so that their products with a count of quarter turns below 2^20 are exact."""

QUARTER_TURN_SINGLE = (1.5703125, 4.8375129699707031e-4, 7.54978994964e-8)
"""The same in parts of 8 to 11 bits, for single precision."""

SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
"""Minimax coefficients of (sin x - x)/x^3 and (cos x - 1 + x^2/2)/x^4 on |x| <= pi/4: those of Sun's fdlibm."""

LARGEST_DECAY = 50.0
"""Beyond this exponent a decay stays where it is, at 2e-22."""

HALVINGS = 7
"""Of the exponent, before its series is taken and squared as often."""

SQUARED = 128.0
"""2^HALVINGS."""


def polynomial6(c: tuple[float, float, float, float, float, float], x: float) -> float:
    """Return c_0 + c_1 x + ... + c_5 x^5."""
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))))


def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Return the sine and cosine of an angle [rad] of up to 1e6, to about 2e-16; beyond that the error grows."""
    quarters = rounded(angle * TWO_OVER_PI)
    first = by_precision(angle, QUARTER_TURN[0], QUARTER_TURN_SINGLE[0])
    second = by_precision(angle, QUARTER_TURN[1], QUARTER_TURN_SINGLE[1])
    third = by_precision(angle, QUARTER_TURN[2], QUARTER_TURN_SINGLE[2])
    x = ((angle - quarters * first) - quarters * second) - quarters * third
    square = x * x
    sine = x + x * square * polynomial6(SINE, square)
    cosine = 1.0 - (0.5 * square - square * square * polynomial6(COSINE, square))
    quadrant = quarters - 4.0 * rounded(0.25 * quarters)  # -2, -1, 0, 1 or 2
    odd = abs(quadrant) == 1.0
    opposite = abs(quadrant) == 2.0
    s, c = select(odd, cosine, sine), select(odd, sine, cosine)
    return (
        select(opposite | (quadrant == -1.0), -s, s),
        select(opposite | (quadrant == 1.0), -c, c),
    )


def decay(exponent: float) -> float:
    """Return exp(-exponent) for an exponent of 0 or more, to a few 1e-14 of it; beyond 50, exp(-50)."""
    x = min(exponent, LARGEST_DECAY) * (-1.0 / SQUARED)
    result = 1.0 + x
    term = x
    for count in range(2, 12):
        term = term * x / count
        result = result + term
    for _ in range(HALVINGS):
        result = result * result
    return result
