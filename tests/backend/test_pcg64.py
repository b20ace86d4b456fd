"""The compiled PCG64 against NumPy's: seeds, streams and states, bit for bit."""

import numpy as np
import pytest
from gymnasium.utils.seeding import np_random
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.pcg64 import (
    STATE_WORDS,
    fill_seeded,
    next_uniform,
    seeded_words,
    state_of,
    words_of,
)
from dq_marine.errors import InvalidInputError

EDGE_SEEDS = [0, 1, 2**31, 2**32 - 1, 2**32, 2**63, 2**64 - 1, 2**64, 2**64 + 5, 2**100 + 2**40, 2**128 - 1]
SEEDS = st.integers(0, 2**128 - 1)
WORDS = st.lists(st.sampled_from([0, 1, 2**32 - 1, 2**32, 2**63, 2**64 - 1]), min_size=4, max_size=4)


def fill_uniform(words, numbers):
    """Fill an array as `Generator.random(len(numbers))` would, advancing the generator."""
    for k in range(len(numbers)):
        numbers[k] = next_uniform(words)


compiled_next = compile_function(next_uniform, "tests")
compiled_fill = compile_function(fill_uniform, "tests")


def generator_from(words):
    """NumPy's generator in the state of the words."""
    generator = np.random.Generator(np.random.PCG64())
    generator.bit_generator.state = state_of(words)
    return generator


def drawn(words, count):
    """Numbers drawn by compiled code, which advances the words."""
    numbers = np.full(count, np.nan)
    compiled_fill(words, numbers)
    return numbers


@given(seed=SEEDS)
def test_the_stream_is_gymnasiums(seed):
    expected = np_random(seed)[0].random(100)
    assert np.array_equal(drawn(seeded_words(seed), 100), expected)


def test_a_long_stream_keeps_every_bit():
    words, generator = seeded_words(20), np_random(20)[0]
    assert np.array_equal(drawn(words, 1_000_000), generator.random(1_000_000))
    assert state_of(words) == generator.bit_generator.state


@given(words=st.one_of(WORDS, st.lists(st.integers(0, 2**64 - 1), min_size=4, max_size=4)))
@pytest.mark.parametrize("draw", [compiled_next, next_uniform], ids=["compiled", "plain"])
def test_a_step_from_any_state(draw, words):
    """Words of ones and zeros too, where carries run through all 128 bits."""
    words = np.array(words, dtype=np.uint64) | np.array([0, 0, 0, 1], dtype=np.uint64)
    generator = generator_from(words)
    for _ in range(3):
        number = draw(words)
        assert type(number) is float
        assert number == generator.random()
    assert state_of(words) == generator.bit_generator.state


@given(seed=SEEDS, before=st.integers(0, 50), compiled=st.integers(0, 50))
def test_a_stream_passes_from_numpy_to_compiled_code_and_back(seed, before, compiled):
    generator, expected = np_random(seed)[0], np_random(seed)[0].random(before + compiled + 10)
    generator.random(before)
    words = words_of(generator.bit_generator.state)
    assert np.array_equal(drawn(words, compiled), expected[before : before + compiled])
    assert np.array_equal(generator_from(words).random(10), expected[before + compiled :])


def test_rows_are_separate_streams():
    rows = np.array([seeded_words(seed) for seed in range(3)])
    untouched = rows.copy()
    assert np.array_equal(drawn(rows[1], 5), np_random(1)[0].random(5))
    assert np.array_equal(rows[[0, 2]], untouched[[0, 2]])


@given(seeds=st.lists(st.one_of(SEEDS, st.sampled_from(EDGE_SEEDS)), max_size=20))
def test_many_seeds_at_once_are_as_one_by_one(seeds):
    rows = np.zeros((len(seeds), STATE_WORDS), dtype=np.uint64)
    fill_seeded(rows, seeds, slice(None))
    for row, seed in zip(rows, seeds, strict=True):
        assert state_of(row) == np_random(seed)[0].bit_generator.state


@pytest.mark.parametrize("wide", [[], [2**128], [2**200 + 3]], ids=["narrow", "2^128", "wide"])
def test_edge_seeds(wide):
    seeds = EDGE_SEEDS + wide
    rows = np.zeros((len(seeds), STATE_WORDS), dtype=np.uint64)
    fill_seeded(rows, seeds, slice(None))
    assert [state_of(row) for row in rows] == [np_random(seed)[0].bit_generator.state for seed in seeds]


@pytest.mark.parametrize(
    "where", [np.array([False, True, False, True]), np.array([1, 3]), slice(1, None, 2)], ids=lambda w: str(w)
)
def test_only_the_rows_asked_for_are_seeded(where):
    rows = np.full((4, STATE_WORDS), 7, dtype=np.uint64)
    fill_seeded(rows, [5, 6], where)
    assert np.array_equal(rows[[1, 3]], [seeded_words(5), seeded_words(6)])
    assert np.all(rows[[0, 2]] == 7)


def test_another_bit_generator_is_refused():
    with pytest.raises(InvalidInputError, match=r"'PCG64DXSM'; give the state of a np\.random\.PCG64"):
        words_of(np.random.PCG64DXSM(1).state)


def test_half_a_draw_is_refused_and_the_remedy_helps():
    generator = np_random(1)[0]
    generator.integers(2**32, dtype=np.uint32)
    with pytest.raises(InvalidInputError, match=r"has_uint32 is 1: .* draw one more 32-bit number"):
        words_of(generator.bit_generator.state)
    generator.integers(2**32, dtype=np.uint32)
    words = words_of(generator.bit_generator.state)
    assert np.array_equal(drawn(words, 3), generator.random(3))
