"""What a mesh does not say, and a sentence on how it is estimated: mass, its distribution, kind of hull, thrust."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.choices import Choices
from dq_marine.meshes.hull import Hull
from dq_marine.meshes.rounding import rounded
from dq_marine.meshes.surface import Array

BALLAST = 0.05
"""Depth of the centre of mass below that of buoyancy, over the height, of a vehicle under water: those of the catalogue
have 0.06 to 0.10."""

FROUDE = 0.2
"""Of a hull afloat at the speed that its damping is estimated for, U / sqrt(g L)."""

SUBMERGED_SPEED = 1.5
"""Of a vehicle under water [m/s]: 3 knots."""

MARGIN = 1.5
"""Thrust over the drag at that speed."""

LARGEST_TRIM = 0.02
"""Angle [rad] by which weight and buoyancy may turn a hull afloat away from how its mesh lies."""

SLENDER = 4.0
"""Length over the mean of width and height from which a vehicle under water is taken for a torpedo."""

ELLIPSOID_FILL, FILL_TOLERANCE = math.pi / 6.0, 0.02
"""Volume over its box's of an ellipsoid, and how near others are taken for one."""


def rigid_body(hull: Hull, choices: Choices) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return the table `rigid_body` of a vehicle file, and what it is made of."""
    reasons = [f"mass: {'given' if choices.mass else 'that of the displaced water'}"]
    if choices.center_of_mass is not None:
        center = np.array(choices.center_of_mass, dtype=np.float64)
        reasons.append("centre of mass: given")
    elif choices.floats:
        center = np.array([*hull.center_of_buoyancy[:2], hull.solid.center[2]])
        reasons.append(
            "centre of mass: above that of buoyancy, as high as the centroid of the hull, as an estimate"
        )
    else:
        center = hull.center_of_buoyancy + np.array([0.0, 0.0, BALLAST * float(hull.surface.extent[2])])
        reasons.append(f"centre of mass: {BALLAST:g} of the height below that of buoyancy, as an estimate")
    if choices.inertia is not None:
        inertia = np.diag(np.array(choices.inertia, dtype=np.float64))
        reasons.append("inertia: given")
    else:
        inertia = hull.mass * hull.solid.squared_gyration
        inertia = np.where(np.abs(inertia) < 1e-9 * np.trace(inertia), 0.0, inertia)
        reasons.append("inertia: of a uniform filling of the whole hull, scaled to the mass, as an estimate")
    table = {
        "mass": hull.mass,
        "center_of_mass": center,
        "inertia_about": "center_of_mass",
        "inertia": inertia,
    }
    return rounded(table), tuple(reasons)


def righting_stiffness(hull: Hull, center_of_mass: Array, choices: Choices, mesh: Path) -> Array:
    """Return the stiffness of heave, roll and pitch about the body origin, shape (3, 3) [N/m, N, N m].

    Raises:
        InvalidInputError: a hull afloat capsizes, or does not lie as its mesh does.
    """
    weight, specific = hull.mass * choices.gravity, choices.density * choices.gravity
    if hull.waterplane is None:
        righting = weight * center_of_mass[2] - specific * hull.volume * hull.center_of_buoyancy[2]
        return np.diag([0.0, righting, righting])
    stiffness = hull.waterplane.stiffness(weight, center_of_mass, specific)
    stiffness = np.where(
        np.abs(stiffness) < 1e-9 * np.sqrt(np.outer(*2 * [np.abs(np.diag(stiffness))])), 0.0, stiffness
    )
    # About the centre of flotation, where heave is not coupled with roll and pitch.
    turning = stiffness[1:, 1:] - np.outer(stiffness[1:, 0], stiffness[0, 1:]) / stiffness[0, 0]
    if np.linalg.eigvalsh(turning).min() <= 0.0:
        heights = turning.diagonal() / weight
        raise InvalidInputError(
            f"{mesh} capsizes with its centre of mass at z = {center_of_mass[2]:.4g} m (down is positive): "
            f"its metacentric heights are {heights[0]:.4g} m in roll, {heights[1]:.4g} m in pitch; "
            "give a lower --center-of-mass"
        )
    forward, starboard, _ = center_of_mass - hull.center_of_buoyancy
    angles = np.linalg.solve(turning, weight * np.array([starboard, -forward]))
    if np.abs(angles).max() > LARGEST_TRIM:
        raise InvalidInputError(
            f"{mesh} heels by {math.degrees(angles[0]):.3g} and trims by {math.degrees(angles[1]):.3g} degrees with "
            f"its centre of mass {forward:.4g} m ahead and {starboard:.4g} m to starboard of that of buoyancy (at most "
            f"{math.degrees(LARGEST_TRIM):.2g}); turn the mesh as it floats, or give another --center-of-mass"
        )
    return np.asarray(stiffness)


def shape_of(hull: Hull, choices: Choices) -> str:
    """Return the kind of hull, given or guessed from its proportions."""
    if choices.shape is not None:
        return choices.shape
    if choices.floats:
        return "ship"
    length, width, height = (float(side) for side in hull.surface.extent)
    if length > SLENDER * 0.5 * (width + height):
        return "torpedo"
    fill = hull.solid.volume / (length * width * height)
    return "ellipsoid" if abs(fill - ELLIPSOID_FILL) < FILL_TOLERANCE else "open_frame"


def speed_of(hull: Hull, choices: Choices) -> float:
    """Return the speed that damping is estimated for [m/s], given or by Froude's number."""
    if choices.speed is not None:
        return float(choices.speed)
    if choices.floats:
        return FROUDE * math.sqrt(choices.gravity * float(hull.surface.extent[0]))
    return SUBMERGED_SPEED


def wrench_limits(hull: Hull, choices: Choices, drag: float, speed: float) -> tuple[Array, str]:
    """Return the largest force and moment of the actuators, shape (6,), and what they are made of.

    Args:
        hull: that they drive.
        choices: what is known of them.
        drag: at the design speed, ahead [N].
        speed: the design speed [m/s].
    """
    if choices.limits is not None:
        return np.array(choices.limits, dtype=np.float64), "given"
    thrust = MARGIN * drag
    length, width, _ = hull.surface.extent
    deep = 0.0 if choices.floats else 1.0
    limits = thrust * np.array(
        [1.0, 0.5, 0.5 * deep, 0.25 * width * deep, 0.25 * length * deep, 0.25 * length]
    )
    return limits, (
        f"an estimate, to be replaced: ahead {MARGIN:g} times the drag at {speed:.4g} m/s, half of that across, "
        "moments at a quarter of length and width"
    )
