"""`algebra.selection` in compiled code: branches for one body, masks for lanes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.core.typing import signature
from numba.extending import intrinsic, overload

from dq_marine.algebra import selection
from dq_marine.backend.inlining import INLINED
from dq_marine.backend.lane_type import Lanes, all_bits, any_bit, as_lanes, extract

PROVIDED: set[Callable[..., Any]] = set()
"""Pure functions that compiled code has from here, not from their Python text."""


def provide(function: Callable[..., Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a pure function its compiled form, chosen by the types of its arguments."""
    PROVIDED.add(function)
    return overload(function, strict=False, jit_options=INLINED)


def find_lanes(*kinds: types.Type) -> Lanes | None:
    """Return the first lanes type in nested tuple types, None if there is none."""
    for kind in kinds:
        if isinstance(kind, Lanes):
            return kind
        if isinstance(kind, types.BaseTuple):
            found = find_lanes(*kind.types)
            if found is not None:
                return found
    return None


def is_one_for_all(kind: types.Type) -> bool:
    """Whether a part of nested tuples is no number: a table, which bodies in lanes share."""
    return not isinstance(kind, Lanes | types.Number | types.Boolean)


def selected_type(mask: Lanes, chosen: types.Type, otherwise: types.Type) -> types.Type:
    """Return the type of a selection by lanes: numbers become lanes, tuples are taken apart, a table is one for all."""
    if isinstance(chosen, types.BaseTuple):
        pairs = zip(chosen.types, otherwise.types, strict=True)
        named = getattr(chosen, "instance_class", None)
        return types.BaseTuple.from_types(tuple(selected_type(mask, a, b) for a, b in pairs), named)
    if chosen == otherwise and is_one_for_all(chosen):
        return chosen
    lanes = find_lanes(chosen, otherwise)
    if lanes is None:
        lanes = mask.like(chosen)
        if not lanes.holds(otherwise):
            lanes = mask.like(otherwise)
    for part in (chosen, otherwise):
        if part != lanes and (isinstance(part, Lanes) or not lanes.holds(part)):
            raise TypingError(
                f"{chosen} and {otherwise} are not of one kind; select between numbers that are"
            )
    return lanes


@intrinsic
def select_lanes(typing_context: Any, mask: Any, chosen: Any, otherwise: Any) -> Any:
    """Blend (nested tuples of) lanes by a mask."""
    result = selected_type(mask, chosen, otherwise)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def blend(part: Any, a_type: Any, b_type: Any, a: Any, b: Any) -> Any:
            if isinstance(part, types.BaseTuple):
                items = [
                    blend(*kinds, builder.extract_value(a, i), builder.extract_value(b, i))
                    for i, kinds in enumerate(zip(part.types, a_type.types, b_type.types, strict=True))
                ]
                return context.make_tuple(builder, part, items)
            if is_one_for_all(part):
                return a
            wide_a = as_lanes(context, builder, a, a_type, part)
            wide_b = as_lanes(context, builder, b, b_type, part)
            return builder.select(values[0], wide_a, wide_b)

        return blend(result, chosen, otherwise, values[1], values[2])

    return signature(result, mask, chosen, otherwise), generate


def make_reduce(reduce: Callable[[Any, Any], Any]) -> Callable[[Any], Any]:
    """Return a function for compiled code from a mask to one bool."""

    @intrinsic
    def reduce_mask(typing_context: Any, mask: Any) -> Any:
        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            return reduce(builder, values[0])

        return signature(types.boolean, mask), generate

    return reduce_mask


any_lane = make_reduce(any_bit)
all_lanes = make_reduce(all_bits)


