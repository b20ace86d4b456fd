"""Checks of what comes in through a public door: each returns the value in the form used inside."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.errors import InvalidInputError


def finite_array(name: str, value: ArrayLike, size: int) -> NDArray[np.float64]:
    """Return `value` as a float64 array of shape (size,).

    Raises:
        InvalidInputError: it is not numeric, of another shape, or has a NaN or an infinity.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"{name} = {value!r} is not numeric; give {size} numbers") from error
    if array.shape != (size,):
        raise InvalidInputError(f"{name} has shape {array.shape}; give shape ({size},)")
    if not np.isfinite(array).all():
        raise InvalidInputError(f"{name} = {array.tolist()} is not finite; give finite numbers")
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


def positive_integer(name: str, value: Any) -> int:
    """Return `value` as a positive int.

    Raises:
        InvalidInputError: it is not an integer of at least 1.
    """
    try:
        number = operator.index(value)
    except TypeError as error:
        raise InvalidInputError(f"{name} = {value!r} is not an integer; give 1 or more") from error
    if number < 1:
        raise InvalidInputError(f"{name} = {number} is below 1; give 1 or more")
    return number


def finite_number(name: str, value: Any, *, above: float | None = None, most: float | None = None) -> float:
    """Return `value` as a finite float, strictly above a limit and at most another where they are given.

    Raises:
        InvalidInputError: it is not.
    """
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"{name} = {value!r} is not a number") from error
    if not np.isfinite(number) or (above is not None and number <= above):
        limit = "finite" if above is None else f"finite and above {above:g}"
        raise InvalidInputError(f"{name} = {number:g} is not {limit}; give one that is")
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
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(f"{name} is not numeric; give numbers of shape ({rows}, {size})") from error
    if array.shape == (size,):
        array = np.full((rows, size), array)
    if not array.flags.writeable:
        array = array.copy()
    if array.shape != (rows, size):
        raise InvalidInputError(f"{name} has shape {array.shape}; give shape ({rows}, {size}) or ({size},)")
    # The sum is finite unless a component is not, or numbers near the largest add up beyond it: look closer then.
    with np.errstate(over="ignore", invalid="ignore"):
        total = array.sum()
    if not np.isfinite(total):
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        if bad.size:
            raise InvalidInputError(
                f"{name}[{bad[0]}] = {array[bad[0]].tolist()} is not finite; give finite numbers"
            )
    return array


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
