"""Nested tuples of lanes in blocks of memory, and back.

A block holds, field after field, `width` bodies side by side: `blocks[block, field, lane]`. What all bodies share
stands once, in a flat array, and is spread when it meets lanes. `Packing` says which number stands where.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.extending import intrinsic
from numpy.typing import NDArray

from dq_marine.algebra.table import Table
from dq_marine.backend.lane_type import Lanes, as_floats
from dq_marine.backend.table_type import TableType


@dataclass(frozen=True)
class Slot:
    """Where one number stands: its index in the shared array, or its field in every block."""

    index: int
    shared: bool


@dataclass(frozen=True)
class Packing:
    """Where the numbers of a structure stand.

    Attributes:
        kind: Numba's type of the structure, its numbers lanes, or float64 where shared.
        slots: of its numbers, depth first.
        shared: how many numbers are shared.
        fields: how many fields a block has.
        width: how many bodies.
    """

    kind: types.Type
    slots: tuple[Slot, ...]
    shared: int
    fields: int
    width: int

    @property
    def key(self) -> str:
        """Text that tells packings apart."""
        places = [("shared" if slot.shared else "field") + str(slot.index) for slot in self.slots]
        return f"{self.kind}:{','.join(places)}"


def packing_of(structure: Any, lanes: Lanes, is_shared: Callable[[tuple[str | int, ...]], bool]) -> Packing:
    """Return the packing of a structure.

    Args:
        structure: nested tuples of numbers.
        lanes: the type of a number that each body has for itself.
        is_shared: whether the tuple or number reached by a path of field names (or indices) is one for all.
    """
    counts = {True: 0, False: 0}
    slots: list[Slot] = []

    def visit(part: Any, path: tuple[str | int, ...], shared: bool) -> types.Type:
        shared = shared or is_shared(path) or isinstance(part, Table)
        if not isinstance(part, tuple):
            slots.append(Slot(counts[shared], shared))
            counts[shared] += 1
            return types.float64 if shared else lanes
        names = getattr(part, "_fields", range(len(part)))
        kinds = tuple(visit(inner, (*path, name), shared) for name, inner in zip(names, part, strict=True))
        if isinstance(part, Table):
            return TableType(len(part))
        return types.BaseTuple.from_types(kinds, type(part) if hasattr(part, "_fields") else None)

    kind = visit(structure, (), False)
    return Packing(kind, tuple(slots), counts[True], counts[False], lanes.width)


def pack_shared(packing: Packing, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the shared array from one body's numbers, depth first."""
    shared = np.empty(packing.shared)
    for slot, number in zip(packing.slots, numbers, strict=True):
        if slot.shared:
            shared[slot.index] = number
    return shared


def pack_blocks(
    packing: Packing, rows: Sequence[NDArray[np.float64]] | NDArray[np.float64], blocks: NDArray[Any]
) -> None:
    """Write bodies' numbers, a row each, depth first, into blocks; lanes beyond the last body repeat it.

    Args:
        packing: of the structure.
        rows: shape (n, numbers).
        blocks: shape (blocks, fields, width) with blocks * width >= n.
    """
    numbers = np.asarray(rows)
    count, _, width = blocks.shape
    body = np.minimum(np.arange(count * width), len(numbers) - 1)
    for position, slot in enumerate(packing.slots):
        if not slot.shared:
            blocks[:, slot.index, :] = numbers[body, position].reshape(count, width)


def unpack_blocks(
    packing: Packing, shared: NDArray[Any], blocks: NDArray[Any], n: int
) -> NDArray[np.float64]:
    """Return bodies' numbers, a row each: the inverse of `pack_shared` and `pack_blocks`, shape (n, numbers)."""
    rows = np.empty((n, len(packing.slots)))
    for position, slot in enumerate(packing.slots):
        if slot.shared:
            rows[:, position] = shared[slot.index]
        else:
            rows[:, position] = blocks[:, slot.index, :].reshape(-1)[:n]
    return rows


