"""`algebra.entries.add_products` in compiled code: the places are part of a type, and every product is written out.

One function replaces one for each product. The instructions are the same, and the step of a vehicle with eight
couplings compiles in a seventh less time.
"""

from __future__ import annotations

import operator
from typing import Any, NamedTuple

from numba import types
from numba.core.imputils import lower_constant
from numba.core.typing import signature
from numba.extending import intrinsic, models, register_model, typeof_impl

from dq_marine.algebra.entries import Places, add_products
from dq_marine.backend.packing import leaf_types, leaves
from dq_marine.backend.selection import provide
from dq_marine.backend.stage_layout import mapped, rebuilt


class PlacesType(types.Type):
    """Places, one type for each value."""

    def __init__(self, places: Places) -> None:
        self.places = places
        super().__init__(name=f"Places({tuple(places)})")


@register_model(PlacesType)
class PlacesModel(models.OpaqueModel):
    """Nothing: the type says it all."""


@typeof_impl.register(Places)
def _typeof(places: Places, context: Any) -> PlacesType:
    return PlacesType(places)


@lower_constant(PlacesType)
def _constant(context: Any, builder: Any, kind: Any, places: Any) -> Any:
    return context.get_dummy_value()


class _Number(NamedTuple):
    """A number's type and its LLVM value, None while only types are asked for."""

    kind: types.Type
    value: Any


class _Arithmetic(NamedTuple):
    """Numba's own arithmetic of two numbers, whatever their types are."""

    typing: Any
    target: Any = None
    builder: Any = None

    def __call__(self, operation: Any, a: _Number, b: _Number) -> _Number:
        chosen = self.typing.resolve_function_type(operation, (a.kind, b.kind), {})
        if self.builder is None:
            return _Number(chosen.return_type, None)
        values = [
            self.target.cast(self.builder, number.value, number.kind, kind)
            for number, kind in zip((a, b), chosen.args, strict=True)
        ]
        compute = self.target.get_function(operation, chosen)
        return _Number(chosen.return_type, compute(self.builder, values))


def with_products(arithmetic: _Arithmetic, places: Places, *structures: list[_Number]) -> list[_Number]:
    """Return the numbers of the target with all products added, as `add_products` has it."""
    target, first, second = structures
    numbers = list(target)
    for place, i, j in places:
        product = arithmetic(operator.mul, first[i], second[j])
        numbers[place] = arithmetic(operator.add, numbers[place], product)
    return numbers


@intrinsic
def products_added(typing_context: Any, places: Any, target: Any, first: Any, second: Any) -> Any:
    """(Nested tuples of) numbers with products added to some of them."""
    structures = (target, first, second)
    numbers = [
        [_Number(leaf, None) for leaf in map(types.unliteral, leaf_types(kind))] for kind in structures
    ]
    sums = with_products(_Arithmetic(typing_context), places.places, *numbers)
    kinds = iter(sums)
    result = mapped(target, lambda _: next(kinds).kind)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        found = [
            [_Number(*pair) for pair in zip(leaf_types(kind), leaves(builder, kind, value), strict=True)]
            for kind, value in zip(structures, values[1:], strict=True)
        ]
        arithmetic = _Arithmetic(typing_context, context, builder)
        sums = iter(with_products(arithmetic, places.places, *found))
        return rebuilt(context, builder, target, result, values[1], lambda *_: next(sums).value)

    return signature(result, places, *structures), generate


@provide(add_products)
def _add_products(places: Any, target: Any, first: Any, second: Any) -> Any:
    return lambda places, target, first, second: products_added(places, target, first, second)
