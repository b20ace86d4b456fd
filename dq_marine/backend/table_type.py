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

from dq_marine.algebra.table import Table
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
