"""Nested tuples in flat arrays: round trips, in Python and compiled."""

import math
from typing import NamedTuple

import numba
import numpy as np

from dq_marine.backend.packing import Unpacker, make_load, pack, store, structure_type, unpack


class Inner(NamedTuple):
    a: float
    b: tuple[float, float]


class Outer(NamedTuple):
    first: Inner
    nothing: tuple[()]
    rest: tuple


VALUE = Outer(Inner(1.0, (2.0, 3.0)), (), (4.0, Inner(5.0, (6.0, 7.0))))


def test_pack_and_unpack_are_inverse():
    numbers = pack(VALUE)
    assert numbers.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    assert unpack(VALUE, numbers) == VALUE
    assert isinstance(unpack(VALUE, numbers).rest[1], Inner)


def test_an_unpacker_follows_every_bit_and_keeps_the_parts_that_stay():
    numbers, unpacked = pack(VALUE), Unpacker(VALUE)
    first = unpacked(numbers)
    assert first == VALUE
    assert isinstance(first, Outer)
    assert unpacked(numbers.copy()) is first
    numbers[5] = -0.0
    changed = unpacked(numbers)
    assert math.copysign(1.0, changed.rest[1].b[0]) == -1.0
    assert changed.first is first.first
    numbers[5] = 0.0
    assert math.copysign(1.0, unpacked(numbers).rest[1].b[0]) == 1.0
    assert first == VALUE


def test_compiled_load_and_store_are_inverse_and_cast():
    load = make_load(structure_type(VALUE))

    @numba.njit
    def copy(source, target):
        value = load(source)
        store(target, value)
        return value.rest[1].b[0]

    source = pack(VALUE)
    for dtype in (np.float64, np.float32):
        target = np.zeros(7, dtype=dtype)
        assert copy(source, target) == 6.0
        assert np.array_equal(target, source.astype(dtype))
