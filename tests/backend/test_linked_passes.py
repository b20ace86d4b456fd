"""What functions that only go into others leave out of Numba's compiler changes nothing that they do."""

import sys

import numba
import numpy as np
import pytest
from numba.core.errors import TypingError
from numba.core.runtime import _nrt_python, rtsys
from numba.extending import register_jitable

from dq_marine.backend.inlining import INLINED


def part(function):
    """Let compiled code call a function, as the parts of scenes are called."""
    return register_jitable(**INLINED)(function)


@part
def renamed(pair):
    return (pair[1], (pair[0], 2.0))


@part
def kept_longer(pair):
    longer = renamed(pair)
    again = longer
    return (again[1][0], again[0])


@part
def scaled(array):
    doubled = 2.0 * array + array * array - 1.0
    return (doubled, (3.0, doubled[1:]))


@numba.njit
def passed_on(array, times):
    pair = (array, 1.0)
    for _ in range(times):
        pair = kept_longer(pair)
    return pair[0]


@numba.njit
def made_within(array, times):
    total = 0.0
    for _ in range(times):
        doubled, (factor, rest) = scaled(array)
        total += factor * rest.sum() + doubled[0]
    return total


def test_arrays_in_structures_are_counted():
    """Each that is passed on and dropped again leaves the count of its references as it was."""
    array = np.arange(5.0)
    before = sys.getrefcount(array)
    result = passed_on(array, 1000)
    assert np.array_equal(result, np.arange(5.0))
    del result
    assert sys.getrefcount(array) == before


@pytest.fixture
def allocations():
    """Count what compiled code takes of memory, and gives back."""
    _nrt_python.memsys_enable_stats()
    yield rtsys.get_allocation_stats
    _nrt_python.memsys_disable_stats()


def test_arrays_that_parts_make_are_freed(allocations):
    array = np.linspace(0.0, 1.0, 6)
    doubled = 2.0 * array + array * array - 1.0
    assert made_within(array, 3) == pytest.approx(3 * (3.0 * doubled[1:].sum() + doubled[0]))
    before = allocations()
    made_within(array, 100)
    after = allocations()
    assert after.mi_alloc - before.mi_alloc == after.mi_free - before.mi_free >= 100


def test_an_error_says_which_line_is_wrong():
    @part
    def wrong(number):
        return number.no_such_field

    @numba.njit
    def caller(number):
        return wrong(number)

    with pytest.raises(TypingError, match="no_such_field") as refused:
        caller(1.0)
    assert "return number.no_such_field" in str(refused.value)
