"""Normal random numbers from uniform ones, by formulas that lanes can compute."""

from __future__ import annotations

import math

from dq_marine.algebra.elementary import logarithm, sine_and_cosine
from dq_marine.algebra.selection import smallest_normal


def normal_pair(first: float, second: float) -> tuple[float, float]:
    """Return two independent standard normal numbers from two uniform ones in [0, 1).

    Box and Muller 1958, "A note on the generation of random normal deviates", Ann. Math. Stat. 29, 610.
    """
    # In single precision a uniform number may have been rounded to 1.
    size = math.sqrt(-2.0 * logarithm(max(1.0 - first, smallest_normal(first))))
    sine, cosine = sine_and_cosine(2.0 * math.pi * second)
    return size * cosine, size * sine
