"""Numbers of other kinds than float, such as `Fraction`: what is checked is kept, as the plain number that it is.

The campaign of hostile cases found this (case 12,005,833): a checked `Fraction` was put into a message as it was given.
"""

from fractions import Fraction

import numpy as np
import pytest

from dq_marine import DVL, Gyroscope
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.meshes.choices import Choices
from dq_marine.physics.weather import Jonswap, Sea

HALF = Fraction(1, 2)


def plain(*values):
    return all(type(value) in (float, int) for value in values)


def test_what_is_kept_is_plain():
    sea = Sea(Jonswap(HALF, 4 * HALF + 3), HALF, components=np.int64(7), spreading=4 * HALF, depth=40 * HALF)
    assert plain(sea.direction, sea.components, sea.spreading, sea.depth, sea.spectrum.height)
    assert sea == Sea(Jonswap(0.5, 5.0), 0.5, components=7, spreading=2.0, depth=20.0)
    assert Gyroscope(dropout=HALF, rate=20 * HALF) == Gyroscope(dropout=0.5, rate=10.0)
    assert plain(*(getattr(Gyroscope(dropout=HALF, rate=20 * HALF), name) for name in ("dropout", "rate")))
    conditions = Conditions(throttle=HALF, step=HALF)
    assert plain(conditions.throttle, conditions.step)
    choices = Choices(mass=HALF, speed=HALF, gravity=20 * HALF, panels=np.int64(500))
    assert plain(choices.mass, choices.speed, choices.gravity, choices.panels)


def test_what_is_refused_is_named():
    with pytest.raises(InvalidInputError, match=r"dropout = 1\.5; give 0 to 1"):
        DVL(dropout=3 * HALF)
    with pytest.raises(InvalidInputError, match=r"draft = 0\.5 says the mass, too"):
        Choices(draft=HALF, mass=1.0)
