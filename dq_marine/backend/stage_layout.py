"""How numbers at several stages lie in LLVM values, and their sums; `backend.stages` says which they are."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from dq_marine.algebra import stages
from dq_marine.backend.lane_type import Lanes, as_lanes


def at_stages(kind: types.Type, count: int) -> types.Type:
    """Return the type of a number at several stages, from its ordinary type."""
    if count == 1:
        return kind
    if isinstance(kind, Lanes):
        return kind if kind.stages > 1 else kind.at_stages(count)
    number = types.boolean if isinstance(kind, types.Boolean) else types.float64
    return Lanes(number, 1, types.float64, False).at_stages(count)


def of_one_stage(kind: types.Type) -> types.Type:
    """Return the ordinary type of a number at several stages; an ordinary one stays."""
    if not isinstance(kind, Lanes) or kind.stages == 1:
        return kind
    return kind.of_one_stage() if kind.piled else kind.dtype


def find_stages(kind: types.Type) -> Lanes | None:
    """Return the first type with several stages in nested tuple types, None if there is none."""
    if isinstance(kind, types.BaseTuple):
        return next(filter(None, map(find_stages, kind.types)), None)
    return kind if isinstance(kind, Lanes) and kind.stages > 1 else None


def mapped(kind: types.Type, change: Callable[[types.Type], types.Type]) -> types.Type:
    """Return the type of nested tuples with every number's type changed."""
    if isinstance(kind, types.BaseTuple):
        named = getattr(kind, "instance_class", None)
        return types.BaseTuple.from_types(tuple(mapped(part, change) for part in kind.types), named)
    return change(types.unliteral(kind))


def rebuilt(
    context: Any, builder: Any, kind: types.Type, result: types.Type, value: Any, change: Callable[..., Any]
) -> Any:
    """Return the LLVM value of nested tuples with every number changed by (its type, the result's, its value)."""
    if not isinstance(kind, types.BaseTuple):
        return change(kind, result, value)
    parts = [
        rebuilt(context, builder, inner, outer, builder.extract_value(value, index), change)
        for index, (inner, outer) in enumerate(zip(kind.types, result.types, strict=True))
    ]
    return context.make_tuple(builder, result, parts)


def widened(context: Any, builder: Any, kind: types.Type, result: Lanes, value: Any) -> Any:
    """Return an ordinary number as stages that all hold it; stages stay."""
    if kind == result:
        return value
    if not result.piled:
        return as_lanes(context, builder, value, kind, result)
    return joined(builder, [as_lanes(context, builder, value, kind, result.of_one_stage())] * result.stages)


def shuffled(builder: Any, value: Any, places: list[int]) -> Any:
    """Return the vector of a vector's numbers at some places."""
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(places)), places)
    return builder.shuffle_vector(value, ir.Constant(value.type, ir.Undefined), mask)


def taken(builder: Any, kind: types.Type, value: Any, stage: int) -> Any:
    """Return one stage of a number; an ordinary one stays."""
    if not isinstance(kind, Lanes) or kind.stages == 1:
        return value
    if kind.piled:
        return builder.extract_value(value, stage)
    return builder.extract_element(value, ir.Constant(ir.IntType(32), stage))


def joined(builder: Any, parts: list[Any]) -> Any:
    """Return the numbers of several stages: numbers side by side in a vector, vectors in an array."""
    if len(parts) == 1:
        return parts[0]
    if isinstance(parts[0].type, ir.VectorType):
        whole = ir.Constant(ir.ArrayType(parts[0].type, len(parts)), ir.Undefined)
        for place, part in enumerate(parts):
            whole = builder.insert_value(whole, part, place)
        return whole
    whole = ir.Constant(ir.VectorType(parts[0].type, len(parts)), ir.Undefined)
    for place, part in enumerate(parts):
        whole = builder.insert_element(whole, part, ir.Constant(ir.IntType(32), place))
    return whole


def swapped(builder: Any, value: Any, count: int) -> list[Any]:
    """Return a vector of 2 or 4 stages with stages i and i ^ j swapped, for every j.

    Swaps are the cheapest shuffles that there are. In sums of pairs every stage still adds the same numbers: only the
    sides of additions change.
    """
    neighbours = [place ^ 1 for place in range(count)]
    parts = [value, shuffled(builder, value, neighbours)]
    if count == 4:
        across = shuffled(builder, value, [2, 3, 0, 1])
        parts += [across, shuffled(builder, across, neighbours)]
    return parts


def spread_stages(builder: Any, value: Any, count: int) -> list[Any]:
    """Return a vector of stages with stage j at all places, for every j."""
    return [shuffled(builder, value, [j] * count) for j in range(count)]


def weights_of(
    context: Any, builder: Any, kind: types.Type, weights: Any, count: int, result: types.Type
) -> list[Any]:
    """Return each weight as a value of the result's type."""
    return [
        as_lanes(context, builder, builder.extract_value(weights, j), kind.types[j], result)
        if isinstance(result, Lanes)
        else context.cast(builder, builder.extract_value(weights, j), kind.types[j], result)
        for j in range(count)
    ]


def summed(builder: Any, terms: list[Any], flags: tuple[str, ...]) -> Any:
    """Return the sum of terms in pairs, as `algebra.stages.paired_sum` has it."""
    return stages.paired_sum([_Term(builder, term, flags) for term in terms]).value


class _Term:
    """An LLVM value that can be added."""

    def __init__(self, builder: Any, value: Any, flags: tuple[str, ...]) -> None:
        self.builder, self.value, self.flags = builder, value, flags

    def __add__(self, other: _Term) -> _Term:
        return _Term(self.builder, self.builder.fadd(self.value, other.value, self.flags), self.flags)


def flags_of(kind: types.Type) -> tuple[str, ...]:
    """Return the flags of floating-point instructions on a number."""
    return kind.flags if isinstance(kind, Lanes) else ()


def stage_by_stage(builder: Any, rows: list[list[Any]], whole: Any, lanes: Lanes) -> Any:
    """Return a matrix product of stages that are piled up."""
    parts = [builder.extract_value(whole, j) for j in range(len(rows))]
    return joined(
        builder,
        [
            summed(
                builder,
                [builder.fmul(a, x, lanes.flags) for a, x in zip(row, parts, strict=True)],
                lanes.flags,
            )
            for row in rows
        ],
    )


def side_by_side(builder: Any, rows: list[list[Any]], whole: Any, lanes: Lanes) -> Any:
    """Return a matrix product of stages in one vector."""
    count = len(rows)
    swap = count in (2, 4)
    # The stage that meets stage i in term j: stage j, or the partner that flipped bits of i name.
    partners = [[i ^ j if swap else j for i in range(count)] for j in range(count)]
    columns = [joined(builder, [rows[i][partner[i]] for i in range(count)]) for partner in partners]
    parts = swapped(builder, whole, count) if swap else spread_stages(builder, whole, count)
    terms = [builder.fmul(a, x, lanes.flags) for a, x in zip(columns, parts, strict=True)]
    return summed(builder, terms, lanes.flags)
