"""Checks of what comes in through a public door: each returns the value in the form used inside."""

from __future__ import annotations

import contextlib
import math
import numbers
import operator
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.errors import InvalidInputError

LONGEST_SHOWN = 200
"""Characters of a wrong value that a message repeats."""

LARGEST_FILE = 64 * 2**20
"""Bytes. A vehicle's file has a few thousand, a panel program's tables a few million."""

LARGEST_INTEGER = 2**31 - 1
"""A count beyond it is a mistake."""


def real_numbers(name: str, value: Any, wanted: str) -> NDArray[np.float64]:
    """Return a new float64 array of real numbers, of any shape.

    Strings, complex numbers and dates are none, although NumPy would convert some of them.

    Raises:
        InvalidInputError: it is ragged, has something that is no real number, or a number that no float64 can hold.
    """
    if type(value) is np.ndarray and value.dtype.kind == "f":  # what each step is given
        return value.astype(np.float64)
    try:
        given = np.asarray(value)
        if given.dtype == object and not all(
            isinstance(one, numbers.Real | np.ndarray) for one in given.flat
        ):
            raise TypeError("not all are real numbers")
        if given.dtype.kind not in "fiubO":
            raise TypeError(f"{given.dtype} is no real number")
        return np.array(given, dtype=np.float64)
    except Exception as error:  # the value's own __array__ or __float__ may do anything
        raise InvalidInputError(f"{name} = {shown(value)} is not numeric ({error}); give {wanted}") from error


def shown(value: Any) -> str:
    """Return what a message says of a value that came in from outside: its text, as printable characters, cut short."""
    try:
        text = repr(value)
    except Exception as error:  # the value's own __repr__ may do anything
        text = f"<{type(value).__name__}, whose repr fails: {type(error).__name__}>"
    text = printable(text)
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}..."


def printable(text: str) -> str:
    """Return a text with a question mark for each character that may act on a terminal, such as an escape."""
    return "".join(character if character.isprintable() else "?" for character in text)


def one_of(name: str, value: Any, choices: Iterable[Any]) -> Any:
    """Return `value`, a text or a whole number, if it is among the choices.

    Raises:
        InvalidInputError: it is not.
    """
    known = list(choices)
    if not isinstance(value, str | int) or value not in known:
        raise InvalidInputError(f"{name} = {shown(value)} is unknown; give one of {known}")
    return value


def check_entries(what: str, given: Mapping[Any, Any], known: Iterable[str], needed: Iterable[str]) -> None:
    """Check that a dictionary has entries that are known, and those that are needed.

    Args:
        what: it stands for, for the message.
        given: the dictionary.
        known: names of entries that it may have.
        needed: of those that it must have.

    Raises:
        InvalidInputError: an entry is unknown, or one is lacking.
    """
    allowed = set(known)
    wrong = sorted(shown(name) for name in given if name not in allowed)
    lacking = sorted(set(needed) - given.keys())
    if wrong or lacking:
        told = [f"does not take {', '.join(wrong)}"] if wrong else []
        told += [f"lacks {', '.join(lacking)}"] if lacking else []
        raise InvalidInputError(f"{what} {' and '.join(told)}; it takes {', '.join(sorted(allowed))}")


def finite_array(name: str, value: ArrayLike, size: int) -> NDArray[np.float64]:
    """Return `value` as a new float64 array of shape (size,).

    Raises:
        InvalidInputError: it is not numeric, of another shape, or has a NaN or an infinity.
    """
    array = real_numbers(name, value, f"{size} numbers")
    if array.shape != (size,):
        raise InvalidInputError(f"{name} has shape {array.shape}; give shape ({size},)")
    if not np.isfinite(array).all():
        raise InvalidInputError(f"{name} = {shown(array.tolist())} is not finite; give finite numbers")
    return array


def squared_length_of(components: NDArray[np.float64]) -> Any:
    """Return the sum of the squares along the first axis: a number for one vector, an array for columns of many.

    Squares are added one after the other, in the order of the components. What NumPy and its BLAS do instead depends on
    the shape of the array and on the processor, so that one vector alone and the same one among others would differ in
    the last bit.
    """
    with np.errstate(over="ignore"):
        squares = components * components
        total = squares[0]
        for square in squares[1:]:
            total = total + square
    return total


def length_of(components: NDArray[np.float64]) -> Any:
    """Return the Euclidean length along the first axis, by `squared_length_of`."""
    return np.sqrt(squared_length_of(components))