@intrinsic
def invert_mask(typing_context: Any, mask: Any) -> Any:
    """The lanes that are not set."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        return builder.not_(values[0])

    return signature(mask, mask), generate


@intrinsic
def spread_lanes(typing_context: Any, value: Any, like: Any) -> Any:
    """(Nested tuples of) numbers or conditions, the same in every lane."""
    number = types.unliteral(value)
    result = selected_type(like, number, number)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def build(part: Any, kind: Any, inner: Any) -> Any:
            if not isinstance(part, types.BaseTuple):
                return inner if is_one_for_all(part) else as_lanes(context, builder, inner, kind, part)
            items = [
                build(a, b, builder.extract_value(inner, i))
                for i, (a, b) in enumerate(zip(part.types, kind.types, strict=True))
            ]
            return context.make_tuple(builder, part, items)

        return build(result, number, values[0])

    return signature(result, number, like), generate


def scalar_of(kind: types.Type) -> types.Type:
    """Return the type of one lane of (nested tuples of) lanes, in double precision."""
    if isinstance(kind, types.BaseTuple):
        named = getattr(kind, "instance_class", None)
        return types.BaseTuple.from_types(tuple(scalar_of(inner) for inner in kind.types), named)
    if isinstance(kind, Lanes):
        return types.float64 if isinstance(kind.dtype, types.Float) else kind.dtype
    return kind


@intrinsic
def take_lane(typing_context: Any, structure: Any, lane: Any) -> Any:
    """One lane of (nested tuples of) lanes as scalars, floats in double precision; scalars stay."""
    result = scalar_of(structure)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        index = builder.trunc(values[1], ir.IntType(32))

        def take(kind: Any, value: Any) -> Any:
            if isinstance(kind, types.BaseTuple):
                items = [take(inner, builder.extract_value(value, i)) for i, inner in enumerate(kind.types)]
                return context.make_tuple(builder, scalar_of(kind), items)
            if not isinstance(kind, Lanes):
                if context.enable_nrt:
                    context.nrt.incref(builder, kind, value)  # an array is handed out once more
                return value
            number = extract(builder, value, index)
            if isinstance(kind.dtype, types.Float):
                return context.cast(builder, number, kind.dtype, types.float64)
            return number

        return take(structure, values[0])

    return signature(result, structure, types.intp), generate


@intrinsic
def put_lane(typing_context: Any, structure: Any, lane: Any, scalars: Any) -> Any:
    """(Nested tuples of) lanes with one lane replaced by scalars; what is no lane stays."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        index = builder.trunc(values[1], ir.IntType(32))

        def put(kind: Any, source: Any, value: Any, number: Any) -> Any:
            if isinstance(kind, types.BaseTuple):
                items = [
                    put(*kinds, builder.extract_value(value, i), builder.extract_value(number, i))
                    for i, kinds in enumerate(zip(kind.types, source.types, strict=True))
                ]
                return context.make_tuple(builder, kind, items)
            if not isinstance(kind, Lanes):
                return value
            element = context.cast(builder, number, source, kind.dtype)
            if isinstance(kind.dtype, types.Boolean):
                element = cgutils.is_not_null(builder, element)
            return builder.insert_element(value, element, index)

        return put(structure, scalars, values[0], values[2])

    return signature(structure, structure, types.intp, scalars), generate


@intrinsic
def lane_is_set(typing_context: Any, mask: Any, lane: Any) -> Any:
    """Whether one lane of a mask is set."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        return extract(builder, values[0], builder.trunc(values[1], ir.IntType(32)))

    return signature(types.boolean, mask, types.intp), generate


@provide(selection.spread)
def _spread(value: Any, like: Any) -> Any:
    if isinstance(like, Lanes):
        return lambda value, like: spread_lanes(value, like)
    return lambda value, like: value


@provide(selection.by_precision)
def _by_precision(like: Any, double: Any, single: Any) -> Any:
    if isinstance(like, Lanes) and like.precision == types.float32:
        return lambda like, double, single: single
    return lambda like, double, single: double


@intrinsic
def round_number(typing_context: Any, value: Any) -> Any:
    """The whole number next to a number, or to that of each lane, by one instruction."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        kind = values[0].type
        width = f"v{kind.count}" if isinstance(kind, ir.VectorType) else ""
        letter = "f64" if getattr(kind, "element", kind) == ir.DoubleType() else "f32"
        function_type = ir.FunctionType(kind, [kind])
        name = f"llvm.rint.{width}{letter}"
        return builder.call(cgutils.get_or_insert_function(builder.module, function_type, name), [values[0]])

    return signature(value, value), generate


@provide(selection.rounded)
def _rounded(value: Any) -> Any:
    return lambda value: round_number(value)


DOUBLE, SINGLE = (52, 1023, 64), (23, 127, 32)
"""Digits behind the point, bias of the exponent, and size in bits (IEEE 754)."""


