"""The step of bodies that are driven by their actuators, compiled for blocks of bodies in SIMD lanes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.simd.lanes import LaneLayout
from dq_marine.backend.simd.packing import Packing, make_load_block, make_store_block
from dq_marine.backend.simd.rows import make_load_rows
from dq_marine.integrator.step import Composition
from dq_marine.physics.actuators.formulas.stepping import make_actuated_advance


@functools.cache
def compiled_actuated_lanes(
    composition: Composition, layout: LaneLayout, value_packing: Packing
) -> Callable[..., Any]:
    """Compile (first, last, shared, own, states, outcomes, values, commands, wrenches, time, steps).

    `values` of the channels are blocks, changed in place as `states` are; `commands` has a row for every body. All else
    is as in `compiled_lane_advance`.
    """
    advance, nest = make_actuated_advance(composition), composition.actuation.nest
    load_parameters, load_state = make_load_block(layout.parameters), make_load_block(layout.state)
    store_state, store_outcome = make_store_block(layout.state), make_store_block(layout.outcome)
    load_values, store_values = make_load_block(value_packing), make_store_block(value_packing)
    load_wrench = make_load_rows(layout.lanes, 6)
    load_commands = make_load_rows(layout.lanes, composition.actuation.channels)

    def actuated_blocks(
        first: int,
        last: int,
        shared: Any,
        own: Any,
        states: Any,
        outcomes: Any,
        values: Any,
        commands: Any,
        wrenches: Any,
        time: float,
        steps: int,
    ) -> None:
        for block in range(first, last):
            outcome = advance(
                load_parameters(shared, own, block),
                load_state(shared, states, block),
                load_values(shared, values, block),
                nest(load_commands(commands, block)),
                from_fossen(load_wrench(wrenches, block)),
                time,
                steps,
            )
            step = outcome.step
            store_state(states, block, step.state)
            store_values(values, block, outcome.values)
            store_outcome(outcomes, block, (step.status, step.fallbacks, step.residual_squared))

    key = "|".join(map(str, (layout.lanes, layout.parameters.key, value_packing.key)))
    return compile_function(actuated_blocks, key, apart=(composition.fallback,))
