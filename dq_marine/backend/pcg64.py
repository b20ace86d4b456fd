"""NumPy's PCG64 for compiled code: many random streams, each one bit for bit that of its np.random.Generator.

A generator is a row of four 64-bit words: state high, state low, increment high, increment low. The 128-bit
arithmetic goes by 32-bit halves, none of whose sums exceeds 64 bits: the same functions run on scalars, on
arrays and compiled. All constants are np.uint64, since Numba makes a float of a signed and an unsigned integer.

O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number
Generation", HMC-CS-2014-0905 (2014): a linear congruential generator of 128 bits with XSL-RR output.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import permutations
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError

STATE_WORDS = 4
"""Words per generator."""

Word = TypeVar("Word", np.uint64, NDArray[np.uint64])
Rows = slice | NDArray[np.bool_] | NDArray[np.intp]

MULTIPLIER = 0x2360ED051FC65DA44385DF649FCCF645
M0, M1, M2, M3 = (np.uint64(MULTIPLIER >> shift & 0xFFFFFFFF) for shift in (0, 32, 64, 96))
LOW_HALF = np.uint64(0xFFFFFFFF)
HALF, ROTATION, UNUSED = np.uint64(32), np.uint64(58), np.uint64(11)
ZERO, ONE, SIXTY_THREE, SIXTY_FOUR = np.uint64(0), np.uint64(1), np.uint64(63), np.uint64(64)


def split(word: Word) -> tuple[Word, Word]:
    """Return the lower and the upper 32 bits of a word."""
    return word & LOW_HALF, word >> HALF


def multiply_add(a: Word, b: np.uint64, c: Word, d: Word) -> tuple[Word, Word]:
    """Return the lower and the upper 32 bits of a b + c + d, of 32 bits each: at most 2^64 - 1."""
    return split(a * b + c + d)


def stepped(high: Word, low: Word, increment_high: Word, increment_low: Word) -> tuple[Word, Word]:
    """Return a generator's next state, (multiplier state + increment) mod 2^128, as its upper and lower word."""
    s0, s1 = split(low)
    s2, s3 = split(high)
    r0, r1 = split(increment_low)
    r2, r3 = split(increment_high)
    zero = r0 & ZERO

    r0, carry = multiply_add(s0, M0, r0, zero)
    r1, carry = multiply_add(s1, M0, r1, carry)
    r2, carry = multiply_add(s2, M0, r2, carry)
    r3, _ = multiply_add(s3, M0, r3, carry)

    r1, carry = multiply_add(s0, M1, r1, zero)
    r2, carry = multiply_add(s1, M1, r2, carry)
    r3, _ = multiply_add(s2, M1, r3, carry)

    r2, carry = multiply_add(s0, M2, r2, zero)
    r3, _ = multiply_add(s1, M2, r3, carry)

    r3, _ = multiply_add(s0, M3, r3, zero)
    return r3 << HALF | r2, r1 << HALF | r0


def next_uniform(words: NDArray[np.uint64]) -> float:
    """Advance a generator by one step and return what `Generator.random()` returns, in [0, 1).

    Args:
        words: the generator, shape (4,), changed in place.
    """
    high, low = stepped(words[0], words[1], words[2], words[3])
    words[0], words[1] = high, low
    mixed, turn = high ^ low, high >> ROTATION
    drawn = mixed >> turn | mixed << ((SIXTY_FOUR - turn) & SIXTY_THREE)
    return float(drawn >> UNUSED) * 2.0**-53


def words_of(bit_generator_state: dict[str, Any]) -> NDArray[np.uint64]:
    """Return the words, shape (4,), of what `np.random.PCG64().state` returned.

    Raises:
        InvalidInputError: it is of another bit generator, or keeps half of a draw for later.
    """
    kind = bit_generator_state.get("bit_generator")
    if kind != "PCG64":
        raise InvalidInputError(f"bit_generator is {kind!r}; give the state of a np.random.PCG64")
    if bit_generator_state["has_uint32"]:
        raise InvalidInputError(
            f"has_uint32 is {bit_generator_state['has_uint32']}: half of a 64-bit draw waits to be used and "
            "would be lost; draw one more 32-bit number from the generator first"
        )
    numbers = bit_generator_state["state"]
    both = (numbers["state"], numbers["inc"])
    return np.array([word for number in both for word in divmod(number, 1 << 64)], dtype=np.uint64)