def unit_quaternion(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Return `value` as a float64 quaternion of exactly unit length, shape (4,).

    Raises:
        InvalidInputError: as for `finite_array`, or its length is not 1 to 1e-6.
    """
    q = finite_array(name, value, 4)
    length = float(length_of(q))
    if abs(length - 1.0) > 1e-6:
        raise InvalidInputError(
            f"{name} has length {length:.9g}; give a unit quaternion, scalar first (divide it by its length)"
        )
    return q / length


def whole_number(name: str, value: Any, *, least: int, most: int | None = None) -> int:
    """Return `value` as an int within limits.

    Raises:
        InvalidInputError: it is no integer, or beyond a limit.
    """
    try:
        number = operator.index(value)
        if isinstance(value, bool | np.bool_):
            raise TypeError("a condition is no count")
    except Exception as error:  # the value's own __index__ may do anything
        raise InvalidInputError(f"{name} = {shown(value)} is not an integer; give {least} or more") from error
    if number < least:
        raise InvalidInputError(f"{name} = {shown(number)} is below {least}; give {least} or more")
    if most is not None and number > most:
        raise InvalidInputError(f"{name} = {shown(number)} is too large; give one from {least} to {most}")
    return number


def positive_integer(name: str, value: Any) -> int:
    """Return `value` as a positive int.

    Raises:
        InvalidInputError: it is not an integer of at least 1, or beyond `LARGEST_INTEGER`.
    """
    return whole_number(name, value, least=1, most=LARGEST_INTEGER)


def finite_number(
    name: str,
    value: Any,
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
) -> float:
    """Return `value` as a finite float: above a limit or at least another, and at most a third, where they are given.

    Raises:
        InvalidInputError: it is not.
    """
    array = real_numbers(name, value, "a number")
    if array.size != 1:
        raise InvalidInputError(f"{name} has shape {array.shape}; give a number")
    number = float(array.item())
    if not np.isfinite(number) or (above is not None and number <= above):
        limit = "finite" if above is None else f"finite and above {above:g}"
        raise InvalidInputError(f"{name} = {number:g} is not {limit}; give one that is")
    if least is not None and number < least:
        raise InvalidInputError(f"{name} = {number:g}; give at least {least:g}")
    if most is not None and number > most:
        raise InvalidInputError(f"{name} = {number:g}; give at most {most:g}")
    return number


def finite_rows(name: str, value: ArrayLike, rows: int, size: int) -> NDArray[np.float64]:
    """Return `value`, one row for all or one for each, as a float64 array of shape (rows, size).

    It is returned as it is, not copied, if it is such an array already, and can be written to: compiled code takes a
    read-only array for one of another type.

    Raises:
        InvalidInputError: it is not numeric, of another shape, or has a NaN or an infinity.
    """
    if not (isinstance(value, np.ndarray) and value.dtype == np.float64):
        value = real_numbers(name, value, f"numbers of shape ({rows}, {size})")
    array = np.ascontiguousarray(value)
    if array.shape == (size,):
        array = np.full((rows, size), array)
    if not array.flags.writeable:
        array = array.copy()
    if array.shape != (rows, size):
        raise InvalidInputError(f"{name} has shape {array.shape}; give shape ({rows}, {size}) or ({size},)")
    check_finite_rows(name, array)
    return array


def check_finite_rows(name: str, array: NDArray[Any]) -> None:
    """Check that an array of rows of numbers has no NaN and no infinity.

    Raises:
        InvalidInputError: it has one; the message says in which row.
    """
    # The sum is finite unless a component is not, or numbers near the largest add up beyond it: look closer then.
    with np.errstate(over="ignore", invalid="ignore"):
        total = float(np.add.reduce(array, axis=None))
    if not math.isfinite(total):
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        if bad.size:
            raise InvalidInputError(
                f"{name}[{bad[0]}] = {array[bad[0]].tolist()} is not finite; give finite numbers"
            )


def unit_quaternion_rows(name: str, value: ArrayLike, rows: int) -> NDArray[np.float64]:
    """Return `value`, one row for all or one for each, as quaternions of exactly unit length, shape (rows, 4).

    Raises:
        InvalidInputError: as for `finite_rows`, or a length is not 1 to 1e-6.
    """
    q = finite_rows(name, value, rows, 4)
    lengths = length_of(q.T)
    bad = np.flatnonzero(np.abs(lengths - 1.0) > 1e-6)
    if bad.size:
        raise InvalidInputError(
            f"{name}[{bad[0]}] has length {lengths[bad[0]]:.9g}; give unit quaternions, scalar first"
        )
    unit: NDArray[np.float64] = q / lengths[:, None]
    return unit


def possible_path(name: str, path: str | os.PathLike[str]) -> Path:
    """Return a path, at which there need not be anything, with a leading ~ resolved.

    Args:
        name: of what the path is for, for the message.
        path: as the user gave it.

    Raises:
        InvalidInputError: nothing can have such a path.
    """
    if not isinstance(path, str | bytes | os.PathLike):
        raise InvalidInputError(f"{name} = {shown(path)} is no path of a file; give one, as text")
    text = os.fspath(path)
    try:
        found = Path(os.fsdecode(text)).expanduser()
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            found.stat()
    except (OSError, ValueError, RuntimeError) as error:
        raise InvalidInputError(
            f"{name} = {shown(text)} is no path of a file: {error}; give another"
        ) from error
    return found


def existing_file(name: str, path: str | os.PathLike[str]) -> Path | None:
    """Return the path of a regular file, with a leading ~ resolved; None if there is none.

    Args:
        name: of what the file is for, for the message.
        path: as the user gave it.

    Raises:
        InvalidInputError: no file can have such a path, or it is larger than `LARGEST_FILE`.
    """
    file = possible_path(name, path)
    size = file.stat().st_size if file.is_file() else None
    text = os.fspath(path)
    if size is not None and size > LARGEST_FILE:
        raise InvalidInputError(
            f"{name} = {shown(text)} has {size:,} bytes; give a file of at most {LARGEST_FILE:,}"
        )
    return None if size is None else file
