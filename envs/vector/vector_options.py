"""Actions, seeds and options of a vector environment, checked, and as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.backend.simd.draws import CHOSEN_COLUMNS
from dq_marine.checks import (
    check_finite_rows,
    finite_rows,
    real_numbers,
    shown,
    unit_quaternion_rows,
    whole_number,
)
from dq_marine.envs.core.start import START_OPTIONS, check_is_options
from dq_marine.errors import InvalidInputError

CHOSEN_SLICES = {
    "position": slice(0, 3),
    "quaternion": slice(3, 7),
    "velocity": slice(7, 13),
    "current": slice(13, 16),
}
"""Where the options of a start stand in a row of `PeriodArrays.chosen`."""

RESET_MASK = "reset_mask"


def chosen_rows(
    for_all: Mapping[str, Any], for_each: Mapping[str, Any], n: int, bodies: int
) -> NDArray[np.float64]:
    """Return `PeriodArrays.chosen` for checked options of n environments, padded to so many bodies."""
    given = [name for name in CHOSEN_SLICES if name in for_all or name in for_each]
    chosen = np.full((bodies if given else 1, CHOSEN_COLUMNS), np.nan)
    for name in given:
        chosen[:n, CHOSEN_SLICES[name]] = for_all[name] if name in for_all else for_each[name]
    return chosen


def checked_seeds(seed: int | Sequence[int | None] | None, n: int) -> list[int | None]:
    """Return a seed for each of n environments, None for those whose generator goes on.

    Raises:
        InvalidInputError: a seed is no whole number of 0 or more, or there is not one for each.
    """
    if seed is None:
        return [None] * n
    given: Any = seed
    if not isinstance(given, list | tuple) and getattr(given, "ndim", 0) != 1:
        first = whole_number("seed", given, least=0)
        return [first + index for index in range(n)]
    if len(given) != n:
        raise InvalidInputError(f"seed = {shown(given)}; give one number, or a list of one for each of {n}")
    return [
        None if one is None else whole_number(f"seed[{index}]", one, least=0)
        for index, one in enumerate(given)
    ]


def checked_mask(options: dict[str, Any] | None, n: int) -> NDArray[np.bool_]:
    """Return which of n environments are reset: all, or those of the option `reset_mask`.

    Raises:
        InvalidInputError: it is not an array of n bools with at least one True.
    """
    check_is_options(options)
    if options is None or RESET_MASK not in options:
        return np.ones(n, np.bool_)
    mask = options[RESET_MASK]
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != (n,) or not mask.any():
        raise InvalidInputError(
            f"options['{RESET_MASK}'] = {shown(mask)}; give a NumPy array of {n} bools, at least one of them True"
        )
    return mask


def checked_actions(actions: Any, shape: tuple[int, int]) -> NDArray[Any]:
    """Return actions as an array.

    Raises:
        InvalidInputError: they are not numeric, of another shape, or not finite.
    """
    if isinstance(actions, np.ndarray) and actions.dtype.kind == "f":
        numbers: NDArray[Any] = actions
    else:
        numbers = real_numbers("actions", actions, f"numbers of shape {shape}")
    if numbers.shape != shape:
        raise InvalidInputError(f"actions have shape {numbers.shape}; give shape {shape}")
    check_finite_rows("actions", numbers)
    return numbers


def split_options(
    options: dict[str, Any] | None,
    n: int,
    check: Callable[[dict[str, Any]], dict[str, NDArray[np.float64]]],
    own: Mapping[str, int],
) -> tuple[dict[str, NDArray[np.float64]], dict[str, NDArray[np.float64]]]:
    """Return the options that are one for all environments, and those with a row for each, both checked.

    Args:
        options: of `reset`.
        n: number of environments.
        check: of the options that are one for all.
        own: the task's options, with their sizes.

    Raises:
        InvalidInputError: an option is unknown or wrong.
    """
    given = {name: value for name, value in (options or {}).items() if name != RESET_MASK}
    for_each = {name: value for name, value in given.items() if _has_rows(value)}
    for_all = check({name: value for name, value in given.items() if name not in for_each})
    rows = {name: _checked_rows(name, value, n, check, own) for name, value in for_each.items()}
    return for_all, rows


def _has_rows(value: Any) -> bool:
    try:
        return np.ndim(value) == 2
    except Exception:  # a ragged list, or an object of its own mind: the check says what is wrong with it
        return False


def _checked_rows(
    name: str, value: Any, n: int, check: Callable[[dict[str, Any]], Any], own: Mapping[str, int]
) -> NDArray[np.float64]:
    label = f"options[{name!r}]"
    if name.endswith("quaternion"):
        rows = unit_quaternion_rows(label, value, n)
    else:
        rows = finite_rows(label, value, n, {**START_OPTIONS, **own}.get(name, 3))
    # Two rows stand for all in what a single environment checks: the largest for names, distances and currents, the one
    # of the least last number for places up in the air.
    for row in {int(np.abs(rows).max(axis=1).argmax()), int(rows[:, -1].argmin())}:
        check({name: rows[row]})
    return rows


def checked_index(index: Any, count: int) -> int:
    """Return the number of one of so many environments.

    Raises:
        InvalidInputError: there is no such environment.
    """
    return whole_number("index", index, least=0, most=count - 1)


def checked_mode(mode: AutoresetMode | str) -> AutoresetMode:
    """Return the mode of a member, its value or its name, in any case.

    Raises:
        InvalidInputError: there is no such mode.
    """
    name = mode.value if isinstance(mode, AutoresetMode) else mode
    plain = name if isinstance(name, str) else ""
    for member in AutoresetMode:
        if plain.replace("_", "").lower() == member.value.lower():
            return member
    known = [member.value for member in AutoresetMode]
    raise InvalidInputError(f"autoreset_mode = {shown(mode)} is unknown; give one of {known}")
