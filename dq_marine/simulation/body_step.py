"""The step of one body, compiled: pushed by wrenches alone, or driven by its actuators, too."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from numba import types

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, store, structure_type
from dq_marine.integrator.step import ACCEPTED, Composition, make_advance
from dq_marine.physics.actuators.formulas.stepping import make_actuated_advance


@functools.cache
def compiled_advance(composition: Composition, layout: types.Type) -> Callable[..., Any]:
    """Compile (parameters, state, wrench, time, steps) -> (status, completed, iterations, fallbacks, residual_squared).

    All arrays float64: `parameters` packed from the `StepParameters` of `layout`, `state` (14 + m,) changed in
    place and only if the status is ACCEPTED, `wrench` (6,) in Fossen's order.
    """
    advance = make_advance(composition)
    load_parameters = make_load(layout)
    load_state = make_load(structure_type(composition.at_rest))

    def advance_arrays(parameters: Any, state: Any, wrench: Any, time: float, steps: int) -> Any:
        force = from_fossen((wrench[0], wrench[1], wrench[2], wrench[3], wrench[4], wrench[5]))
        outcome = advance(load_parameters(parameters), load_state(state), force, time, steps)
        if outcome.status == ACCEPTED:
            store(state, outcome.state)
        return (
            outcome.status,
            outcome.completed,
            outcome.iterations,
            outcome.fallbacks,
            outcome.residual_squared,
        )

    return compile_function(advance_arrays, str(layout), apart=(composition.fallback,))


@functools.cache
def compiled_actuated_advance(composition: Composition, layout: types.Type) -> Callable[..., Any]:
    """Compile (values, commands, parameters, state, wrench, time, steps), otherwise as `compiled_advance` does.

    `values` and `commands` of the channels are float64 arrays; `values` is changed in place as `state` is.
    """
    advance = make_actuated_advance(composition)
    load_parameters, load_state = make_load(layout), make_load(structure_type(composition.at_rest))
    load_channels = make_load(structure_type(composition.actuation.rest))

    def actuated_arrays(
        values: Any, commands: Any, parameters: Any, state: Any, wrench: Any, time: float, steps: int
    ) -> Any:
        force = from_fossen((wrench[0], wrench[1], wrench[2], wrench[3], wrench[4], wrench[5]))
        outcome = advance(
            load_parameters(parameters),
            load_state(state),
            load_channels(values),
            load_channels(commands),
            force,
            time,
            steps,
        )
        step = outcome.step
        if step.status == ACCEPTED:
            store(state, step.state)
            store(values, outcome.values)
        return (step.status, step.completed, step.iterations, step.fallbacks, step.residual_squared)

    return compile_function(actuated_arrays, str(layout), apart=(composition.fallback,))
