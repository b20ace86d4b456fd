"""Cross-flow drag as vehicle files describe it: a hull cut into strips, each with a drag across the flow."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from dq_marine.checks import finite_number
from dq_marine.physics.fields import Positive, Table

DEFAULT_STRIPS = 20
MOST_STRIPS = 1000

# Fossen, T. I., Marine Systems Simulator, Hoerner.m (MIT licence): Hoerner's curve, digitised.
HOERNER_RATIOS = (
    0.0109, 0.1766, 0.3530, 0.4519, 0.4728, 0.4929, 0.4933, 0.5585, 0.6464, 0.8336,
    0.9880, 1.3081, 1.6392, 1.8600, 2.3129, 2.6000, 3.0088, 3.4508, 3.7379, 4.0031,
)  # fmt: skip
HOERNER_COEFFICIENTS = (
    1.9661, 1.9657, 1.8976, 1.7872, 1.5837, 1.2786, 1.2108, 1.0836, 0.9986, 0.8796,
    0.8284, 0.7599, 0.6914, 0.6571, 0.6307, 0.5962, 0.5868, 0.5859, 0.5599, 0.5593,
)  # fmt: skip


class CrossFlow(Table):
    """Strips of equal width along x, each with the drag -(1/2) rho depth C_D |v_i| v_i dx of its own velocity.

    Strip i is as wide as length / strips and stands in its middle. Published code that puts n + 1 strips of width
    L/n on the points from -L/2 to L/2, both ends included, has strips = n + 1 and length = (n + 1) L/n here.

    Attributes:
        plane: "sway" for sway and yaw, v_i = v + x r; "heave" for heave and pitch, v_i = w - x q.
        length: of all strips together [m].
        center: x of their middle [m].
        depth: of the hull across the flow: its draft in sway, its beam in heave [m].
        drag_coefficient: C_D of a strip; left out, Hoerner's at beam / (2 depth).
        beam: the hull's extent along the flow, for Hoerner's curve [m].
        strips: their number.
        water_density: that the coefficient holds for [kg/m^3]; left out, the vehicle's.
    """

    plane: Literal["sway", "heave"]
    length: Positive
    center: float = 0.0
    depth: Positive
    drag_coefficient: Annotated[float, Field(gt=0.0, le=5.0)] | None = None
    beam: Positive | None = None
    strips: Annotated[int, Field(gt=0, le=MOST_STRIPS)] = DEFAULT_STRIPS
    water_density: Positive | None = None

    @property
    def levers(self) -> NDArray[np.float64]:
        """X of the strips' middles [m], shape (strips,)."""
        return self.center + self.length * ((np.arange(self.strips) + 0.5) / self.strips - 0.5)

    @property
    def section_drag(self) -> float:
        """C_D of a strip, given or Hoerner's."""
        if self.drag_coefficient is not None:
            return self.drag_coefficient
        if self.beam is None:
            raise AssertionError("checked by dq_marine.vehicles.checks.plausibility")
        return hoerner_drag_coefficient(self.beam / (2.0 * self.depth))

    def strip_coefficient(self, density: float) -> float:
        """Return c of a strip's drag -c |v_i| v_i [N s^2/m^2], in water of a density [kg/m^3] unless it has its own."""
        width = self.length / self.strips
        return 0.5 * (self.water_density or density) * self.section_drag * self.depth * width

    def own_axis_coefficients(self, density: float) -> NDArray[np.float64]:
        """Return the coefficients of |nu_i| nu_i for motion in one axis alone, Fossen's order, shape (6,)."""
        c, levers = self.strip_coefficient(density), self.levers
        across, turning = (1, 5) if self.plane == "sway" else (2, 4)
        coefficients = np.zeros(6)
        coefficients[across] = c * self.strips
        coefficients[turning] = c * (np.abs(levers) ** 3).sum()
        return coefficients


def hoerner_drag_coefficient(beam_over_twice_draft: float) -> float:
    """Return the two-dimensional cross-flow drag coefficient of a ship-like section.

    Hoerner's curve as digitised by Fossen, linear between its points and constant beyond its ends.

    Args:
        beam_over_twice_draft: B / (2 T).

    Raises:
        InvalidInputError: it is not finite and above 0.
    """
    ratio = finite_number("beam_over_twice_draft", beam_over_twice_draft, above=0.0)
    return float(np.interp(ratio, HOERNER_RATIOS, HOERNER_COEFFICIENTS))
