"""What bounds the water: the sandy floor, the surface, specks in between, the vehicle's shadow.

Floor, surface and specks repeat themselves, so that a patch of them can follow the vehicle in whole
periods and seem endless.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dq_marine.physics.waves.sea import Sea
from dq_marine.viewer.meshes import Mesh, flat_polygon, grid_triangles, joined, tetrahedron
from dq_marine.viewer.snapshot import FloatArray, Shape
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import Look, Painted, painted_surface, rgb, surface
from dq_marine.viewer.world.water import both_sides, render_order, surroundings_of

FLOOR = "/world/floor"
SURFACE = "/world/surface"
SPECKS = "/world/specks"
SHADOW = "/world/shadow"

SAND = 0xA79D78
GRID = 0x857C60
SPECK = 0xD8F4FF
BLACK = 0x000000

SAND_LOOK = Look(lit=False, both_sides=True)
SPECK_LOOK = Look(opacity=0.6, lit=False)
SHADOW_LOOK = Look(opacity=0.25, lit=False, both_sides=True)

CELLS_PER_PERIOD = 10
CELLS_PER_STRONG_LINE = 5
PERIODS_EACH_WAY = 3
DIVISIONS_PER_PERIOD = 6
SPECKS_PER_BLOCK = 60
SPECK_IN_BLOCKS = 0.0015

FINE_STEPS, FINE_REACH, STRETCH = 52, 0.55, 1.3
"""Of the mesh of a sea with waves: equal steps each way from the vehicle's origin, how far they go together [lengths of
the vehicle], and the ratio of each of the next ones, which go to the edge of the floor, to the one before."""


@dataclass(frozen=True)
class SeaScale:
    """Sizes of the surroundings, in proportion to the vehicle.

    Attributes:
        size: of the vehicle [m].
        cell: edge of a cell of the grid on the floor [m].
        speck_block: edge of the cube of water that repeats itself, specks and all [m].
    """

    size: float
    cell: float
    speck_block: float

    @classmethod
    def of(cls, shape: Shape) -> SeaScale:
        """The surroundings that suit a vehicle."""
        return cls(size=shape.size, cell=_round_length(shape.size), speck_block=8.0 * shape.size)

    @property
    def period(self) -> float:
        """Distance [m] after which floor and surface look the same again."""
        return CELLS_PER_PERIOD * self.cell

    @property
    def half_sheet(self) -> float:
        """Half the edge of the patch of floor and surface around the vehicle [m]."""
        return PERIODS_EACH_WAY * self.period

    @property
    def sight(self) -> float:
        """Distance at which things vanish in the murk [m]: before the patch comes to its end."""
        return 0.8 * self.half_sheet


def draw_floor(scale: SeaScale, *, afloat: bool) -> list[Message]:
    """A level, sandy sea floor with a grid, to be placed at its depth, for a vehicle that floats or does not."""
    sand, grid = f"{FLOOR}/sand", f"{FLOOR}/grid"
    sheet = _sheet(scale)
    colors = rgb(SAND) * _mottle(sheet, scale.period, depth=0.06)
    # The page writes the size of a cell, and the vehicle's height or depth, next to the clock.
    sand_json = surface(sand, sheet, colors, SAND_LOOK, {"cell": scale.cell, "afloat": afloat})
    grid_json = painted_surface(grid, [Painted(_grid(scale), GRID)], SAND_LOOK)
    return [set_object(sand, sand_json), set_object(grid, grid_json)]


def draw_surface(scale: SeaScale, shape: Shape) -> list[Message]:
    """The surface of a calm sea around a vehicle, to be placed at depth zero."""
    sheet, water = _sheet(scale), surroundings_of(shape)
    colors = rgb(water.surface) * _mottle(sheet, scale.period, water.surface_patches)
    return [_surface_message(sheet, colors, shape, {})]


def draw_waves(scale: SeaScale, shape: Shape, sea: Sea, start: float) -> list[Message]:
    """The surface of a sea with its waves, to be placed at depth zero above the vehicle; the page raises its points.

    Args:
        scale: of the surroundings.
        shape: the vehicle.
        sea: the waves.
        start: time of the sea when the clock shows 0 [s].
    """
    sheet = _stretched_sheet(scale)
    wave_number, directions, frequencies = sea.wave_numbers, sea.directions, sea.frequencies
    columns = (
        sea.amplitudes,
        frequencies,
        wave_number * np.cos(directions),
        wave_number * np.sin(directions),
        np.mod(sea.phases + frequencies * start, 2.0 * np.pi),
    )
    colors = np.tile(rgb(surroundings_of(shape).surface), (len(sheet.vertices), 1))
    return [_surface_message(sheet, colors, shape, {"waves": np.column_stack(columns).tolist()})]


def _surface_message(sheet: Mesh, colors: FloatArray, shape: Shape, data: dict[str, Any]) -> Message:
    water = surroundings_of(shape)
    look = Look(opacity=water.surface_opacity, lit=False, both_sides=True)
    told = {"tint": rgb(water.surface).tolist(), "sides": both_sides(shape)}
    drawn = surface(SURFACE, sheet, colors, look, data | told)
    drawn["object"]["renderOrder"] = render_order(water)
    return set_object(SURFACE, drawn)


def draw_shadow(shape: Shape) -> list[Message]:
    """A dim spot on the floor below the vehicle: it shows how high above the floor that is."""
    around = np.linspace(0.0, 2 * np.pi, 33)[:-1]
    radius = 0.45 * max(shape.length, shape.width)
    rim = np.column_stack([np.cos(around), np.sin(around), np.zeros(len(around))])
    spot = Painted(flat_polygon(radius * rim), BLACK)
    return [set_object(SHADOW, painted_surface(SHADOW, [spot], SHADOW_LOOK))]


def draw_specks(scale: SeaScale) -> list[Message]:
    """Specks that hang in the water: they show motion where nothing else is near.

    They are surfaces, not points: next to points, Chromium's renderer on the processor lights the vehicle now
    with and now without the sun, so that two pictures of one state differ.
    """
    block = np.random.default_rng(seed=1).uniform(0.0, 1.0, (SPECKS_PER_BLOCK, 3))
    corners = np.array(np.meshgrid(*[(-1.0, 0.0)] * 3)).reshape(3, -1).T
    places = scale.speck_block * (block[None, :, :] + corners[:, None, :]).reshape(-1, 3)
    speck = tetrahedron(SPECK_IN_BLOCKS * scale.speck_block)
    specks = joined([Mesh(speck.vertices + place, speck.normals, speck.triangles) for place in places])
    return [set_object(SPECKS, painted_surface(SPECKS, [Painted(specks, SPECK)], SPECK_LOOK))]


def nearest_period(coordinate: float, period: float) -> float:
    """The multiple of `period` [m] that is nearest to a coordinate [m]."""
    return period * round(coordinate / period)


def _round_length(least: float) -> float:
    """The smallest of 1, 2, 5 times a power of ten that is not below `least` [m]."""
    decade = 10.0 ** math.floor(math.log10(least))
    return next(step * decade for step in (1.0, 2.0, 5.0, 10.0) if step * decade >= least)


def _sheet(scale: SeaScale) -> Mesh:
    """A level square in the xy plane around the origin; its normals point up, along -z."""
    points = 2 * PERIODS_EACH_WAY * DIVISIONS_PER_PERIOD + 1
    ticks = np.linspace(-scale.half_sheet, scale.half_sheet, points)
    x, y = (axis.ravel() for axis in np.meshgrid(ticks, ticks))
    vertices = np.column_stack([x, y, np.zeros_like(x)])
    normals = np.tile([0.0, 0.0, -1.0], (len(vertices), 1))
    return Mesh(vertices, normals, grid_triangles(points, points))


def _stretched_sheet(scale: SeaScale) -> Mesh:
    """A level square whose points stand close where the vehicle is and ever farther apart towards the edge."""
    fine = FINE_REACH * scale.size / FINE_STEPS
    count = math.ceil(math.log(1.0 + (STRETCH - 1.0) * scale.half_sheet / (STRETCH * fine), STRETCH))
    steps = np.concatenate([np.full(FINE_STEPS, fine), fine * STRETCH ** np.arange(1, count + 1)])
    ticks = np.concatenate([-np.cumsum(steps)[::-1], [0.0], np.cumsum(steps)])
    x, y = (axis.ravel() for axis in np.meshgrid(ticks, ticks))
    vertices = np.column_stack([x, y, np.zeros_like(x)])
    normals = np.tile([0.0, 0.0, -1.0], (len(vertices), 1))
    return Mesh(vertices, normals, grid_triangles(len(ticks), len(ticks)))


def _mottle(sheet: Mesh, period: float, depth: float) -> FloatArray:
    """Light and dark patches around 1, shape (n, 1), that repeat after `period` [m] in x and in y."""
    u, v = 2 * np.pi * sheet.vertices[:, :2].T / period
    patches = np.sin(2 * u + v) + np.sin(2 * v - u + 1.0) + np.sin(u - v) + np.sin(v + 2.0)
    bright: FloatArray = 1.0 + depth * patches[:, None]
    return bright


def _grid(scale: SeaScale) -> Mesh:
    """Lines as narrow strips just above the sand; every fifth is wider."""
    half, cell = scale.half_sheet, scale.cell
    strips = []
    for number in range(-round(half / cell), round(half / cell) + 1):
        width = cell * (0.05 if number % CELLS_PER_STRONG_LINE == 0 else 0.02)
        near, far = number * cell - width / 2, number * cell + width / 2
        strips.append([(near, -half), (far, -half), (far, half), (near, half)])
        strips.append([(-half, near), (half, near), (half, far), (-half, far)])
    return joined([flat_polygon(_level(strip, -0.01 * cell)) for strip in strips])


def _level(corners: list[tuple[float, float]], z: float) -> FloatArray:
    """Corners (x, y) [m] at the same z, shape (n, 3)."""
    return np.column_stack([np.array(corners), np.full(len(corners), z)])
