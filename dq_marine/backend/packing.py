"""Nested tuples of numbers in flat arrays, and back, at no cost in compiled code.

A compiled function takes its parameters as one array: passing a hundred numbers in nested tuples would cost
more than the step. `flatten` lays the tuples out; `make_load` and `store` are the compiled ways back and
forth, resolved while compiling into plain loads and stores.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from dq_marine.algebra.nesting import alike, rebuild
from dq_marine.algebra.table import Table
from dq_marine.backend.table_type import TableType


def flatten(structure: Any) -> Iterator[float]:
    """Yield the numbers of nested tuples, depth first."""
    if isinstance(structure, Table):
        yield from map(float, structure)
    elif isinstance(structure, tuple):
        for part in structure:
            yield from flatten(part)
    else:
        yield float(structure)


def pack(structure: Any) -> NDArray[np.float64]:
    """Return the numbers of nested tuples as a float64 array."""
    return np.fromiter(flatten(structure), dtype=np.float64)


def unpack(like: Any, numbers: NDArray[np.floating[Any]]) -> Any:
    """Return nested tuples shaped as `like`, with `numbers` as their components: the inverse of `pack`."""
    return rebuild(like, iter(numbers.tolist()))


class Unpacker:
    """Unpacks arrays that are alike, one after the other, and builds anew only the parts whose numbers have changed.

    For who asks again and again: the parameters of a step hold the thousands of numbers of a sea, which stay.
    """

    def __init__(self, like: tuple[Any, ...]) -> None:
        ends = np.cumsum([pack(part).size for part in like]).tolist()
        self._like = like
        self._places = [slice(first, end) for first, end in zip([0, *ends], ends, strict=False)]
        self._bits = [b""] * len(like)
        self._parts = list(like)
        self._whole: Any = None

    def __call__(self, numbers: NDArray[np.floating[Any]]) -> Any:
        """Return what `unpack` returns."""
        changed = self._whole is None
        for index, place in enumerate(self._places):
            part = numbers[place]
            bits = part.tobytes()
            if bits != self._bits[index]:
                self._bits[index], self._parts[index] = bits, unpack(self._like[index], part)
                changed = True
        if changed:
            self._whole = alike(self._like, self._parts)
        return self._whole


def unpack_columns(like: Any, rows: NDArray[np.float64]) -> Any:
    """Return nested tuples shaped as `like`, with the columns of `rows` as their components."""
    return rebuild(like, iter(rows.T))


def structure_type(structure: Any) -> types.Type:
    """Return the Numba type of nested tuples whose leaves are taken as float64."""
    if not isinstance(structure, tuple):
        return types.float64
    if isinstance(structure, Table):
        return TableType(len(structure))
    named = type(structure) if hasattr(structure, "_fields") else None
    return types.BaseTuple.from_types(tuple(structure_type(part) for part in structure), named)


def make_load(result: types.Type) -> Callable[[Any], Any]:
    """Return a function for compiled code that reads an array into nested tuples of the given type."""

    @intrinsic
    def load(typing_context: Any, array: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            array_type = signature.args[0]
            data = context.make_array(array_type)(context, builder, arguments[0]).data
            position = iter(range(_leaf_count(result)))

            def build(part: types.Type) -> Any:
                if isinstance(part, TableType):
                    places = [next(position) for _ in range(part.count)]
                    return cgutils.gep_inbounds(builder, data, places[0])
                if not isinstance(part, types.BaseTuple):
                    pointer = cgutils.gep_inbounds(builder, data, next(position))
                    value = builder.load(pointer)
                    return context.cast(builder, value, array_type.dtype, part)
                return context.make_tuple(builder, part, [build(inner) for inner in part.types])

            return build(result)

        return result(array), generate

    return load


@intrinsic
def store(typing_context: Any, array: Any, structure: Any) -> Any:
    """Write the numbers of nested tuples into an array, cast to its type; for compiled code only.

    Those of tables are left as they are: compiled code reads them where they stand, and never changes them.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array_type, root = signature.args
        data = context.make_array(array_type)(context, builder, arguments[0]).data
        position = iter(range(_leaf_count(root)))

        def write(part: types.Type, value: Any) -> None:
            if isinstance(part, types.BaseTuple):
                for index, inner in enumerate(part.types):
                    write(inner, builder.extract_value(value, index))
                return
            if isinstance(part, TableType):
                for _ in range(part.count):
                    next(position)
                return
            number = context.cast(builder, value, part, array_type.dtype)
            builder.store(number, cgutils.gep_inbounds(builder, data, next(position)))

        write(root, arguments[1])
        return context.get_dummy_value()

    return types.none(array, structure), generate


def _leaf_count(part: types.Type) -> int:
    if isinstance(part, TableType):
        return part.count
    if not isinstance(part, types.BaseTuple):
        return 1
    return sum(_leaf_count(inner) for inner in part.types)


def leaf_types(kind: types.Type) -> list[Any]:
    """Return the types of a structure's numbers, depth first."""
    if not isinstance(kind, types.BaseTuple):
        return [kind]
    return [leaf for inner in kind.types for leaf in leaf_types(inner)]


def leaves(builder: Any, kind: types.Type, value: Any) -> list[Any]:
    """Return the LLVM values of a structure's numbers, depth first."""
    if not isinstance(kind, types.BaseTuple):
        return [value]
    parts = [leaves(builder, inner, builder.extract_value(value, i)) for i, inner in enumerate(kind.types)]
    return [leaf for part in parts for leaf in part]
