"""The step of a scene, compiled for blocks of bodies in SIMD lanes."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from numba import types

import dq_marine.backend.lane_arithmetic  # noqa: F401  teaches Numba to compute with lanes
from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.simd.packing import Packing, make_load_block, make_store_block, packing_of
from dq_marine.backend.simd.rows import make_load_rows
from dq_marine.backend.table_type import check_tables
from dq_marine.checks import one_of
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.step import Composition, StepParameters, make_advance

PRECISIONS = {"float64": types.float64, "float32": types.float32}
"""Of the numbers in lanes, by name."""

ARITHMETICS = ("strict", "fast")
"""strict: IEEE, the bits of a single body. fast: fused multiply-adds, reordered sums; differs by round-off."""

BYTES_OF_A_VECTOR = 64
"""A block's width fills this: one AVX-512 register, two of AVX2, four of SSE2 or NEON."""


def lanes_of(precision: str, arithmetic: str) -> Lanes:
    """Return the lanes type for a precision and an arithmetic, by name.

    Raises:
        InvalidInputError: a name is unknown.
    """
    one_of("precision", precision, PRECISIONS)
    one_of("arithmetic", arithmetic, ARITHMETICS)
    number = PRECISIONS[precision]
    return Lanes(number, BYTES_OF_A_VECTOR * 8 // number.bitwidth, number, arithmetic == "fast")


@dataclass(frozen=True)
class LaneLayout:
    """How a scene's bodies lie in memory.

    Attributes:
        lanes: the type of a number that each body has for itself.
        parameters: packing of the step's parameters.
        state: packing of pose, momentum and fluid memory.
        outcome: packing of (status, fallbacks, residual squared).
    """

    lanes: Lanes
    parameters: Packing
    state: Packing
    outcome: Packing


def lane_layout(
    parameters: StepParameters, at_rest: BodyState, differing: frozenset[str], lanes: Lanes
) -> LaneLayout:
    """Return the layout of bodies whose parameters differ in the given fields, and whose state is like `at_rest`."""

    def is_shared(path: tuple[str | int, ...]) -> bool:
        return len(path) == 1 and path[0] not in differing

    def is_own(path: tuple[str | int, ...]) -> bool:
        return False

    return LaneLayout(
        lanes,
        packing_of(parameters, lanes, is_shared),
        packing_of(at_rest, lanes, is_own),
        packing_of((0.0, 0.0, 0.0), lanes, is_own),
    )


def differing_fields(structures: Sequence[Any]) -> frozenset[str]:
    """Return the fields in which named tuples of one type, of (nested tuples of) numbers, differ.

    Raises:
        InvalidInputError: their tables do.
    """
    check_tables(structures)
    first = structures[0]
    others = [other for other in structures[1:] if other != first]
    return frozenset(
        name
        for name, part in zip(first._fields, first, strict=True)
        if any(getattr(other, name) != part for other in others)
    )


@functools.cache
def compiled_lane_advance(composition: Composition, layout: LaneLayout) -> Callable[..., Any]:
    """Compile (first, last, shared, own, states, outcomes, wrenches, time, steps) over the blocks first <= k < last.

    `shared` and `own` hold the parameters, `states` the bodies and is changed in place where a body's status is
    ACCEPTED, `outcomes` takes (status, fallbacks, residual squared), `wrenches` has a row [X, Y, Z, K, M, N] for every
    body. A body whose step is refused stays where it was; the others do not notice.
    """
    advance = make_advance(composition)
    load_parameters, load_state = make_load_block(layout.parameters), make_load_block(layout.state)
    store_state, store_outcome = make_store_block(layout.state), make_store_block(layout.outcome)
    load_wrench = make_load_rows(layout.lanes, 6)

    def advance_blocks(
        first: int,
        last: int,
        shared: Any,
        own: Any,
        states: Any,
        outcomes: Any,
        wrenches: Any,
        time: float,
        steps: int,
    ) -> None:
        for block in range(first, last):
            outcome = advance(
                load_parameters(shared, own, block),
                load_state(shared, states, block),
                from_fossen(load_wrench(wrenches, block)),
                time,
                steps,
            )
            store_state(states, block, outcome.state)
            store_outcome(outcomes, block, (outcome.status, outcome.fallbacks, outcome.residual_squared))

    key = "|".join(map(str, (layout.lanes, layout.parameters.key)))
    return compile_function(advance_blocks, key, apart=(composition.fallback,))
