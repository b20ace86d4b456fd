"""Values that no door expects, and valid ones gone wrong, drawn from a seeded generator."""

from __future__ import annotations

import datetime
import decimal
import fractions
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Rng = np.random.Generator

NUMBERS: tuple[Any, ...] = (
    0, -1, 1, 2, 7, 0.0, -0.0, 0.1, -0.5, 1e-3, 1e3, 1e-300, 5e-324, 1e12, 1e200, -1e200, 1e308, float("nan"),
    float("inf"), float("-inf"), 2**31, 2**63, 2**64, -(2**70), 10**400, 1.9, True, False, 1j, 3 + 0j,
    np.float32(3.4e38),
    np.float64("nan"), np.int64(-5), np.uint8(255), np.bool_(True), fractions.Fraction(1, 3), decimal.Decimal("0.1"),
)  # fmt: skip

TEXTS: tuple[Any, ...] = (
    "", " ", "1.5", "nan", "bluerov2", "bluerov2_heavy", "no such", "~nosuchuser/x.toml", "x" * 5000,
    "../../etc/passwd",
    "/dev/zero", "[red]markup[/red]", "\x1b[31mred\x1b[0m", "a\x00b", "ünïcode", "1e308", b"bytes",
    Path("nowhere.toml"),
    Path("/"), "midpoint", "thrusters", "auv",
)  # fmt: skip


class Rude:
    """An object whose every conversion fails in its own way."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")

    def __float__(self) -> float:
        raise ZeroDivisionError("no float")

    def __index__(self) -> int:
        raise KeyError("no index")

    def __array__(self, *arguments: Any, **keywords: Any) -> Any:
        raise MemoryError("no array")

    def __hash__(self) -> int:
        raise TypeError("no hash")

    def __eq__(self, other: object) -> bool:
        return False


def objects(rng: Rng) -> tuple[Any, ...]:
    """What is neither number nor text, made anew so that no case changes another's."""
    return (
        None, [], (), {}, set(), object(), Rude(), len, type, [[1, 2], [3]], [None], ["a", 1], {"a": 1, 2: 3}, {1, 2},
        range(6), iter([1, 2, 3]), np.zeros(0), np.zeros((3, 0)), np.zeros((2, 3, 4)), np.array("x"), np.array(None),
        np.array([1, "a", None], dtype=object), np.full(6, np.nan), np.zeros(6, np.complex128), np.zeros(6, ">f8"),
        np.arange(12.0)[::2], np.ma.masked_array(np.zeros(6), True), np.datetime64("2026-01-01"),
        datetime.datetime(2026, 1, 1), memoryview(b"123456"), Exception("value"), [10**400] * 6, ["1"] * 6,
        np.zeros(6, dtype=[("x", float)]), [float("inf")] * 6, [1e308] * 6, [[0.0] * 6] * 2, {"type": "jonswap"},
    )  # fmt: skip


def hostile(rng: Rng) -> Any:
    """Any value at all."""
    kind = rng.integers(4)
    if kind == 0:
        return NUMBERS[rng.integers(len(NUMBERS))]
    if kind == 1:
        return TEXTS[rng.integers(len(TEXTS))]
    if kind == 2:
        found = objects(rng)
        return found[rng.integers(len(found))]
    return array(rng)


def array(rng: Rng) -> Any:
    """Numbers in an array or list of some shape, of which a few are strange."""
    shape = ((3,), (4,), (6,), (15,), (2, 6), (3, 3), (6, 6), (5,))[rng.integers(8)]
    numbers = rng.normal(size=shape) * 10.0 ** rng.integers(-3, 4)
    for _ in range(rng.integers(3)):
        numbers[tuple(rng.integers(shape))] = strange_number(rng)
    return numbers if rng.integers(2) else numbers.tolist()


def strange_number(rng: Rng) -> float:
    """A double of any size, or none."""
    choices = (np.nan, np.inf, -np.inf, 0.0, -1.0, 1e308, -1e200, 1e-308, 10.0 ** rng.uniform(-300.0, 300.0))
    return float(choices[rng.integers(len(choices))])


def spoilt(rng: Rng, value: Any) -> Any:
    """A valid value as it is, gone wrong in one place, or replaced."""
    kind = rng.integers(6)
    if kind <= 1:
        return value
    if kind == 2:
        return hostile(rng)
    if isinstance(value, dict) and value:
        name = list(value)[rng.integers(len(value))]
        if kind == 3:
            return {key: one for key, one in value.items() if key != name} | {"unknown": 1}
        return value | {name: spoilt(rng, value[name])}
    if isinstance(value, tuple | list) and value:
        place = int(rng.integers(len(value)))
        return type(value)([*value[:place], spoilt(rng, value[place]), *value[place + 1 :]])
    if isinstance(value, np.ndarray) and value.size and value.dtype.kind == "f":
        wrong = value.copy()
        wrong.reshape(-1)[rng.integers(value.size)] = strange_number(rng)
        return wrong
    if isinstance(value, int | float) and not isinstance(value, bool):
        return times(value, strange_number(rng)) if kind == 4 else strange_number(rng)
    return hostile(rng)


def times(value: float, factor: float) -> float:
    """The product; the factor alone where it is a whole number beyond any double."""
    try:
        return value * factor
    except OverflowError:
        return factor


def arguments(rng: Rng, valid: dict[str, Callable[[Rng], Any]], most: int = 4) -> dict[str, Any]:
    """Keyword arguments: some of the valid ones, each perhaps spoilt, and now and then an unknown one."""
    names = list(valid)
    chosen = rng.permutation(len(names))[: rng.integers(1, most + 1)]
    given = {names[place]: spoilt(rng, valid[names[place]](rng)) for place in chosen}
    if rng.integers(40) == 0:
        given["no_such_keyword"] = hostile(rng)
    return given