def state_of(words: NDArray[np.uint64]) -> dict[str, Any]:
    """Return a generator as `Generator.bit_generator.state` takes it."""
    high, low, increment_high, increment_low = words.tolist()
    numbers = {"state": high << 64 | low, "inc": increment_high << 64 | increment_low}
    return {"bit_generator": "PCG64", "state": numbers, "has_uint32": 0, "uinteger": 0}


def seeded_words(seed: int) -> NDArray[np.uint64]:
    """Return the generator, shape (4,), that Gymnasium's `np_random(seed)` starts with."""
    return words_of(dict(np.random.PCG64(np.random.SeedSequence(seed)).state))


def fill_seeded(words: NDArray[np.uint64], seeds: Sequence[int], where: Rows) -> None:
    """Seed the generators words[where] as `seeded_words` does, all at once.

    Args:
        words: generators, shape (n, 4), changed in place.
        seeds: one integer of 0 or more for each generator.
        where: the rows to seed: a slice, a mask or indices.
    """
    if max(seeds, default=0) >> 128:  # more than the hash below takes in at a time
        words[where] = [seeded_words(seed) for seed in seeds]
        return
    high, low, sequence_high, sequence_low = seed_sequence_words(seeds)
    increment_high = sequence_high << ONE | sequence_low >> SIXTY_THREE
    increment_low = sequence_low << ONE | ONE
    low = low + increment_low
    high = high + increment_high + (low < increment_low)
    high, low = stepped(high, low, increment_high, increment_low)
    words[where] = np.stack([high, low, increment_high, increment_low], axis=-1)


def seed_sequence_words(seeds: Sequence[int]) -> list[NDArray[np.uint64]]:
    """Return `SeedSequence(seed).generate_state(4, np.uint64)` of seeds below 2^128, as four arrays.

    O'Neill, "Developing a seed_seq Alternative", https://www.pcg-random.org/posts/developing-a-seed_seq-alternative.html
    """
    entropy = b"".join(seed.to_bytes(16, "little") for seed in seeds)
    constants = hash_constants(0x43B0D7E5, 0x931E8875)
    pool = [hashed(part, constants) for part in np.frombuffer(entropy, dtype="<u4").reshape(-1, 4).T]
    for source, target in permutations(range(4), 2):
        left = pool[target] * np.uint32(0xCA01F9DD)
        right = hashed(pool[source], constants) * np.uint32(0x4973F715)
        pool[target] = folded(left - right)
    constants = hash_constants(0x8B51F9DD, 0x58F38DED)
    halves = [hashed(part, constants).astype(np.uint64) for part in pool + pool]
    return [upper << HALF | lower for lower, upper in zip(halves[::2], halves[1::2], strict=True)]


def hashed(
    values: NDArray[np.uint32], constants: Iterator[tuple[np.uint32, np.uint32]]
) -> NDArray[np.uint32]:
    """Return SeedSequence's hash of 32-bit values with its next two constants."""
    mask, multiplier = next(constants)
    return folded((values ^ mask) * multiplier)


def folded(values: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return 32-bit values with their upper half added, bit by bit, to their lower one."""
    return values ^ values >> np.uint32(16)


def hash_constants(constant: int, factor: int) -> Iterator[tuple[np.uint32, np.uint32]]:
    """Yield each two neighbours of constant, constant factor, constant factor^2, ... mod 2^32."""
    while True:
        following = constant * factor & 0xFFFFFFFF
        yield np.uint32(constant), np.uint32(following)
        constant = following
