"""Charted seabeds and grids of distances: closed forms, what is between samples, and lanes that equal singles."""

import functools
import itertools
import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from dq_marine.algebra.distances import sphere_distance
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type
from dq_marine.backend.simd.lanes import lanes_of
from dq_marine.backend.simd.rows import make_load_rows, store_rows
from dq_marine.task.world.charts import FAR, charted, make_chart, make_grid_distance, sampled

ROWS, COLUMNS, SPACING, SOUTH, WEST = 6, 5, 2.0, -3.0, 10.0
CHART = make_chart(ROWS, COLUMNS)
CENTER, RADIUS, COUNTS, FIRST, STEP = (1.0, -0.5, 2.0), 1.2, (17, 15, 19), (-1.0, -2.2, 0.0), 0.25
GRID_DISTANCE = make_grid_distance(*COUNTS)

seeds = st.integers(0, 10**6)
norths, easts = st.floats(-5.0, 12.0), st.floats(5.0, 25.0)
coordinate = st.floats(-6.0, 8.0)


def chart(seed):
    return charted(
        np.random.default_rng(seed).uniform(20.0, 24.0, (ROWS, COLUMNS)).tolist(), SOUTH, WEST, SPACING
    )


@functools.cache
def ball():
    return sampled(lambda p: sphere_distance(p, CENTER, RADIUS), FIRST, STEP, COUNTS)


def test_samples_of_a_chart_are_met_exactly():
    depths = np.random.default_rng(3).uniform(20.0, 24.0, (ROWS, COLUMNS))
    own = charted(depths.tolist(), SOUTH, WEST, SPACING)
    for i, j in itertools.product(range(ROWS), range(COLUMNS)):
        assert CHART.depth(own, SOUTH + i * SPACING, WEST + j * SPACING) == pytest.approx(depths[i, j])


@given(north=norths, east=easts, a=st.floats(-0.5, 0.5), b=st.floats(-0.5, 0.5), c=st.floats(-0.1, 0.1))
def test_a_bilinear_depth_is_found_everywhere_and_goes_on_at_the_edges(north, east, a, b, c):
    def depth(x, y):
        return 20.0 + a * x + b * y + c * x * y

    rows = [SOUTH + i * SPACING for i in range(ROWS)]
    columns = [WEST + j * SPACING for j in range(COLUMNS)]
    own = charted([[depth(x, y) for y in columns] for x in rows], SOUTH, WEST, SPACING)
    held = np.clip(north, rows[0], rows[-1]), np.clip(east, columns[0], columns[-1])
    assert CHART.depth(own, north, east) == pytest.approx(depth(*held))


@given(seed=seeds, one=st.tuples(norths, easts), other=st.tuples(norths, easts))
def test_a_chart_is_nowhere_steeper_than_it_says(seed, one, other):
    own = chart(seed)
    change = abs(CHART.depth(own, *one) - CHART.depth(own, *other))
    assert change <= own.steepest * math.dist(one, other) + 1e-9


@given(seed=seeds, heading=st.floats(-math.pi, math.pi), tilt=st.floats(0.0, 0.6))
@example(seed=0, heading=2.0, tilt=2.087572321298175e-09)  # from one patch's corner slowly into another patch
def test_a_beam_ends_at_the_chart_and_never_passes_it(seed, heading, tilt):
    """A beam that would leave its cell only after `FAR` counts as staying in it, and is off by what it crosses."""
    own, origin = chart(seed), (1.0, 14.0, 15.0)
    direction = (math.sin(tilt) * math.cos(heading), math.sin(tilt) * math.sin(heading), math.cos(tilt))
    found = CHART.cast(own, origin, direction, 40.0)
    ways = np.linspace(0.0, found, 200)
    points = np.array(origin) + ways[:, None] * np.array(direction)
    heights = np.array([CHART.depth(own, x, y) - z for x, y, z in points])
    across = math.sqrt(2.0) * SPACING * found / FAR
    assert (heights >= -1e-9 - 2.0 * own.steepest * across).all()
    assert heights[-1] == pytest.approx(0.0, abs=0.05)
    assert CHART.cast(own, origin, direction, 2.0) == 2.0


