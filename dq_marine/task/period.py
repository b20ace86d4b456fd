"""One control period of an episode: act, advance, sense, remember, then observe and judge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.step import (
    ACCEPTED,
    Composition,
    StepOutcome,
    StepParameters,
    in_water,
    make_motion,
)
from dq_marine.task.action import action_size, make_actuators_push, make_push, make_sum_of_squares
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, Report, Verdict


class PeriodUniforms(NamedTuple):
    """Uniform random numbers in [0, 1) for one control period: for the water, and for the sensors."""

    water: tuple[float, ...]
    sensing: tuple[float, ...]


class PeriodOutcome(NamedTuple):
    """The end of one control period.

    After a refused step all is as before the period, but for the verdict: no reward, and the end.
    """

    step: StepOutcome
    water: Any
    current_ned: Vector3
    memory: Any
    observation: Any
    verdict: Verdict


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
    push = make_actuators_push(composition) if composition.actuation.channels else make_push(composition)
    motion_of, sum_of_squares = make_motion(composition), make_sum_of_squares(action_size(composition))
    sense, update, observe, judge = task.sensing.later, task.update_memory, task.observe, task.judge
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
        step, pushed = push(in_water(parameters, moving), episode, state, memory, action, time, steps)
        taken = step.status == ACCEPTED
        water = choose_water(taken, moving, parameters.water)
        motion = motion_of(in_water(parameters, water), step.state)
        sensed = sense(episode, pushed, motion, uniforms.sensing)
        memory_after = select(taken, update(episode, sensed, motion, motion), memory)
        verdict = judge(episode, memory_after, motion, sum_of_squares(action))
        report = verdict.report
        rewards = select(taken, report.rewards, spread(no_rewards, verdict.reward))
        return PeriodOutcome(
            step,
            water,
            velocity(water, step.state.pose),
            memory_after,
            observe(episode, memory_after, motion),
            Verdict(
                select(taken, verdict.reward, 0.0),
                select(taken, verdict.terminated, 1.0),
                Report(report.metrics, rewards, report.success),
            ),
        )

    return control_period
