"""`backend.pcg64` in compiled code: 128-bit arithmetic as the processor has it, in place of that by halves of words.

A product of two 64-bit words is one instruction; by halves it is a chain of ten products, each of which waits for the
carry of the one before.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typing import signature
from numba.extending import intrinsic

from dq_marine.backend import pcg64
from dq_marine.backend.selection import provide

WORD, WIDE = ir.IntType(64), ir.IntType(128)


@intrinsic
def step_generator(typing_context: Any, high: Any, low: Any, increment_high: Any, increment_low: Any) -> Any:
    """The next state of a generator, as its upper and its lower word."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        def joined(upper: Any, lower: Any) -> Any:
            shifted = builder.shl(builder.zext(upper, WIDE), ir.Constant(WIDE, 64))
            return builder.or_(shifted, builder.zext(lower, WIDE))

        product = builder.mul(joined(*values[:2]), ir.Constant(WIDE, pcg64.MULTIPLIER))
        state = builder.add(product, joined(*values[2:]))
        upper = builder.trunc(builder.lshr(state, ir.Constant(WIDE, 64)), WORD)
        return context.make_tuple(builder, sig.return_type, [upper, builder.trunc(state, WORD)])

    return signature(types.UniTuple(types.uint64, 2), *(types.uint64,) * 4), generate


@provide(pcg64.stepped)
def _stepped(high: Any, low: Any, increment_high: Any, increment_low: Any) -> Any:
    return lambda high, low, increment_high, increment_low: step_generator(
        high, low, increment_high, increment_low
    )
