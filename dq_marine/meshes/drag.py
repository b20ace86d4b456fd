"""Damping of a hull, estimated from its areas: what a potential flow has not. Each number says what it is made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from dq_marine.meshes.surface import Array, area_vectors
from dq_marine.physics.damping.cross_flow_table import CrossFlow

HOERNER = "Hoerner, S. F. (1965). Fluid-Dynamic Drag"
FRICTION = "8th International Towing Tank Conference (1957): friction line"

VISCOSITY = 1.19e-6
"""Kinematic viscosity of sea water at 15 degrees C [m^2/s] (ITTC 7.5-02-01-03)."""

CUBE = 1.05
"""C_D of a cube, face on (Hoerner 1965, ch. 3)."""

CYLINDER = 1.1
"""C_D across a long circular cylinder, below the critical Reynolds number (Hoerner 1965, ch. 3; Prestero 2001)."""

SPHERE = 0.47
"""C_D of a sphere below the critical Reynolds number (Hoerner 1965, ch. 3)."""

ROUGHNESS = 4e-4
"""Allowance for roughness and small parts added to C_F of a ship (Fossen 2021, ch. 6; ITTC 1978)."""

FORM = 0.1
"""Form factor k of a ship in transit (Fossen 2021, ch. 6)."""

SLOW = 0.1
"""Linear damping is what the quadratic takes at this part of the design speed, and at that over half the length."""

RELATIVE_DAMPING = {"heave": 0.2, "roll": 0.05, "pitch": 0.2}
"""Of a hull afloat, estimates: in heave as Dmtrx.m of MSS takes for ships, in pitch the same, both only where radiation
was not solved; in roll that of a bare hull (how it is computed: Himeno 1981, Prediction of Ship Roll Damping).
"""

SUBMERGED_RELATIVE_DAMPING = 0.1
"""In roll and pitch, of a vehicle under water that rights itself, at the least: an estimate, below the 0.3 and 0.8 that
remus100.m of MSS has."""


@dataclass(frozen=True, eq=False)
class Form:
    """What of a hull the drag depends on, in axes forward-starboard-down about the body origin.

    Attributes:
        wet: triangles of the wet surface, shape (n, 3, 3) [m].
        shape: as in a vehicle file's dimensions.
        floats: whether there is a free surface.
        density: of the water [kg/m^3].
        speed: that the numbers hold near [m/s].
    """

    wet: Array
    shape: str
    floats: bool
    density: float
    speed: float

    @property
    def low(self) -> Array:
        """Least x, y, z of the wet hull [m], shape (3,)."""
        return np.asarray(self.wet.min(axis=(0, 1)))

    @property
    def size(self) -> Array:
        """Length, width and depth of the wet hull [m], shape (3,)."""
        return np.asarray(np.ptp(self.wet.reshape(-1, 3), axis=0))

    def lever_area(self, axis: int, along: int, power: int) -> float:
        """Return the integral of |lever|^power over the area that faces an axis, the mean of both sides [m^(2+power)].

        Args:
            axis: 0, 1 or 2, that the area faces.
            along: axis of the lever from the origin.
            power: of the lever.
        """
        facing = np.abs(area_vectors(self.wet)[:, axis])
        levers = np.abs(self.wet.mean(axis=1)[:, along]) ** power
        sides = 1.0 if self.floats and axis == 2 else 0.5
        return float(sides * facing @ levers)

    @property
    def wetted_area(self) -> float:
        """S [m^2]."""
        return float(np.linalg.norm(area_vectors(self.wet), axis=1).sum())


@dataclass(frozen=True)
class Drag:
    """Damping as a vehicle file has it, and why.

    Attributes:
        quadratic: coefficients of |nu_i| nu_i [N s^2/m^2, N m s^2].
        cross_flow: tables of strips.
        own_axis: coefficients of |nu_i| nu_i by `quadratic` and strips together, Fossen's order, shape (6,).
        own_axes: a sentence for each estimate of `quadratic`.
        strips: the same of `cross_flow`.
        sources: of the estimates.
    """

    quadratic: tuple[float, ...]
    cross_flow: tuple[Mapping[str, Any], ...]
    own_axis: Array
    own_axes: tuple[str, ...]
    strips: tuple[str, ...]
    sources: tuple[str, ...]


def estimated_drag(form: Form) -> Drag:
    """Return the quadratic drag of a hull along x, and across it by strips along its length."""
    surge, why_surge = _surge(form)
    strips, why_strips = _strips(form)
    quadratic = np.zeros(6)
    quadratic[0] = surge
    why_roll: tuple[str, ...] = ()
    if form.shape == "open_frame":
        lever = form.lever_area(1, 2, 3) + form.lever_area(2, 1, 3)
        quadratic[3] = 0.5 * form.density * CUBE * lever
        why_roll = (
            f"roll: sides and top, face on, C_D = {CUBE:g}, times their levers cubed, {lever:.4g} m^5",
        )
    own = quadratic + sum(
        CrossFlow.model_validate(table).own_axis_coefficients(form.density) for table in strips
    )
    sources = (f"{HOERNER}: drag coefficients.", f"{FRICTION}: skin friction.")
    return Drag(tuple(quadratic.tolist()), strips, own, (why_surge, *why_roll), why_strips, sources)


def _surge(form: Form) -> tuple[float, str]:
    """Return the coefficient of |u| u and what it is made of."""
    length, width, depth = form.size
    if form.shape == "open_frame":
        area = form.lever_area(0, 0, 0)
        return (
            0.5 * form.density * CUBE * area,
            f"surge: C_D = {CUBE:g} of a cube, face on (Hoerner 1965, ch. 3), on a frontal area of {area:.4g} m^2",
        )
    area = form.wetted_area
    reynolds = max(form.speed * length / VISCOSITY, 1e4)
    friction = 0.075 / (math.log10(reynolds) - 2.0) ** 2  # ITTC 1957
    if form.floats:
        total = (1.0 + FORM) * friction + ROUGHNESS
        formula = f"(1 + {FORM:g}) C_F + {ROUGHNESS:g} (Fossen 2021, ch. 6), without wave resistance"
    else:
        slender = math.sqrt(width * depth) / length
        total = friction * (1.0 + 1.5 * slender**1.5 + 7.0 * slender**3)  # Hoerner 1965, ch. 6, eq. 28
        formula = (
            f"C_F (1 + 1.5 (d/l)^1.5 + 7 (d/l)^3), d/l = {slender:.3g} (Hoerner 1965, ch. 6), the bare hull"
        )
    return (
        0.5 * form.density * total * area,
        f"surge: {formula}, C_F = {friction:.4g} (ITTC 1957) at {form.speed:.4g} m/s, on {area:.4g} m^2",
    )


def _strips(form: Form) -> tuple[tuple[Mapping[str, Any], ...], tuple[str, ...]]:
    """Return strips in sway, and in heave for a vehicle under water, as deep as the projected area asks for."""
    length = form.size[0]
    center = float(form.low[0] + 0.5 * length)
    tables, reasons = [], []
    for plane, axis in (("sway", 1),) if form.floats else (("sway", 1), ("heave", 2)):
        area = form.lever_area(axis, 0, 0)
        table = {
            "plane": plane,
            "length": float(length),
            "center": center if abs(center) > 1e-9 * length else 0.0,
            "depth": area / float(length),
        }
        if form.floats:
            table["beam"] = form.lever_area(2, 0, 0) / float(length)  # of all hulls, as the depth is
            law = "Hoerner's curve at beam over twice the draft (Hoerner 1965; Fossen 2021, ch. 6)"
        else:
            law, table["drag_coefficient"] = {
                "open_frame": ("a cube, face on (Hoerner 1965, ch. 3)", CUBE),
                "torpedo": ("a long cylinder (Hoerner 1965, ch. 3; Prestero 2001)", CYLINDER),
                "ellipsoid": ("a sphere (Hoerner 1965, ch. 3)", SPHERE),
            }.get(form.shape, ("a long cylinder (Hoerner 1965, ch. 3)", CYLINDER))
        tables.append(table)
        reasons.append(
            f"{plane} and {'yaw' if axis == 1 else 'pitch'}: {area:.4g} m^2 of side in strips, C_D of {law}"
        )
    return tuple(tables), tuple(reasons)


def linear_damping(
    form: Form, drag: Drag, mass_matrix: Array, stiffness: Array, radiated: Array | None
) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return the diagonal of the linear damping, and what it is made of.

    Args:
        form: of the hull.
        drag: its quadratic drag.
        mass_matrix: M, shape (6, 6).
        stiffness: of heave, roll and pitch, shape (6,), diagonal; 0 where nothing rights.
        radiated: radiation damping at each axis's natural frequency, shape (6,); None if it was not solved.
    """
    slow = SLOW * form.speed
    rates = np.array([slow] * 3 + [slow / (0.5 * float(form.size[0]))] * 3)
    linear = drag.own_axis * rates
    reasons = [
        f"linear, an estimate: what the quadratic takes at {slow:.4g} m/s, {SLOW:.0%} of the design speed"
    ]
    critical = 2.0 * np.sqrt(np.diag(mass_matrix) * np.maximum(stiffness, 0.0))
    if not form.floats:
        least = SUBMERGED_RELATIVE_DAMPING * critical
        linear[3:5] = np.maximum(linear[3:5], least[3:5])
        if (critical[3:5] > 0.0).any():
            reasons.append(
                f"roll, pitch: at least a relative damping of {SUBMERGED_RELATIVE_DAMPING:g}, an estimate"
            )
        return tuple(linear.tolist()), tuple(reasons)
    for motion, axis in (("heave", 2), ("roll", 3), ("pitch", 4)):
        if radiated is None or motion == "roll":
            linear[axis] += RELATIVE_DAMPING[motion] * critical[axis]
            reasons.append(f"{motion}: a relative damping of {RELATIVE_DAMPING[motion]:g}, an estimate")
        if radiated is not None:
            linear[axis] += max(float(radiated[axis]), 0.0)
            reasons.append(
                f"{motion}: {radiated[axis]:.4g} of wave radiation at the natural frequency (wave_share, which "
                'radiation = "memory" takes out)'
            )
    return tuple(linear.tolist()), tuple(reasons)
