"""`algebra.stages` in compiled code: the stages of a body side by side in an LLVM vector.

Stages of one body are `Lanes`, one for each stage. Those of bodies in lanes are lanes, too, as many times as there are
stages: an array of vectors, all bodies at one stage in each. Both kinds know how many `stages` they hold. Functions are
called once for all stages of one body, but of bodies in lanes stage by stage: their vectors are full, and one of all
stages would not fit into the processor's registers. What a method with one stage has at its stage is an ordinary
number.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.errors import TypingError
from numba.core.typing import signature
from numba.extending import intrinsic

import dq_marine.backend.lane_arithmetic  # noqa: F401  teaches Numba to compute with lanes
from dq_marine.algebra import stages
from dq_marine.backend.lane_type import Lanes, as_lanes, is_scalar
from dq_marine.backend.selection import find_lanes, provide


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


def has_stages(kind: types.Type) -> bool:
    """Whether nested tuples have a number that differs between stages."""
    if isinstance(kind, types.BaseTuple):
        return any(has_stages(part) for part in kind.types)
    return isinstance(kind, Lanes) and kind.stages > 1


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


@intrinsic
def widen(typing_context: Any, weights: Any, structure: Any) -> Any:
    """(Nested tuples of) numbers, the same at all stages; those that are shared by all bodies stay."""
    count = len(weights.types)

    def change(kind: types.Type) -> types.Type:
        return at_stages(kind, count) if isinstance(kind, Lanes) else kind

    result = mapped(structure, change)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def each(kind: Any, wide: Any, value: Any) -> Any:
            if isinstance(kind, Lanes):
                return widened(context, builder, kind, wide, value)
            if context.enable_nrt:
                context.nrt.incref(builder, kind, value)
            return value

        return rebuilt(context, builder, structure, result, values[1], each)

    return signature(result, weights, structure), generate


@intrinsic
def widen_all(typing_context: Any, weights: Any, structure: Any, like: Any) -> Any:
    """(Nested tuples of) numbers at all stages, those that are shared by all stages included."""
    count = len(weights.types)
    lanes = at_stages(types.unliteral(like), count)

    def change(kind: types.Type) -> types.Type:
        return at_stages(kind, count) if isinstance(kind, Lanes) else lanes.like(kind)

    result = mapped(structure, change)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def each(kind: Any, wide: Any, value: Any) -> Any:
            return widened(context, builder, kind, wide, value)

        return rebuilt(context, builder, structure, result, values[1], each)

    return signature(result, weights, structure, like), generate


@intrinsic
def constants(typing_context: Any, weights: Any, like: Any) -> Any:
    """The numbers of a method, each at its own stage."""
    count = len(weights.types)
    if not (isinstance(like, Lanes) or is_scalar(like)):
        return None
    ordinary = like.of(like.precision) if isinstance(like, Lanes) else types.float64
    result = at_stages(ordinary, count)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        one = of_one_stage(result)
        return joined(builder, weights_of(context, builder, weights, values[0], count, one))

    return signature(result, weights, like), generate


@intrinsic
def weighted_sum(typing_context: Any, weights: Any, structure: Any) -> Any:
    """sum_j w_j x_j of (nested tuples of) stages."""
    count = len(weights.types)
    result = mapped(structure, of_one_stage)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def each(kind: Any, one: Any, value: Any) -> Any:
            factors = weights_of(context, builder, weights, values[0], count, one)
            parts = [taken(builder, kind, value, j) for j in range(count)]
            flags = flags_of(one)
            return summed(
                builder, [builder.fmul(w, x, flags) for w, x in zip(factors, parts, strict=True)], flags
            )

        return rebuilt(context, builder, structure, result, values[1], each)

    return signature(result, weights, structure), generate


@intrinsic
def matrix_product(typing_context: Any, matrix: Any, structure: Any) -> Any:
    """sum_j A_ij x_j of (nested tuples of) stages, at all stages i."""
    count = len(matrix.types)
    found = find_lanes(structure)
    if found is None:
        return None
    lanes = found.of(found.precision)
    result = mapped(structure, lambda kind: lanes)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        one = of_one_stage(lanes)
        rows = [
            weights_of(context, builder, matrix.types[i], builder.extract_value(values[0], i), count, one)
            for i in range(count)
        ]
        product = stage_by_stage if lanes.piled else side_by_side

        def each(kind: Any, wide: Any, value: Any) -> Any:
            whole = widened(context, builder, kind, lanes, value)
            return product(builder, rows, whole, lanes)

        return rebuilt(context, builder, structure, result, values[1], each)

    return signature(result, matrix, structure), generate


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
    if swap:
        parts = swapped(builder, whole, count)
    else:
        parts = [shuffled(builder, whole, [j] * count) for j in range(count)]
    terms = [builder.fmul(a, x, lanes.flags) for a, x in zip(columns, parts, strict=True)]
    return summed(builder, terms, lanes.flags)


@intrinsic
def apart(typing_context: Any, weights: Any, structure: Any) -> Any:
    """A tuple of structures of ordinary numbers, one for each stage."""
    count = len(weights.types)
    one = mapped(structure, of_one_stage)
    result = types.BaseTuple.from_types((one,) * count)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def stage(j: int) -> Any:
            def each(kind: Any, _: Any, value: Any) -> Any:
                if context.enable_nrt and not isinstance(kind, Lanes):
                    context.nrt.incref(builder, kind, value)
                return taken(builder, kind, value, j)

            return rebuilt(context, builder, structure, one, values[1], each)

        return context.make_tuple(builder, result, [stage(j) for j in range(count)])

    return signature(result, weights, structure), generate


@intrinsic
def together(typing_context: Any, structures: Any) -> Any:
    """Stages, from a tuple of structures of ordinary numbers of one type."""
    kinds = structures.types
    count = len(kinds)
    if any(kind != kinds[0] for kind in kinds):
        raise TypingError(f"{kinds} are not of one kind; stages have structures of one type")
    result = mapped(kinds[0], lambda kind: at_stages(kind, count))

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        parts = [builder.extract_value(values[0], j) for j in range(count)]

        def build(kind: Any, wide: Any, members: list[Any]) -> Any:
            if not isinstance(kind, types.BaseTuple):
                return joined(builder, members)
            inner = [
                build(*kinds, [builder.extract_value(member, index) for member in members])
                for index, kinds in enumerate(zip(kind.types, wide.types, strict=True))
            ]
            return context.make_tuple(builder, wide, inner)

        return build(kinds[0], result, parts)

    return signature(result, structures), generate


@provide(stages.each_stage)
def _each_stage(weights: Any, function: Any, arguments: Any) -> Any:
    if len(weights.types) == 1:
        return lambda weights, function, arguments: function(*arguments)
    if find_lanes(arguments) is None:
        return lambda weights, function, arguments: widen_all(weights, function(*arguments), 0.0)

    def call_once(weights: Any, function: Any, arguments: Any) -> Any:
        return widen_all(weights, function(*arguments), first_lanes(arguments))

    def call(weights: Any, function: Any, arguments: Any) -> Any:
        return widen_all(weights, function(*widen(weights, arguments)), first_lanes(arguments))

    def call_two(weights: Any, function: Any, arguments: Any) -> Any:
        first, second = apart(weights, arguments)
        return piled((function(*first), function(*second)), first_lanes(arguments))

    def call_three(weights: Any, function: Any, arguments: Any) -> Any:
        first, second, third = apart(weights, arguments)
        return piled((function(*first), function(*second), function(*third)), first_lanes(arguments))

    def call_four(weights: Any, function: Any, arguments: Any) -> Any:
        first, second, third, fourth = apart(weights, arguments)
        return piled(
            (function(*first), function(*second), function(*third), function(*fourth)), first_lanes(arguments)
        )

    if not has_stages(arguments):
        return call_once
    if not find_stages(arguments).piled:
        return call
    return {2: call_two, 3: call_three, 4: call_four}[len(weights.types)]


def find_stages(kind: types.Type) -> Lanes | None:
    """Return the first type with several stages in nested tuple types, None if there is none."""
    if isinstance(kind, types.BaseTuple):
        return next(filter(None, map(find_stages, kind.types)), None)
    return kind if isinstance(kind, Lanes) and kind.stages > 1 else None


@intrinsic
def piled(typing_context: Any, structures: Any, like: Any) -> Any:
    """Stages of bodies in lanes, from a tuple of structures, one for each stage."""
    kinds = structures.types
    count = len(kinds)
    lanes = at_stages(like, count)

    def change(kind: types.Type) -> types.Type:
        return at_stages(kind, count) if isinstance(kind, Lanes) else lanes.like(kind)

    result = mapped(kinds[0], change)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def build(kind: Any, wide: Any, members: list[Any]) -> Any:
            if not isinstance(kind, types.BaseTuple):
                one = wide.of_one_stage()
                return joined(builder, [as_lanes(context, builder, member, kind, one) for member in members])
            inner = [
                build(part, outer, [builder.extract_value(member, index) for member in members])
                for index, (part, outer) in enumerate(zip(kind.types, wide.types, strict=True))
            ]
            return context.make_tuple(builder, wide, inner)

        parts = [builder.extract_value(values[0], j) for j in range(count)]
        return build(kinds[0], result, parts)

    return signature(result, structures, like), generate


@intrinsic
def first_lanes(typing_context: Any, structure: Any) -> Any:
    """The first lanes in nested tuples."""
    result = find_lanes(structure)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def find(kind: Any, value: Any) -> Any:
            if isinstance(kind, Lanes):
                return value
            for index, inner in enumerate(kind.types if isinstance(kind, types.BaseTuple) else ()):
                found = find(inner, builder.extract_value(value, index))
                if found is not None:
                    return found
            return None

        return find(structure, values[0])

    return signature(result, structure), generate


@provide(stages.stage_constants)
def _stage_constants(weights: Any, like: Any) -> Any:
    return lambda weights, like: constants(weights, like)


@provide(stages.stage_sum)
def _stage_sum(weights: Any, structure: Any) -> Any:
    return lambda weights, structure: weighted_sum(weights, structure)


@provide(stages.stage_product)
def _stage_product(matrix: Any, structure: Any) -> Any:
    if len(matrix.types) == 1:
        return lambda matrix, structure: weighted_sum(matrix[0], structure)
    return lambda matrix, structure: matrix_product(matrix, structure)


@provide(stages.stages_apart)
def _stages_apart(weights: Any, structure: Any) -> Any:
    return lambda weights, structure: apart(weights, structure)


@provide(stages.stages_together)
def _stages_together(structures: Any) -> Any:
    return lambda structures: together(structures)
