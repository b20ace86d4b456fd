"""`algebra.stages.weighted_sum` in compiled code: four numbers of one body at a time.

Sums of many rates are a good part of an explicit method of high order. A body's numbers go into LLVM vectors once for
all sums that they are in; bodies in lanes are vectors already. Every number is added up as it would be alone.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.errors import TypingError
from numba.core.typing import signature
from numba.extending import intrinsic

from dq_marine.algebra import stages
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.selection import provide
from dq_marine.backend.stage_layout import flags_of, joined, summed, weights_of

WIDTH = 4
"""Numbers that are added up at once: doubles in a vector of 256 bits."""

PACK = Lanes(types.float64, WIDTH, types.float64, False)


def leaves(builder: Any, kind: types.Type, value: Any) -> list[tuple[types.Type, Any]]:
    """Return the type and the value of every number in nested tuples."""
    if not isinstance(kind, types.BaseTuple):
        return [(kind, value)]
    return [
        leaf
        for index, part in enumerate(kind.types)
        for leaf in leaves(builder, part, builder.extract_value(value, index))
    ]


def in_packs(builder: Any, kinds: list[types.Type], structures: list[list[Any]]) -> list[Any]:
    """Return the values of structures for sums: those of four numbers of one body in one vector, others as they are.

    Each is a pair of its type and the values that it has in all structures.
    """
    whole = len(kinds) - len(kinds) % WIDTH if all(kind == types.float64 for kind in kinds) else 0
    packs = [
        (PACK, [joined(builder, values[at : at + WIDTH]) for values in structures])
        for at in range(0, whole, WIDTH)
    ]
    return packs + [(kinds[at], [values[at] for values in structures]) for at in range(whole, len(kinds))]


def unpacked(builder: Any, kind: types.Type, value: Any) -> list[Any]:
    """Return the numbers in a pack; what is none stays."""
    if kind != PACK:
        return [value]
    return [builder.extract_element(value, ir.Constant(ir.IntType(32), place)) for place in range(WIDTH)]


@intrinsic
def sum_of_structures(typing_context: Any, weights: Any, structures: Any) -> Any:
    """sum_j w_j x_j of (nested tuples of) ordinary numbers of one type."""
    count = len(structures.types)
    result = structures.types[0]
    if any(kind != result for kind in structures.types):
        raise TypingError(f"{structures.types} are not of one kind; sums are of structures of one type")

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        parts = [leaves(builder, result, builder.extract_value(values[1], j)) for j in range(count)]
        kinds = [kind for kind, _ in parts[0]]
        numbers: list[Any] = []
        for kind, members in in_packs(builder, kinds, [[value for _, value in part] for part in parts]):
            factors = weights_of(context, builder, weights, values[0], count, kind)
            flags = flags_of(kind)
            terms = [builder.fmul(w, x, flags) for w, x in zip(factors, members, strict=True)]
            numbers += unpacked(builder, kind, summed(builder, terms, flags))
        remaining = iter(numbers)

        def build(kind: types.Type) -> Any:
            if not isinstance(kind, types.BaseTuple):
                return next(remaining)
            return context.make_tuple(builder, kind, [build(part) for part in kind.types])

        return build(result)

    return signature(result, weights, structures), generate


@provide(stages.weighted_sum)
def _weighted_sum(weights: Any, structures: Any) -> Any:
    return lambda weights, structures: sum_of_structures(weights, structures)
