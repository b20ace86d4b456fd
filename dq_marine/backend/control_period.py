"""One control period of one body's task, compiled: action in, observation and result out."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

from numba import types

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, store, structure_type
from dq_marine.integrator.step import Composition, StepParameters, in_water
from dq_marine.task.action import action_size, make_saturated
from dq_marine.task.episode import EpisodeTask
from dq_marine.task.period import draws_of_period, make_control_period

ACTION_NOT_FINITE = -1


def keep_nothing(numbers: Any, parameters: StepParameters, water: Any) -> None:
    """Leave the parameters: their water does not change by itself."""


def keep_water(numbers: Any, parameters: StepParameters, water: Any) -> None:
    """Store the parameters with the water of a control period's end."""
    store(numbers, in_water(parameters, water))


@functools.cache
def compiled_control_period(
    composition: Composition,
    task: EpisodeTask,
    step_layout: types.Type,
    episode_layout: types.Type,
    memory_layout: types.Type,
) -> Callable[..., Any]:
    """Compile one control period on arrays.

    The compiled function takes (parameters, episode, state, memory, action, observation, report, time, steps,
    uniforms), all arrays float64 but the observation, float32; `uniforms` are `task.period.PeriodUniforms`, packed. It
    saturates the action at -1 and 1, in place, or returns the status ACTION_NOT_FINITE for a NaN or an infinity, and
    nothing is changed. It changes state, memory, observation, report and, where the water changes by itself, the
    parameters as `task.period.PeriodOutcome` says; the report is followed by the current in NED. It returns (status,
    completed, fallbacks, residual_squared, reward, terminated).
    """
    control_period = make_control_period(composition, task)
    load_parameters = make_load(step_layout)
    load_episode = make_load(episode_layout)
    load_memory = make_load(memory_layout)
    load_state = make_load(structure_type(composition.at_rest))
    load_uniforms = make_load(structure_type(draws_of_period(composition, task)))
    keep = keep_water if composition.water.draws else keep_nothing
    size = action_size(composition)
    load_action, saturated = make_load(types.UniTuple(types.float64, size)), make_saturated(size)

    def control_period_arrays(
        parameters: Any,
        episode: Any,
        state: Any,
        memory: Any,
        action: Any,
        observation: Any,
        report: Any,
        time: float,
        steps: int,
        uniforms: Any,
    ) -> Any:
        for axis in range(size):
            if not math.isfinite(action[axis]):
                return ACTION_NOT_FINITE, 0, 0, 0.0, 0.0, 0.0
        held = saturated(load_action(action))
        numbers = load_parameters(parameters)
        outcome = control_period(
            numbers,
            load_episode(episode),
            load_state(state),
            load_memory(memory),
            held,
            time,
            steps,
            load_uniforms(uniforms),
        )
        step, result = outcome.step, outcome.task
        keep(parameters, numbers, outcome.water)
        store(action, held)
        store(state, step.state)
        store(memory, outcome.memory)
        store(observation, outcome.observation)
        store(report, (result.report, outcome.current_ned))
        return (
            step.status,
            step.completed,
            step.fallbacks,
            step.residual_squared,
            result.reward,
            result.terminated,
        )

    layout = f"{step_layout}|{episode_layout}|{memory_layout}"
    return compile_function(control_period_arrays, layout, apart=(composition.fallback,))
