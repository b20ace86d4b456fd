"""Damping of a vessel at rest that gives way to that of a vessel under way, as vehicle files describe it."""

from __future__ import annotations

import math
from typing import get_args

from dq_marine.physics.damping.formulas.blended import Blend, blended_damping
from dq_marine.physics.fields import Motion, NonNegative, Positive, Table


class BlendedDamping(Table):
    """Damping of one axis, besides what `linear` and `quadratic` have: -(s linear + (1 - s) quadratic |nu_i|) nu_i.

    With the weight s = 1 - tanh(|u| / crossover) for the surge velocity u through the water: linear at rest, quadratic
    under way (`dq_marine/physics/damping/formulas/blended.py`).

    Attributes:
        axis: that it acts in.
        linear: at rest [N s/m, N m s].
        quadratic: under way [N s^2/m^2, N m s^2]; 0 for damping that fades away.
        crossover: surge speed at which the two change over [m/s].
    """

    axis: Motion
    linear: NonNegative
    quadratic: NonNegative = 0.0
    crossover: Positive

    @property
    def index(self) -> int:
        """The axis in Fossen's order."""
        return get_args(Motion).index(self.axis)

    @property
    def blend(self) -> Blend:
        """The numbers of the formula."""
        return Blend(self.linear, self.quadratic, self.crossover)

    def alone(self, speed: float) -> float:
        """Return the force or moment against motion in this axis alone, at a speed of 0 or more [N, N m]."""
        return speed * blended_damping(self.blend, speed if self.axis == "surge" else 0.0, speed)

    def falls_at(self) -> float | None:
        """Return the smallest speed, to a hundredth of the crossover, at which the force falls as speed grows [m/s]."""
        before = 0.0
        for number in range(1, 1 + round(REACH / FINENESS)):
            speed = FINENESS * number * self.crossover
            force = self.alone(speed)
            if force < before * (1.0 - math.ulp(1.0)):
                return speed
            before = force
        return None


FINENESS, REACH = 0.01, 8.0
"""Spacing and end of the speeds at which a blend is checked, over its crossover: at 8, the weight s is 2e-7."""
