"""One control period of an episode: act, advance, sense, remember, then observe, and say what came of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import BodyState, Motion
from dq_marine.integrator.step import (
    ACCEPTED,
    Composition,
    StepOutcome,
    StepParameters,
    in_water,
    make_motion,
)
from dq_marine.task.action import action_size, make_actuator_action, make_sum_of_squares, make_wrench_action
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, Report, TaskOutcome, make_shown


class PeriodUniforms(NamedTuple):
    """Uniform random numbers in [0, 1) for one control period: for the water, and for the sensors."""

    water: tuple[float, ...]
    sensing: tuple[float, ...]


class PeriodOutcome(NamedTuple):
    """The end of one control period.

    After a refused step all is as before the period, but for the task: no reward, and the end.
    """

    step: StepOutcome
    water: Any
    current_ned: Vector3
    motion: Motion
    memory: Any
    observation: Any
    task: TaskOutcome


def no_choice(condition: bool, chosen: Any, otherwise: Any) -> Any:
    """Return `chosen`, from which `otherwise` does not differ."""
    return chosen


def draws_of_period(composition: Composition, task: EpisodeTask) -> PeriodUniforms:
    """Return zeros for the uniform random numbers that a control period takes."""
    return PeriodUniforms((0.0,) * composition.water.draws, (0.0,) * task.sensing.later_draws)


def make_control_period(
    composition: Composition, task: EpisodeTask
) -> Callable[
    [StepParameters, EpisodeParameters, BodyState, Any, Any, float, int, PeriodUniforms], PeriodOutcome
]:
    """Return (step's parameters, episode's parameters, state, memory, action, time, steps, uniforms) -> outcome.

    Where the composition has actuators, the task must be made by `with_actuators`.
    """
    act = task.delay_act(
        make_actuator_action(composition)
        if composition.actuation.channels
        else make_wrench_action(composition)
    )
    motion_of, sum_of_squares = make_motion(composition), make_sum_of_squares(action_size(composition))
    sense, update = task.sensing.later, task.update_memory
    show, outcome = make_shown(task), task.outcome
    evolve, velocity = composition.water.evolve, composition.water.velocity
    choose_water = select if composition.water.draws else no_choice
    no_rewards = task.no_rewards

    def control_period(
        parameters: StepParameters,
        episode: EpisodeParameters,
        state: BodyState,
        memory: Any,
        action: Any,
        time: float,
        steps: int,
        uniforms: PeriodUniforms,
    ) -> PeriodOutcome:
        moving = evolve(parameters.water, time, uniforms.water)
        step, acted = act(in_water(parameters, moving), episode, state, memory, action, time, steps)
        taken = step.status == ACCEPTED
        water = choose_water(taken, moving, parameters.water)
        motion = motion_of(in_water(parameters, water), step.state)
        sensed = sense(episode, acted, motion, uniforms.sensing)
        memory_after = select(taken, update(episode.task, sensed, motion, motion), memory)
        result = outcome(episode, memory_after, motion, sum_of_squares(action))
        report, nothing = result.report, spread((no_rewards, 0.0, 1.0), result.reward)
        told = select(taken, (report.rewards, result.reward, result.terminated), nothing)
        current_ned = velocity(water, step.state.pose)
        return PeriodOutcome(
            step,
            water,
            current_ned,
            motion,
            memory_after,
            show(episode, memory_after, motion, current_ned),
            TaskOutcome(told[1], told[2], Report(report.metrics, told[0], report.success)),
        )

    return control_period
