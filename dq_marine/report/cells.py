"""Free motions far beyond a vehicle's: fast, heavy, light, badly conditioned, far away, with large steps."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.physics import Physics
from dq_marine.report.plan import Plan

Array = NDArray[np.float64]

FACTORS: dict[str, tuple[float, ...]] = {
    "spin": (0.0, 1.0, 30.0, 1000.0),
    "speed": (0.1, 3.0, 100.0),
    "mass": (1e-3, 1e3, 1e9),
    "condition": (1.0, 1e3, 1e6),
    "step": (1e-3, 0.02, 0.2),
    "distance": (0.0, 1e6),
}
"""What is varied: rad/s, m/s, kg, 1, s, m."""

FEW: dict[str, tuple[float, ...]] = {
    "spin": (1.0, 1000.0),
    "speed": (0.1, 100.0),
    "mass": (1e-3, 1e9),
    "condition": (1.0, 1e6),
    "step": (1e-3, 0.2),
    "distance": (0.0, 1e6),
}
"""The same with --quick."""


@dataclass(frozen=True)
class Cell:
    """One motion.

    Attributes:
        index: in the grid.
        levels: of what is varied.
        physics: the free body.
        position: at the start [m], shape (3,).
        quaternion: at the start, shape (4,).
        velocity: at the start, in Fossen's order, shape (6,).
    """

    index: int
    levels: dict[str, float]
    physics: Physics
    position: Array
    quaternion: Array
    velocity: Array

    @property
    def step(self) -> float:
        """Step size [s]."""
        return self.levels["step"]


def levels_of(plan: Plan) -> dict[str, tuple[float, ...]]:
    """Return what is varied in a run."""
    return plan.pick(FACTORS, FEW)


def cells(plan: Plan) -> list[Cell]:
    """Return a motion for each combination of levels, each with directions and inertia drawn for itself."""
    levels = levels_of(plan)
    combinations = product(*levels.values())
    return [
        cell(index, dict(zip(levels, values, strict=True)), plan.seed)
        for index, values in enumerate(combinations)
    ]


def cell(index: int, levels: dict[str, float], seed: int) -> Cell:
    """Return the motion of given levels."""
    rng = np.random.default_rng([seed, index])
    mass_matrix = levels["mass"] * random_inertia(rng, levels["condition"])
    velocity = np.concatenate(
        [levels["speed"] * random_direction(rng, 3), levels["spin"] * random_direction(rng, 3)]
    )
    return Cell(
        index,
        levels,
        Physics(mass_matrix),
        levels["distance"] * random_direction(rng, 3),
        random_direction(rng, 4),
        velocity,
    )


def random_inertia(rng: np.random.Generator, condition: float) -> Array:
    """Return a symmetric positive definite M of shape (6, 6), coupled, with eigenvalues from 1 to `condition`."""
    basis, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    matrix = basis @ np.diag(np.geomspace(1.0, condition, 6)) @ basis.T
    return np.asarray(0.5 * (matrix + matrix.T))


def random_direction(rng: np.random.Generator, size: int) -> Array:
    """Return a unit vector."""
    direction = rng.normal(size=size)
    return np.asarray(direction / np.linalg.norm(direction))


def summary(plan: Plan) -> dict[str, Any]:
    """Return what decides the cells."""
    return {"seed": plan.seed, "levels": {name: list(values) for name, values in levels_of(plan).items()}}
