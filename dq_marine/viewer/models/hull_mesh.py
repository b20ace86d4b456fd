"""Meshes of ships' hulls: lofted through levels of outlines, alike to port and to starboard."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dq_marine.viewer.meshes import Mesh, flat_polygon, joined
from dq_marine.viewer.snapshot import FloatArray

STATIONS = np.concatenate([np.linspace(0.0, 0.5, 4), np.linspace(0.58, 1.0, 10)])
"""Places along an outline, from stern to bow: closer where it narrows."""


@dataclass(frozen=True)
class Level:
    """One outline of a hull, seen from above.

    Attributes:
        z: its depth [m].
        stern: x of its straight end [m].
        bow: x of its point [m].
        half_width: largest [m].
        shoulder: share of its length, from the stern, after which it narrows.
        rise: how much higher it lies at the bow [m].
    """

    z: float
    stern: float
    bow: float
    half_width: float
    shoulder: float = 0.6
    rise: float = 0.0

    def points(self) -> FloatArray:
        """Its starboard side from stern to bow, shape (n, 3)."""
        ahead = np.maximum(0.0, (STATIONS - self.shoulder) / (1.0 - self.shoulder))
        y = self.half_width * (1.0 - ahead**2)
        return np.column_stack(
            [self.stern + STATIONS * (self.bow - self.stern), y, self.z - self.rise * ahead**2]
        )


def lofted(levels: Sequence[Level]) -> Mesh:
    """The closed surface through levels, the deepest first, with a flat bottom, a deck and a straight stern."""
    sides = np.array([level.points() for level in levels])
    mirrored = sides * [1.0, -1.0, 1.0]
    return joined(
        [
            *_walls(sides, np.array([0.0, 1.0, 0.0])),
            *_walls(mirrored, np.array([0.0, -1.0, 0.0])),
            *_lid(sides[0], np.array([0.0, 0.0, 1.0])),
            *_lid(sides[-1], np.array([0.0, 0.0, -1.0])),
            *(
                _facing(np.array([mirrored[i, 0], sides[i, 0], sides[i + 1, 0], mirrored[i + 1, 0]]), _AFT)
                for i in range(len(levels) - 1)
            ),
        ]
    )


_AFT = np.array([-1.0, 0.0, 0.0])


def _walls(sides: FloatArray, outward: FloatArray) -> list[Mesh]:
    """One side of the hull, between levels and stations, shape (levels, stations, 3)."""
    return [
        _facing(np.array([low[k], low[k + 1], high[k + 1], high[k]]), outward)
        for low, high in pairwise(sides)
        for k in range(len(low) - 1)
    ]


def _lid(side: FloatArray, outward: FloatArray) -> list[Mesh]:
    """The surface between an outline's two sides."""
    other = side * [1.0, -1.0, 1.0]
    return [
        _facing(np.array([other[k], side[k], side[k + 1], other[k + 1]]), outward)
        for k in range(len(side) - 1)
    ]


def _facing(corners: FloatArray, outward: FloatArray) -> Mesh:
    """A quadrangle whose normal points outwards rather than inwards; its last two corners may be one."""
    if np.cross(corners[1] - corners[0], corners[2] - corners[0]) @ outward >= 0.0:
        return flat_polygon(corners)
    return flat_polygon(corners[[1, 0, 3, 2]])