class Bits(NamedTuple):
    """How a number, or one in every lane, is laid out: digits, the exponent's bias, and its type as an integer."""

    digits: int
    bias: int
    kind: ir.Type
    integer: ir.Type

    def number(self, value: float) -> ir.Constant:
        """Return a number, in every lane."""
        return self._everywhere(self.kind, value)

    def whole(self, value: int) -> ir.Constant:
        """Return an integer, in every lane."""
        return self._everywhere(self.integer, value)

    def _everywhere(self, kind: ir.Type, value: float) -> ir.Constant:
        return ir.Constant(kind, [value] * kind.count if isinstance(kind, ir.VectorType) else value)


def bits_of(kind: ir.Type) -> Bits:
    """Return the layout of a number's LLVM type."""
    wide = isinstance(kind, ir.VectorType)
    number = kind.element if wide else kind
    digits, bias, size = DOUBLE if number == ir.DoubleType() else SINGLE
    integer = ir.IntType(size)
    return Bits(digits, bias, kind, ir.VectorType(integer, kind.count) if wide else integer)


@intrinsic
def raise_two(typing_context: Any, exponent: Any) -> Any:
    """Two to the power of a whole number, or of that of each lane, written into the exponent of its bits.

    Added to 1.5 times the power of two whose last digit counts ones, a whole number stands in the last bits.
    """

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        bits = bits_of(values[0].type)
        shifted = builder.fadd(values[0], bits.number(1.5 * 2.0**bits.digits))
        biased = builder.add(builder.bitcast(shifted, bits.integer), bits.whole(bits.bias))
        return builder.bitcast(builder.shl(biased, bits.whole(bits.digits)), bits.kind)

    return signature(exponent, exponent), generate


@intrinsic
def read_exponent(typing_context: Any, value: Any) -> Any:
    """The exponent of a positive number, or of that of each lane, out of its bits.

    Written into the last bits of the power of two whose last digit counts ones, an integer is added to it.
    """

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        bits = bits_of(values[0].type)
        biased = builder.lshr(builder.bitcast(values[0], bits.integer), bits.whole(bits.digits))
        ones = 2.0**bits.digits
        added = builder.or_(biased, builder.bitcast(bits.number(ones), bits.integer))
        return builder.fsub(builder.bitcast(added, bits.kind), bits.number(ones + bits.bias))

    return signature(value, value), generate


@provide(selection.power_of_two)
def _power_of_two(exponent: Any) -> Any:
    return lambda exponent: raise_two(exponent)


@provide(selection.exponent_of)
def _exponent_of(value: Any) -> Any:
    return lambda value: read_exponent(value)


@provide(selection.select)
def _select(condition: Any, chosen: Any, otherwise: Any) -> Any:
    if isinstance(condition, Lanes):
        return lambda condition, chosen, otherwise: select_lanes(condition, chosen, otherwise)
    return lambda condition, chosen, otherwise: chosen if condition else otherwise


@provide(selection.negation)
def _negation(condition: Any) -> Any:
    if isinstance(condition, Lanes) and not isinstance(condition.dtype, types.Boolean):
        return None
    if isinstance(condition, Lanes):
        return lambda condition: invert_mask(condition)
    return lambda condition: not condition


@provide(selection.some)
def _some(condition: Any) -> Any:
    if isinstance(condition, Lanes):
        return lambda condition: any_lane(condition)
    return lambda condition: condition


@provide(selection.every)
def _every(condition: Any) -> Any:
    if isinstance(condition, Lanes):
        return lambda condition: all_lanes(condition)
    return lambda condition: condition


@provide(selection.select_call)
def _select_call(condition: Any, function: Any, arguments: Any, otherwise: Any) -> Any:
    if not isinstance(condition, Lanes):
        return lambda condition, function, arguments, otherwise: (
            function(*arguments) if condition else otherwise
        )
    width = condition.width

    def call_lane_by_lane(condition: Any, function: Any, arguments: Any, otherwise: Any) -> Any:
        result = otherwise
        for lane in range(width):
            if lane_is_set(condition, lane):
                result = put_lane(result, lane, function(*take_lane(arguments, lane)))
        return result

    return call_lane_by_lane
