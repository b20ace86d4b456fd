"""Rows of numbers as users have them, one body a row, read into lanes and written from them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.extending import intrinsic

from dq_marine.backend.lane_type import Lanes, extract, spread


def leaves(builder: Any, kind: types.Type, value: Any) -> list[Any]:
    """Return the LLVM values of a structure's numbers, depth first."""
    if not isinstance(kind, types.BaseTuple):
        return [value]
    parts = [leaves(builder, inner, builder.extract_value(value, i)) for i, inner in enumerate(kind.types)]
    return [leaf for part in parts for leaf in part]


def make_load_rows(lanes: Lanes, columns: int) -> Callable[[Any, Any], Any]:
    """Return (rows, block) -> as many lanes as `columns`, for compiled code; beyond the last row it is repeated.

    `rows` is a contiguous array of shape (n, columns) of floats of any kind.
    """
    result = types.UniTuple(lanes, columns)

    @intrinsic
    def load_rows(typing_context: Any, rows: Any, block: Any) -> Any:
        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            array = context.make_array(sig.args[0])(context, builder, values[0])
            last = builder.sub(cgutils.unpack_tuple(builder, array.shape, 2)[0], _integer(values[1], 1))
            first = builder.mul(values[1], _integer(values[1], lanes.width))
            vectors = [ir.Constant(lanes.vector, ir.Undefined)] * columns
            for lane in range(lanes.width):
                row = builder.add(first, _integer(values[1], lane))
                row = builder.select(builder.icmp_signed("<", row, last), row, last)
                start = builder.mul(row, _integer(row, columns))
                for column in range(columns):
                    place = builder.add(start, _integer(start, column))
                    number = builder.load(cgutils.gep_inbounds(builder, array.data, place))
                    number = context.cast(builder, number, sig.args[0].dtype, lanes.dtype)
                    index = ir.Constant(ir.IntType(32), lane)
                    vectors[column] = builder.insert_element(vectors[column], number, index)
            return context.make_tuple(builder, result, vectors)

        return signature(result, rows, types.intp), generate

    return load_rows


def make_load_column(lanes: Lanes) -> Callable[[Any, Any], Any]:
    """Return (column, block) -> lanes, for compiled code, from a contiguous array with a number for every lane."""

    @intrinsic
    def load_column(typing_context: Any, column: Any, block: Any) -> Any:
        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            array = context.make_array(sig.args[0])(context, builder, values[0])
            first = builder.mul(values[1], _integer(values[1], lanes.width))
            vector = ir.Constant(lanes.vector, ir.Undefined)
            for lane in range(lanes.width):
                pointer = cgutils.gep_inbounds(builder, array.data, builder.add(first, _integer(first, lane)))
                number = context.unpack_value(builder, sig.args[0].dtype, pointer)
                number = context.cast(builder, number, sig.args[0].dtype, lanes.dtype)
                vector = builder.insert_element(vector, number, ir.Constant(ir.IntType(32), lane))
            return vector

        return signature(lanes, column, types.intp), generate

    return load_column


@intrinsic
def lane_numbers(typing_context: Any, like: Any, block: Any) -> Any:
    """The index of every lane's body, as lanes of integers."""
    result = like.of(types.int64)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        first = builder.mul(values[1], _integer(values[1], like.width))
        steps = ir.Constant(result.vector, list(range(like.width)))
        return builder.add(spread(builder, first, like.width), steps)

    return signature(result, like, types.intp), generate


@intrinsic
def store_rows(typing_context: Any, rows: Any, block: Any, structure: Any) -> Any:
    """Write the numbers of (nested tuples of) lanes, depth first, as rows of a contiguous array, for compiled code.

    The array, of any kind of numbers, has a row for every lane of every block, and a column for every number.
    """

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        array = context.make_array(sig.args[0])(context, builder, values[0])
        numbers = leaves(builder, structure, values[2])
        kinds = _leaf_types(structure)
        columns, width = len(numbers), kinds[0].width
        first = builder.mul(values[1], _integer(values[1], width * columns))
        for column, (kind, number) in enumerate(zip(kinds, numbers, strict=True)):
            for lane in range(width):
                place = builder.add(first, _integer(first, lane * columns + column))
                value = context.cast(builder, extract(builder, number, lane), kind.dtype, sig.args[0].dtype)
                pointer = cgutils.gep_inbounds(builder, array.data, place)
                context.pack_value(builder, sig.args[0].dtype, value, pointer)
        return context.get_dummy_value()

    return signature(types.none, rows, types.intp, structure), generate


@intrinsic
def store_columns(typing_context: Any, columns: Any, block: Any, structure: Any) -> Any:
    """Write the numbers of (nested tuples of) lanes, depth first, each into its row of a contiguous array."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        array = context.make_array(sig.args[0])(context, builder, values[0])
        bodies = cgutils.unpack_tuple(builder, array.shape, 2)[1]
        kinds = _leaf_types(structure)
        for row, (kind, number) in enumerate(zip(kinds, leaves(builder, structure, values[2]), strict=True)):
            start = builder.mul(bodies, _integer(bodies, row))
            first = builder.add(start, builder.mul(values[1], _integer(values[1], kind.width)))
            for lane in range(kind.width):
                value = context.cast(builder, extract(builder, number, lane), kind.dtype, sig.args[0].dtype)
                pointer = cgutils.gep_inbounds(builder, array.data, builder.add(first, _integer(first, lane)))
                context.pack_value(builder, sig.args[0].dtype, value, pointer)
        return context.get_dummy_value()

    return signature(types.none, columns, types.intp, structure), generate


def _leaf_types(kind: types.Type) -> list[Any]:
    if not isinstance(kind, types.BaseTuple):
        return [kind]
    return [leaf for inner in kind.types for leaf in _leaf_types(inner)]


def _integer(like: Any, value: int) -> Any:
    return ir.Constant(like.type, value)
