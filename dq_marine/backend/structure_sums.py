"""`algebra.stages.weighted_sum` and `weighted_step` in compiled code: four numbers of one body at a time.

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
from dq_marine.backend.packing import leaf_types, leaves
from dq_marine.backend.selection import provide
from dq_marine.backend.stage_layout import flags_of, joined, rebuilt, summed, weights_of

WIDTH = 4
"""Numbers that are added up at once: doubles in a vector of 256 bits."""

PACK = Lanes(types.float64, WIDTH, types.float64, False)


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


def products_summed(builder: Any, kind: types.Type, factors: list[Any], members: list[Any]) -> Any:
    """Return the sum of factors times numbers."""
    flags = flags_of(kind)
    return summed(builder, [builder.fmul(w, x, flags) for w, x in zip(factors, members, strict=True)], flags)


@intrinsic
def sum_of_structures(typing_context: Any, weights: Any, structures: Any) -> Any:
    """sum_j w_j x_j of (nested tuples of) ordinary numbers of one type."""
    count = len(structures.types)
    result = structures.types[0]
    if any(kind != result for kind in structures.types):
        raise TypingError(f"{structures.types} are not of one kind; sums are of structures of one type")

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        parts = [builder.extract_value(values[1], j) for j in range(count)]
        numbers: list[Any] = []
        for kind, members in in_packs(
            builder, leaf_types(result), [leaves(builder, result, part) for part in parts]
        ):
            factors = weights_of(context, builder, weights, values[0], count, kind)
            numbers += unpacked(builder, kind, products_summed(builder, kind, factors, members))
        sums = iter(numbers)
        return rebuilt(context, builder, result, result, parts[0], lambda *_: next(sums))

    return signature(result, weights, structures), generate


@intrinsic
def step_of_structures(typing_context: Any, start: Any, lengths: Any, weights: Any, rates: Any) -> Any:
    """A start x + sum_j (h w_j) k_j of (nested tuples of) ordinary numbers of one type; `lengths` is (h,).

    All h w_j are found first: compilers take them out of the loop over the steps.
    """
    count = len(rates.types)
    if any(leaf_types(kind) != leaf_types(start) for kind in rates.types):
        raise TypingError(f"{rates.types} do not lead on from {start}; rates have the numbers that it has")

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        parts = [builder.extract_value(values[3], j) for j in range(count)]
        structures = [
            leaves(builder, start, values[0]),
            *(leaves(builder, kind, part) for kind, part in zip(rates.types, parts, strict=True)),
        ]
        numbers: list[Any] = []
        for kind, (begun, *members) in in_packs(builder, leaf_types(start), structures):
            flags = flags_of(kind)
            (h,) = weights_of(context, builder, lengths, values[1], 1, kind)
            shares = weights_of(context, builder, weights, values[2], count, kind)
            factors = [builder.fmul(h, share, flags) for share in shares]
            change = products_summed(builder, kind, factors, members)
            numbers += unpacked(builder, kind, builder.fadd(begun, change, flags))
        reached = iter(numbers)
        return rebuilt(context, builder, start, start, values[0], lambda *_: next(reached))

    return signature(start, start, lengths, weights, rates), generate


@provide(stages.weighted_sum)
def _weighted_sum(weights: Any, structures: Any) -> Any:
    return lambda weights, structures: sum_of_structures(weights, structures)


@provide(stages.weighted_step)
def _weighted_step(start: Any, h: Any, weights: Any, rates: Any) -> Any:
    return lambda start, h, weights, rates: step_of_structures(start, (h,), weights, rates)
