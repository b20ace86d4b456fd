"""Numbers at several stages: the same bits in plain Python, compiled for one body, and for bodies in lanes."""

import math

import numpy as np
import pytest
from support.sweeps import sweep

from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled
from dq_marine.algebra.stages import (
    Stages,
    each_stage,
    for_each,
    stage_constants,
    stage_product,
    stage_sum,
    stages_apart,
    stages_together,
    weighted_step,
    weighted_sum,
)
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type
from dq_marine.backend.simd.lanes import lanes_of
from dq_marine.backend.simd.packing import (
    empty_blocks,
    make_load_block,
    make_store_block,
    pack_blocks,
    packing_of,
    unpack_blocks,
)

LIKE = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
SHARED = 0.7


def swing(strength, a, time):
    """Something with a branch, a library function and a square root."""
    x, y, z = a.angular
    turned = select(x > 0.3, math.sin(strength * x), y * z)
    return Spatial((turned, math.sqrt(x * x + 1.0), strength * time), a.linear)


def make_exercise(count):
    """All that `algebra.stages` has, for a number of stages."""
    rng = np.random.default_rng(count)
    matrix = tuple(tuple(row) for row in rng.normal(size=(count, count)).tolist())
    weights = tuple(rng.normal(size=count).tolist())

    def exercise(strength, a):
        times = stage_constants(weights, a.linear[0])
        y = each_stage(weights, spatial_add_scaled, (a, times, a))
        for _ in range(2):
            k = each_stage(weights, swing, (strength, y, times))
            y = each_stage(weights, spatial_add, (a, stage_product(matrix, k)))
        apart = stages_apart(weights, y)
        y = each_stage(weights, spatial_add, (y, stages_together(apart)))
        reached = weighted_step(a, 0.3 * strength, weights, apart)
        return spatial_add(spatial_add(stage_sum(weights, y), weighted_sum(weights, apart)), reached)

    return exercise


def make_cases(count):
    """A function for a number of cases, each with numbers of its own."""
    cases = tuple(map(tuple, np.random.default_rng(count).normal(size=(count, 2)).tolist()))

    def one(case, others):
        strength, a = others
        return swing(case[0] * strength, a, case[1])

    def exercise(strength, a):
        for found in for_each(cases, one, (strength, a)):
            a = spatial_add_scaled(found, 0.5, a)
        return a

    return exercise


@pytest.mark.parametrize(
    ("make", "count"),
    sweep(
        [
            *((make_exercise, count) for count in (1, 2, 3, 4)),
            *((make_cases, count) for count in (1, 2, 6, 9, 17)),
        ],
        plain=[(make_exercise, 3), (make_cases, 6)],
    ),
)
def test_the_same_bits_however_they_are_computed(make, count):
    exercise = make(count)
    load = make_load(structure_type(LIKE))

    def alone(numbers, result):
        store(result, exercise(numbers[6], load(numbers)))

    compiled = compile_function(alone, f"{make.__name__} {count}")
    rows = np.random.default_rng(0).uniform(-1.0, 1.0, size=(8, 6))
    results = np.empty((8, 6))
    for row, result in zip(rows, results, strict=True):
        compiled(np.append(row, SHARED), result)
        a = Spatial(tuple(row[:3].tolist()), tuple(row[3:].tolist()))
        assert np.array_equal(pack(exercise(SHARED, a)), result)
    for shared in (True, False):
        assert np.array_equal(in_lanes(exercise, rows, shared, f"{make.__name__} {count}"), results)


def in_lanes(exercise, rows, shared, key):
    """The results of bodies in lanes, whose strength is one for all or one for each."""
    lanes = lanes_of("float64", "strict")
    packing = packing_of((SHARED, LIKE), lanes, lambda path: shared and path == (0,))
    outcome = packing_of(LIKE, lanes, lambda path: False)
    load, save = make_load_block(packing), make_store_block(outcome)

    def block(common, bodies, results):
        strength, a = load(common, bodies, 0)
        save(results, 0, exercise(strength, a))

    bodies, results = empty_blocks(packing, 8, lanes), empty_blocks(outcome, 8, lanes)
    pack_blocks(packing, np.column_stack([np.full(8, SHARED), rows]), bodies)
    compile_function(block, f"{key} {packing.key}")(np.array([SHARED]), bodies, results)
    return unpack_blocks(outcome, np.empty(0), results, 8)


def test_sums_are_taken_in_pairs():
    big = 2.0**53
    assert stage_sum((1.0, 1.0, 1.0, 1.0), Stages((big, 1.0, -big, 1.0))) == (big + 1.0) + (-big + 1.0)
