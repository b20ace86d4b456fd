"""`algebra.stages` in compiled code: the stages of a body side by side in an LLVM vector.

Stages of one body are `Lanes`, one for each stage. Those of bodies in lanes are lanes, too, as many times as there are
stages: an array of vectors, all bodies at one stage in each. Both kinds know how many `stages` they hold. Functions are
called once for all stages of one body, but of bodies in lanes stage by stage: their vectors are full, and one of all
stages would not fit into the processor's registers. What a method with one stage has at its stage is an ordinary
number.

The same vectors serve what is computed several times for one body, such as a fan's beams: `for_each`.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core.errors import TypingError
from numba.core.typing import signature
from numba.extending import intrinsic

import dq_marine.backend.lane_arithmetic  # noqa: F401  teaches Numba to compute with lanes
from dq_marine.algebra import stages
from dq_marine.backend.lane_type import Lanes, as_lanes, is_scalar
from dq_marine.backend.selection import find_lanes, provide
from dq_marine.backend.stage_layout import (
    at_stages,
    find_stages,
    flags_of,
    joined,
    mapped,
    of_one_stage,
    rebuilt,
    side_by_side,
    stage_by_stage,
    summed,
    taken,
    weights_of,
    widened,
)


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
def sum_of_stages(typing_context: Any, weights: Any, structure: Any) -> Any:
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

    staged = find_stages(arguments)
    if staged is None:
        return call_once
    if not staged.piled:
        return call
    return {2: call_two, 3: call_three, 4: call_four}[len(weights.types)]


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


MOST_CASES = 4
"""As many cases of one body are computed at a time: doubles in a vector of 256 bits.

Wider vectors slow down what is computed beside them on some processors: of a step on an Intel Xeon (Emerald Rapids)
twelve stages of a thrust took 170 ns by eights, and take 35 by fours (docs/theory.md, "What is known ahead").
"""


@provide(stages.for_each)
def _for_each(cases: Any, function: Any, others: Any) -> Any:
    def in_turn(cases: Any, function: Any, others: Any) -> Any:
        return (function(cases[0], others), *stages.for_each(cases[1:], function, others))

    def side_by_side(cases: Any, function: Any, others: Any) -> Any:
        return apart(cases, function(together(cases), others))

    def in_groups(cases: Any, function: Any, others: Any) -> Any:
        first, rest = cases[:MOST_CASES], cases[MOST_CASES:]
        return (*stages.for_each(first, function, others), *stages.for_each(rest, function, others))

    if len(cases.types) == 1:
        return lambda cases, function, others: (function(cases[0], others),)
    if find_lanes(others) is not None or find_lanes(cases) is not None:
        return in_turn
    return side_by_side if len(cases.types) <= MOST_CASES else in_groups


@provide(stages.stage_constants)
def _stage_constants(weights: Any, like: Any) -> Any:
    return lambda weights, like: constants(weights, like)


@provide(stages.stage_sum)
def _stage_sum(weights: Any, structure: Any) -> Any:
    return lambda weights, structure: sum_of_stages(weights, structure)


@provide(stages.stage_product)
def _stage_product(matrix: Any, structure: Any) -> Any:
    if len(matrix.types) == 1:
        return lambda matrix, structure: sum_of_stages(matrix[0], structure)
    return lambda matrix, structure: matrix_product(matrix, structure)


@provide(stages.stages_apart)
def _stages_apart(weights: Any, structure: Any) -> Any:
    return lambda weights, structure: apart(weights, structure)


@provide(stages.stages_together)
def _stages_together(structures: Any) -> Any:
    return lambda structures: together(structures)
