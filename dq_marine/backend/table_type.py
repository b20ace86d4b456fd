"""A Numba type for `algebra.table.Table`: a pointer to numbers that lie one after the other, and how many they are."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.extending import intrinsic, models, overload, register_model

from dq_marine.algebra.table import Table, entry
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.selection import provide
from dq_marine.errors import InvalidInputError


class TableType(types.Type):
    """`count` doubles in memory."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(name=f"Table({count})")


@register_model(TableType)
class TableModel(models.PrimitiveModel):
    """A pointer to the first number."""

    def __init__(self, dmm: Any, fe_type: TableType) -> None:
        super().__init__(dmm, fe_type, ir.DoubleType().as_pointer())


@intrinsic
def number_at(typing_context: Any, table: Any, index: Any) -> Any:
    """The number that stands at an index, which is not checked."""

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        place = context.cast(builder, values[1], sig.args[1], types.intp)
        return builder.load(cgutils.gep_inbounds(builder, values[0], place))

    return signature(types.float64, table, index), generate


@overload(operator.getitem, strict=False)
def _getitem(table: Any, index: Any) -> Any:
    if isinstance(table, TableType) and isinstance(index, types.Integer):
        return lambda table, index: number_at(table, index)
    return None


@overload(len, strict=False)
def _len(table: Any) -> Any:
    if not isinstance(table, TableType):
        return None
    count = table.count
    return lambda table: count


@intrinsic
def numbers_at(typing_context: Any, table: Any, places: Any) -> Any:
    """The numbers that stand at the places of lanes, each read by itself."""
    result = places.of(places.precision)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        found = ir.Constant(result.vector, ir.Undefined)
        for lane in range(places.width):
            index = ir.Constant(ir.IntType(32), lane)
            place = builder.extract_element(values[1], index)
            whole = context.cast(builder, place, places.dtype, types.intp)
            number = builder.load(cgutils.gep_inbounds(builder, values[0], whole))
            number = context.cast(builder, number, types.float64, result.dtype)
            found = builder.insert_element(found, number, index)
        return found

    return signature(result, table, places), generate


@provide(entry)
def _entry(table: Any, place: Any) -> Any:
    if not isinstance(table, TableType):
        return None
    if isinstance(place, Lanes):
        return None if place.piled else lambda table, place: numbers_at(table, place)
    return lambda table, place: number_at(table, int(place))


def tables_in(structure: Any) -> list[Table]:
    """Return the tables among nested tuples."""
    if isinstance(structure, Table):
        return [structure]
    if isinstance(structure, tuple):
        return [table for part in structure for table in tables_in(part)]
    return []


def check_tables(structures: Sequence[Any]) -> None:
    """Refuse structures whose tables differ: in lanes they are one for all.

    Raises:
        InvalidInputError: they do.
    """
    first = tables_in(structures[0])
    if first and any(tables_in(other) != first for other in structures[1:]):
        raise InvalidInputError(
            "the bodies of a batch are in different seas or gusts, answer to them by different tables, or remember "
            "their own waves by different models; give all the same weather (a seed fixes it), and vehicles of one "
            "size and one table of radiation, or bodies in batches of their own"
        )
