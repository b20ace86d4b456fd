"""Rows of numbers as users have them, one body a row, read into lanes and written from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.extending import intrinsic

from dq_marine.backend.lane_type import Lanes, extract, spread
from dq_marine.backend.packing import leaf_types, leaves


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
        kinds = leaf_types(structure)
        columns, width = len(numbers), kinds[0].width
        first = builder.mul(values[1], _integer(values[1], width * columns))
        written = [
            _as_stored(context, builder, number, kind, sig.args[0].dtype)
            for kind, number in zip(kinds, numbers, strict=True)
        ]
        if columns == 1:
            _store(context, builder, array, first, written[0])
            return context.get_dummy_value()
        for start in range(0, columns, width):
            for lane, row in enumerate(_transposed(builder, written[start : start + width])):
                place = builder.add(first, _integer(first, lane * columns + start))
                _store(context, builder, array, place, row)
        return context.get_dummy_value()

    return signature(types.none, rows, types.intp, structure), generate


@intrinsic
def store_columns(typing_context: Any, columns: Any, block: Any, structure: Any) -> Any:
    """Write the numbers of (nested tuples of) lanes, depth first, each into its row of a contiguous array."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        array = context.make_array(sig.args[0])(context, builder, values[0])
        bodies = cgutils.unpack_tuple(builder, array.shape, 2)[1]
        kinds = leaf_types(structure)
        for row, (kind, number) in enumerate(zip(kinds, leaves(builder, structure, values[2]), strict=True)):
            start = builder.mul(bodies, _integer(bodies, row))
            first = builder.add(start, builder.mul(values[1], _integer(values[1], kind.width)))
            written = _as_stored(context, builder, number, kind, sig.args[0].dtype)
            _store(context, builder, array, first, written)
        return context.get_dummy_value()

    return signature(types.none, columns, types.intp, structure), generate


def _as_stored(context: Any, builder: Any, number: Any, kind: Lanes, goal: types.Type) -> Any:
    """Return lanes as a vector of what an array of some kind of numbers holds in memory."""
    stored = ir.VectorType(context.get_data_type(goal), kind.width)
    if number.type == stored:
        return number
    if isinstance(kind.dtype, types.Float) and isinstance(goal, types.Float):
        narrower = goal.bitwidth < kind.dtype.bitwidth
        return builder.fptrunc(number, stored) if narrower else builder.fpext(number, stored)
    vector = ir.Constant(stored, ir.Undefined)
    for lane in range(kind.width):
        value = context.cast(builder, extract(builder, number, lane), kind.dtype, goal)
        value = context.data_model_manager[goal].as_data(builder, value)
        vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), lane))
    return vector


def _store(context: Any, builder: Any, array: Any, place: Any, vector: Any) -> None:
    """Write a vector into an array, from a place on."""
    pointer = builder.bitcast(cgutils.gep_inbounds(builder, array.data, place), vector.type.as_pointer())
    builder.store(vector, pointer, align=context.get_abi_sizeof(vector.type.element))


def _transposed(builder: Any, columns: list[Any]) -> list[Any]:
    """Return a row for each lane: what the columns, as many as there are lanes or fewer, have there.

    To write whole rows is several times as fast as number by number. Neighbours are interleaved, by one number, then
    by two, then by four, until each vector holds whole rows.
    """
    width, missing = columns[0].type.count, ir.Constant(columns[0].type, ir.Undefined)
    count = 1 << (len(columns) - 1).bit_length()
    groups, size = [[column] for column in columns + [missing] * (count - len(columns))], 1
    while len(groups) > 1:
        pairs = zip(groups[::2], groups[1::2], strict=True)
        groups = [
            [part for a, b in zip(one, other, strict=True) for part in _interleaved(builder, a, b, size)]
            for one, other in pairs
        ]
        size *= 2
    return [
        _picked(builder, part, missing, range(start, start + len(columns)))
        for part in groups[0]
        for start in range(0, width, size)
    ]


def _interleaved(builder: Any, a: Any, b: Any, size: int) -> tuple[Any, Any]:
    """Return pieces of a size of two vectors in turn, as two vectors."""
    width = a.type.count
    places = [start + k for at in range(0, width, size) for start in (at, width + at) for k in range(size)]
    return _picked(builder, a, b, places[:width]), _picked(builder, a, b, places[width:])


def _picked(builder: Any, a: Any, b: Any, places: Sequence[int]) -> Any:
    """Return the numbers at some places of two vectors, of which the second goes on counting, as a vector."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(ir.IntType(32), len(places)), list(places)))


def _integer(like: Any, value: int) -> Any:
    return ir.Constant(like.type, value)
