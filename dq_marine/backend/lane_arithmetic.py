"""What Numba needs to know to compute with `Lanes`: operators, min and max, and functions of `math`."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import lower_builtin

from dq_marine.backend.lane_type import Lanes, as_lanes, extract, is_scalar

NUMBERS = (types.Float, types.Integer)
CONDITIONS = (types.Boolean,)


def fit(args: tuple[types.Type, ...], of: tuple[type[types.Type], ...]) -> bool:
    """Whether operands are lanes of one type, of one of some kinds of numbers, and scalars that these can hold."""
    lanes = {kind for kind in args if isinstance(kind, Lanes)}
    if len(lanes) != 1:
        return False
    (common_type,) = lanes
    return isinstance(common_type.dtype, of) and all(
        kind in lanes or (is_scalar(kind) and common_type.holds(kind)) for kind in args
    )


def common(args: tuple[types.Type, ...]) -> Lanes:
    """Return the lanes type in which operands that fit meet."""
    return next(kind for kind in args if isinstance(kind, Lanes))


def teach(
    function: Any,
    arity: int,
    result: Callable[[Lanes], Lanes],
    emit: Callable[..., Any],
    of: tuple[type[types.Type], ...] = (types.Float,),
) -> None:
    """Let Numba type and lower a function of lanes (and scalars).

    Args:
        function: an operator, a builtin or a function of `math`.
        arity: number of operands.
        result: from the operands' lanes type to the result's.
        emit: (context, builder, operands' type, *values) -> LLVM value.
        of: the kinds of numbers that it is for.
    """

    class LaneTemplate(AbstractTemplate):
        key = function

        def generic(self, args: Any, kws: Any) -> Any:
            if kws or len(args) != arity or not fit(args, of):
                return None
            return signature(result(common(args)), *args)

    infer_global(function)(LaneTemplate)

    def lower(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        operands = common(sig.args)
        spread = [
            as_lanes(context, builder, value, kind, operands)
            for value, kind in zip(values, sig.args, strict=True)
        ]
        return emit(context, builder, operands, *spread)

    kinds = (Lanes, types.Number, types.Boolean)
    shapes = (
        [(Lanes,)]
        if arity == 1
        else [(Lanes, kind) for kind in kinds] + [(kind, Lanes) for kind in kinds[1:]]
    )
    for shape in shapes:
        lower_builtin(function, *shape)(lower)


def same(operands: Lanes) -> Lanes:
    """The result is of the operands' type."""
    return operands


def condition(operands: Lanes) -> Lanes:
    """The result is a condition."""
    return operands.of(types.boolean)


def _arithmetic(of_floats: str, of_integers: str) -> Callable[..., Any]:
    def emit(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
        if isinstance(kind.dtype, types.Float):
            return getattr(builder, of_floats)(a, b, flags=kind.flags)
        return getattr(builder, of_integers)(a, b)

    return emit


def _divide(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
    return builder.fdiv(a, b, flags=kind.flags)


def _negate(context: Any, builder: Any, kind: Lanes, a: Any) -> Any:
    return builder.fneg(a, flags=kind.flags)


def _compare(relation: str) -> Callable[..., Any]:
    def emit(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
        if isinstance(kind.dtype, types.Float):
            if relation == "!=":
                return builder.fcmp_unordered(relation, a, b)
            return builder.fcmp_ordered(relation, a, b)
        return builder.icmp_signed(relation, a, b)

    return emit


def _larger(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
    return builder.select(_compare(">")(context, builder, kind, b, a), b, a)


def _smaller(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
    return builder.select(_compare("<")(context, builder, kind, b, a), b, a)


def _bitwise(name: str) -> Callable[..., Any]:
    def emit(context: Any, builder: Any, kind: Lanes, a: Any, b: Any) -> Any:
        return getattr(builder, name)(a, b)

    return emit


def _intrinsic(name: str) -> Callable[..., Any]:
    """One LLVM intrinsic that is an instruction of vectors."""

    def emit(context: Any, builder: Any, kind: Lanes, a: Any) -> Any:
        letter = "f64" if kind.dtype == types.float64 else "f32"
        full_name = f"llvm.{name}.v{kind.width}{letter}"
        signature_type = ir.FunctionType(kind.vector, [kind.vector])
        return builder.call(cgutils.get_or_insert_function(builder.module, signature_type, full_name), [a])

    return emit


def _lane_by_lane(function: Callable[..., float]) -> Callable[..., Any]:
    """The library function that a single body uses, for each lane in double precision: the same bits."""

    def emit(context: Any, builder: Any, kind: Lanes, *operands: Any) -> Any:
        sig = signature(types.float64, *[types.float64] * len(operands))
        call = context.get_function(function, sig)
        result = ir.Constant(kind.vector, ir.Undefined)
        for lane in range(kind.width):
            numbers = [
                context.cast(builder, extract(builder, operand, lane), kind.dtype, types.float64)
                for operand in operands
            ]
            number = context.cast(builder, call(builder, numbers), types.float64, kind.dtype)
            result = builder.insert_element(result, number, ir.Constant(ir.IntType(32), lane))
        return result

    return emit


for _operators, _of_floats, _of_integers in (
    ((operator.add, operator.iadd), "fadd", "add"),
    ((operator.sub, operator.isub), "fsub", "sub"),
    ((operator.mul, operator.imul), "fmul", "mul"),
):
    for _operator in _operators:
        teach(_operator, 2, same, _arithmetic(_of_floats, _of_integers), NUMBERS)
for _operator in (operator.truediv, operator.itruediv):
    teach(_operator, 2, same, _divide)
teach(operator.neg, 1, same, _negate)
for _operator, _relation in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
    (operator.ne, "!="),
):
    teach(_operator, 2, condition, _compare(_relation), NUMBERS)
for _operator, _name in ((operator.and_, "and_"), (operator.or_, "or_"), (operator.xor, "xor")):
    teach(_operator, 2, same, _bitwise(_name), CONDITIONS)
teach(max, 2, same, _larger, NUMBERS)
teach(min, 2, same, _smaller, NUMBERS)
teach(abs, 1, same, _intrinsic("fabs"))
teach(math.sqrt, 1, same, _intrinsic("sqrt"))
for _function in (math.exp, math.log, math.sin, math.cos, math.tan):
    teach(_function, 1, same, _lane_by_lane(_function))
teach(math.atan2, 2, same, _lane_by_lane(math.atan2))
