"""Products added to single numbers of a structure: against arrays, in plain Python, compiled and in lanes."""

import functools
from typing import NamedTuple

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from support.lane_numbers import by_rows, in_lanes, rows_of, same_bits

from dq_marine.algebra.entries import Places, add_products
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type, unpack


class Pair(NamedTuple):
    """A structure with a name, as a spatial vector is."""

    first: tuple
    second: tuple


LIKE = Pair((0.0, 0.0, 0.0), ((0.0, 0.0), 0.0))
SIZE = 6

finite = st.floats(-1e3, 1e3)
places = st.lists(st.tuples(*[st.integers(0, SIZE - 1)] * 3), max_size=8).map(Places)
structures = st.lists(finite, min_size=SIZE, max_size=SIZE).map(np.array)


def added(where, target, first, second):
    """The same with arrays."""
    total = target.copy()
    for place, i, j in where:
        total[place] += first[i] * second[j]
    return total


@given(where=places, target=structures, first=structures, second=structures)
def test_products_are_added_where_they_are_to_be(where, target, first, second):
    got = add_products(where, *(unpack(LIKE, numbers) for numbers in (target, first, second)))
    assert isinstance(got, Pair)
    assert same_bits(pack(got), added(where, target, first, second))


def test_one_number_may_be_a_factor():
    got = add_products(Places([(1, 0, 2), (1, 0, 0)]), (1.0, 2.0), 3.0, Pair((4.0, 5.0), (6.0,)))
    assert got == (1.0, 2.0 + 18.0 + 12.0)


def test_no_products_leave_all_as_it_is():
    assert isinstance(add_products(Places(), LIKE, (), ()), Pair)
    assert add_products(Places(), LIKE, (), ()) == LIKE


@functools.cache
def compiled(where):
    load = make_load(structure_type(LIKE))

    def run(arrays, result):
        target, first, second = load(arrays[0]), load(arrays[1]), load(arrays[2])
        store(result, add_products(where, target, first, second))

    return compile_function(run, "entries")


@settings(max_examples=8, deadline=None)
@given(where=places, target=structures, first=structures, second=structures)
def test_compiled_code_adds_the_same_bits(where, target, first, second):
    result = np.empty(SIZE)
    compiled(where)(np.stack([target, first, second]), result)
    assert same_bits(result, added(where, target, first, second))


MIXED = Places([(0, 0, 1), (2, 1, 0), (0, 1, 0), (1, 0, 0)])


def mixed(a, b):
    """Numbers that are the same for all bodies, and some that are not, in all three places."""
    zeros = (0.0, (2.0, 0.0))
    return (
        add_products(MIXED, zeros, (a, 3.0), (b, 0.5)),
        add_products(MIXED, (a, (b, a)), (0.5, 2.0), (3.0, 4.0)),
        add_products(MIXED, (b, (1.0, a)), (a, b), (0.25, b)),
    )


@settings(max_examples=50)
@given(rows=rows_of(2))
def test_every_lane_has_the_bits_of_a_single_body(rows):
    assert same_bits(in_lanes(mixed, rows, 9), by_rows(mixed, rows, 9))
