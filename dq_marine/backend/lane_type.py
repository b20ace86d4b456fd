"""A Numba type of many numbers side by side: pure functions, handed lanes for numbers, run in SIMD.

`Lanes` is an LLVM vector, so their straight-line arithmetic becomes vector instructions whatever the size of a
function; nothing depends on a loop vectoriser's mood. Scalars mix with lanes and are spread.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typeconv import Conversion
from numba.extending import lower_cast, models, register_model

FAST_FLAGS = ("contract", "reassoc", "nsz", "arcp")
"""What fast arithmetic allows LLVM: fused multiply-adds and reordered sums; NaN and infinity keep their meaning."""


class Lanes(types.Type):
    """`width` numbers of one kind.

    Attributes:
        dtype: of one number: a float type, `types.int64` or `types.boolean`.
        width: number of lanes.
        precision: the float type of the lanes that this one is computed with.
        fast: whether sums may be reordered and multiply-adds fused.
        stages: how many stages of a step the lanes hold of each body, see `backend.stages`.
    """

    def __init__(
        self, dtype: types.Type, width: int, precision: types.Type, fast: bool, stages: int = 1
    ) -> None:
        self.dtype = dtype
        self.width = width
        self.precision = precision
        self.fast = fast
        self.stages = stages
        arithmetic = "fast" if fast else "strict"
        staged = "" if stages == 1 else f", {stages} stages"
        super().__init__(name=f"Lanes({dtype}, {width}, {precision}, {arithmetic}{staged})")

    def of(self, dtype: types.Type) -> Lanes:
        """Return the like lanes of another kind."""
        return Lanes(dtype, self.width, self.precision, self.fast, self.stages)

    def at_stages(self, count: int) -> Lanes:
        """Return the lanes that hold several stages of what these hold."""
        return Lanes(self.dtype, self.width * count, self.precision, self.fast, count)

    def of_one_stage(self) -> Lanes:
        """Return the lanes that hold one stage of what these hold."""
        return Lanes(self.dtype, self.bodies, self.precision, self.fast)

    def like(self, scalar: types.Type) -> Lanes:
        """Return the lanes that hold a scalar of the given type."""
        if isinstance(scalar, types.Boolean):
            return self.of(types.boolean)
        return self.of(types.int64 if isinstance(scalar, types.Integer) else self.precision)

    def holds(self, scalar: types.Type) -> bool:
        """Whether a scalar of the given type can be put into the lanes without changing its meaning."""
        if isinstance(self.dtype, types.Float):
            return True
        kind = types.Integer if isinstance(self.dtype, types.Integer) else types.Boolean
        return isinstance(scalar, kind)

    @property
    def vector(self) -> ir.VectorType:
        """The LLVM type."""
        return ir.VectorType(_ELEMENTS[self.dtype], self.width)

    @property
    def bodies(self) -> int:
        """How many bodies the lanes hold."""
        return self.width // self.stages

    @property
    def piled(self) -> bool:
        """Whether the stages lie one upon the other, a vector of bodies each, and not side by side in one vector."""
        return self.stages > 1 and self.bodies > 1

    @property
    def value_type(self) -> ir.Type:
        """The LLVM type of a value."""
        return ir.ArrayType(self.of_one_stage().vector, self.stages) if self.piled else self.vector

    @property
    def flags(self) -> tuple[str, ...]:
        """Of floating-point instructions."""
        return FAST_FLAGS if self.fast else ()

    def can_convert_from(self, typingctx: Any, other: types.Type) -> Any:
        """A scalar becomes lanes by spreading."""
        return Conversion.safe if is_scalar(other) else None

    def unify(self, typingctx: Any, other: types.Type) -> Any:
        """Lanes and a scalar meet as lanes."""
        return self if is_scalar(other) else None


_ELEMENTS = {
    types.float64: ir.DoubleType(),
    types.float32: ir.FloatType(),
    types.int64: ir.IntType(64),
    types.boolean: ir.IntType(1),
}


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    """An LLVM vector, or an array of them where bodies in lanes have several stages."""

    def __init__(self, dmm: Any, fe_type: Lanes) -> None:
        super().__init__(dmm, fe_type, fe_type.value_type)


def is_scalar(kind: types.Type) -> bool:
    """Whether a type is that of one number or bool."""
    return isinstance(kind, types.Number | types.Boolean)


def spread(builder: Any, value: Any, width: int) -> Any:
    """Return an LLVM vector with the value in every lane."""
    vector = ir.VectorType(value.type, width)
    first = builder.insert_element(ir.Constant(vector, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(first, ir.Constant(vector, ir.Undefined), zeros)


def as_lanes(context: Any, builder: Any, value: Any, kind: types.Type, result: Lanes) -> Any:
    """Return a scalar or lanes value as lanes of the result's type."""
    if isinstance(kind, Lanes):
        if kind.dtype != result.dtype:
            raise NotImplementedError(f"{kind} used as {result}")
        return value
    number = context.cast(builder, value, kind, result.dtype)
    if result.dtype == types.boolean:
        number = builder.trunc(number, ir.IntType(1)) if number.type != ir.IntType(1) else number
    return spread(builder, number, result.width)


@lower_cast(types.Number, Lanes)
@lower_cast(types.Boolean, Lanes)
def _spread_scalar(context: Any, builder: Any, from_type: Any, to_type: Any, value: Any) -> Any:
    return as_lanes(context, builder, value, from_type, to_type)


def extract(builder: Any, value: Any, lane: Any) -> Any:
    """Return one lane; `lane` is an int or an LLVM value."""
    index = ir.Constant(ir.IntType(32), lane) if isinstance(lane, int) else lane
    return builder.extract_element(value, index)


def all_bits(builder: Any, mask: Any) -> Any:
    """Return an LLVM bool: whether every lane of a mask is set."""
    width = mask.type.count
    bits = builder.bitcast(mask, ir.IntType(width))
    return builder.icmp_unsigned("==", bits, ir.Constant(bits.type, (1 << width) - 1))


def any_bit(builder: Any, mask: Any) -> Any:
    """Return an LLVM bool: whether some lane of a mask is set."""
    bits = builder.bitcast(mask, ir.IntType(mask.type.count))
    return cgutils.is_not_null(builder, bits)


def as_floats(builder: Any, value: Any, kind: Lanes) -> Any:
    """Return lanes of any kind as lanes of their float type."""
    floats = kind.of(kind.precision).vector
    if isinstance(kind.dtype, types.Boolean):
        return builder.uitofp(value, floats)
    return builder.sitofp(value, floats) if isinstance(kind.dtype, types.Integer) else value