def empty_blocks(packing: Packing, n: int, lanes: Lanes) -> NDArray[Any]:
    """Return blocks of zeros for n bodies, aligned to a cache line's size."""
    dtype = np.float32 if lanes.precision == types.float32 else np.float64
    shape = (-(-n // lanes.width), packing.fields, lanes.width)
    return aligned_zeros(shape, dtype)


def aligned_zeros(shape: tuple[int, ...], dtype: Any) -> NDArray[Any]:
    """Return zeros whose first byte is at a multiple of 64: no vector straddles two cache lines."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    raw = np.zeros(size + 64, dtype=np.uint8)
    start = -raw.ctypes.data % 64
    return raw[start : start + size].view(dtype).reshape(shape)


def _pointer(
    context: Any, builder: Any, array_type: Any, array: Any, block: Any, packing: Packing, field: int
) -> Any:
    """Return a pointer to the first lane of a field of a block."""
    view = context.make_array(array_type)(context, builder, array)
    lanes = array_type.dtype
    width = packing.width
    size = ir.Constant(block.type, packing.fields * width)
    offset = builder.add(builder.mul(block, size), ir.Constant(block.type, field * width))
    pointer = cgutils.gep_inbounds(builder, view.data, offset)
    element = ir.DoubleType() if lanes == types.float64 else ir.FloatType()
    return builder.bitcast(pointer, ir.VectorType(element, width).as_pointer())


def make_load_block(packing: Packing) -> Callable[[Any, Any, Any], Any]:
    """Return (shared, blocks, block) -> the structure of a block's bodies, for compiled code."""

    @intrinsic
    def load_block(typing_context: Any, shared: Any, blocks: Any, block: Any) -> Any:
        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            slots: Iterator[Slot] = iter(packing.slots)
            common = context.make_array(sig.args[0])(context, builder, values[0]).data

            def build(part: types.Type) -> Any:
                if isinstance(part, types.BaseTuple):
                    return context.make_tuple(builder, part, [build(inner) for inner in part.types])
                slot = next(slots)
                if isinstance(part, TableType):
                    for _ in range(part.count - 1):
                        next(slots)
                    return cgutils.gep_inbounds(builder, common, slot.index)
                if slot.shared:
                    number = builder.load(cgutils.gep_inbounds(builder, common, slot.index))
                    # Compiled code writes no shared number, so that it need not read them again in every block.
                    number.set_metadata("invariant.load", builder.module.add_metadata([]))
                    return number
                pointer = _pointer(context, builder, sig.args[1], values[1], values[2], packing, slot.index)
                return builder.load(pointer, align=blocks.dtype.bitwidth // 8)

            return build(packing.kind)

        return signature(packing.kind, shared, blocks, types.intp), generate

    return load_block


def make_store_block(packing: Packing) -> Callable[[Any, Any, Any], Any]:
    """Return (blocks, block, structure) -> None, for compiled code; what is shared is not written."""

    @intrinsic
    def store_block(typing_context: Any, blocks: Any, block: Any, structure: Any) -> Any:
        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            slots: Iterator[Slot] = iter(packing.slots)

            def write(part: types.Type, value: Any) -> None:
                if isinstance(part, types.BaseTuple):
                    for index, inner in enumerate(part.types):
                        write(inner, builder.extract_value(value, index))
                    return
                slot = next(slots)
                if isinstance(part, TableType):
                    for _ in range(part.count - 1):
                        next(slots)
                elif not slot.shared:
                    pointer = _pointer(
                        context, builder, sig.args[0], values[0], values[1], packing, slot.index
                    )
                    builder.store(as_floats(builder, value, part), pointer, align=blocks.dtype.bitwidth // 8)

            write(structure, values[2])
            return context.get_dummy_value()

        return signature(types.none, blocks, types.intp, structure), generate

    return store_block