@given(seed=seeds, heading=st.floats(-math.pi, math.pi), dip=st.floats(-0.3, 0.5))
def test_a_beam_that_grazes_a_chart_is_followed_to_where_it_meets_it(seed, heading, dip):
    own, reach = chart(seed), 20.0
    origin = (1.0, 14.0, CHART.depth(own, 1.0, 14.0) - 1.0)
    level = math.cos(dip)
    direction = (level * math.cos(heading), level * math.sin(heading), math.sin(dip))
    found = CHART.cast(own, origin, direction, reach)
    ways = np.arange(0.0, reach, 0.005)
    points = np.array(origin) + ways[:, None] * np.array(direction)
    below = [CHART.depth(own, x, y) <= z for x, y, z in points]
    marched = ways[below.index(True)] if any(below) else reach
    assert marched - 0.006 <= found <= marched + 1e-9
    with pytest.MonkeyPatch.context() as patch:  # a march that ends early is where all steps would lead
        patch.setattr("dq_marine.task.world.charts.every", lambda condition: False)
        assert CHART.cast(own, origin, direction, reach) == found


@given(seed=seeds, north=norths, east=easts, heading=st.floats(-math.pi, math.pi))
def test_the_growth_of_the_depth_is_what_the_depth_gains_on_a_short_way(seed, north, east, heading):
    own, way, short = chart(seed), (math.cos(heading), math.sin(heading)), 1e-6
    depth, growth = CHART.along(own, north, east, *way)
    assert depth == CHART.depth(own, north, east)
    ends = (CHART.depth(own, north + side * short * way[0], east + side * short * way[1]) for side in (1, -1))
    gained = [(end - depth) / (side * short) for end, side in zip(ends, (1, -1), strict=True)]
    assert min(abs(growth - one) for one in gained) < 1e-4  # on an edge between samples only one side agrees


@given(point=st.tuples(coordinate, coordinate, coordinate))
def test_a_grid_has_the_distance_within_it_and_less_outside(point):
    exact, found = sphere_distance(point, CENTER, RADIUS), GRID_DISTANCE(ball(), point)
    last = np.array(FIRST) + STEP * (np.array(COUNTS) - 1)
    if (np.array(point) >= FIRST).all() and (np.array(point) <= last).all():
        near_center = math.dist(point, CENTER) < 2.0 * STEP  # where the distance has a kink
        assert found == pytest.approx(exact, abs=0.25 if near_center else 0.03)
    else:
        away = np.linalg.norm(np.array(point) - np.clip(point, FIRST, last))
        assert found <= exact + 0.03
        assert found >= away - 1e-12


@given(one=st.tuples(coordinate, coordinate, coordinate), other=st.tuples(coordinate, coordinate, coordinate))
def test_a_step_by_the_grids_distance_never_passes_the_ball(one, other):
    """It is what sphere tracing asks of it: nothing of the shape is nearer."""
    way = np.array(other) - one
    assert (
        sphere_distance(tuple(np.array(one) + way), CENTER, RADIUS) >= -1e-9
        or GRID_DISTANCE(ball(), one) <= np.linalg.norm(way) + 0.03
    )


@functools.cache
def compiled(precision):
    """Compile (rows of points, chart's numbers, grid's numbers, results), for one block of lanes or row by row."""
    depth, load_chart, load_grid = (
        CHART.depth,
        make_load(structure_type(chart(0))),
        make_load(structure_type(ball())),
    )

    def found(charts, grids, x, y, z):
        return (depth(load_chart(charts), x, y), GRID_DISTANCE(load_grid(grids), (x, y, z)))

    if precision is None:

        def apply(points, charts, grids, results):
            for row in range(points.shape[0]):
                x, y, z = points[row, 0], points[row, 1], points[row, 2]
                store(results[row], found(charts, grids, x, y, z))

    else:
        load_rows = make_load_rows(lanes_of(precision, "strict"), 3)

        def apply(points, charts, grids, results):
            x, y, z = load_rows(points, 0)
            store_rows(results, 0, found(charts, grids, x, y, z))

    return compile_function(apply, f"charts {precision}")


@pytest.mark.parametrize("precision", ["float64", "float32"])
def test_each_lane_reads_its_own_entries_as_a_single_body_does(precision):
    own, width = chart(7), lanes_of(precision, "strict").width
    points = np.random.default_rng(5).uniform(-4.0, 12.0, (width, 3))
    points[0] = (math.nan, math.inf, -math.inf)  # reads some entry, not beyond the table
    charts, grids = pack(own), pack(ball())
    lanes, singles = np.zeros((width, 2)), np.zeros((width, 2))
    compiled(precision)(points, charts, grids, lanes)
    compiled(None)(points, charts, grids, singles)
    plain = [(CHART.depth(own, x, y), GRID_DISTANCE(ball(), (x, y, z))) for x, y, z in points[1:].tolist()]
    assert np.array_equal(singles[1:], plain)
    if precision == "float64":
        assert np.array_equal(lanes[1:], singles[1:])
    assert np.allclose(lanes[1:], singles[1:], rtol=1e-4, atol=1e-4)
