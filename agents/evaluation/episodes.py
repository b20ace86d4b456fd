"""Flying one episode and keeping what is worth plotting, tabulating or testing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.metrics import SUCCESS, Array, Metric, metrics_of, reward_term_names
from dq_marine.agents.evaluation.trajectory import Track


class FlightEndedError(Exception):
    """An agent ends its flight here: a person who takes part in it wants another, or none."""


@dataclass(frozen=True)
class Episode:
    """One flown episode of n control periods, on n + 1 instants.

    Attributes:
        time: since the start [s], shape (n + 1,).
        metrics: what it is measured by.
        measured: the metrics by name, in the units of `info`, shape (n + 1,) each.
        actions: normalised, as held from each instant but the last, shape (n, axes).
        action_names: of the axes.
        rewards: of each period, shape (n,).
        reward_terms: by name, of each period, shape (n,) each; none if the environment names none.
        success: whether the task counts as done at the end.
        ended_early: whether the episode was terminated, say beyond the workspace.
        collided: whether the vehicle has hit something; None of a task with nothing to hit.
        seed: that it was reset with.
        track: where the vehicle was, if that was asked for.
        notes: what a reader of the numbers should know.
        pushed: of each period, whether a person pulled the vehicle by hand in it, shape (n,); None if in none.
    """

    time: Array
    metrics: tuple[Metric, ...]
    measured: dict[str, Array]
    actions: Array
    action_names: tuple[str, ...]
    rewards: Array
    reward_terms: dict[str, Array]
    success: bool
    ended_early: bool
    collided: bool | None = None
    seed: int = 0
    track: Track | None = None
    notes: tuple[str, ...] = ()
    pushed: NDArray[np.bool_] | None = None

    @property
    def total_reward(self) -> float:
        """The return, undiscounted."""
        return math.fsum(self.rewards.tolist())

    @property
    def effort(self) -> float:
        """The mean square of the actions, over axes and periods, 0 to 1."""
        return float(np.mean(np.square(self.actions))) if self.actions.size else 0.0

    @property
    def action_change(self) -> float:
        """How rough the actions are: root mean square of their change from period to period, over axes, 0 to 2."""
        changes = np.diff(self.actions, axis=0)
        return float(np.sqrt(np.mean(np.square(changes)))) if changes.size else 0.0

    @property
    def last_third(self) -> slice:
        """The instants from which steady errors are taken."""
        return slice(2 * len(self.time) // 3, None)

    @property
    def tolerances(self) -> dict[Metric, float]:
        """The metrics that say whether an episode has settled, and within what."""
        return {metric: metric.tolerance for metric in self.metrics if metric.tolerance is not None}

    @property
    def settling_time(self) -> float | None:
        """Time from which on all metrics stay within their tolerances [s]; None if they do not."""
        outside = np.zeros(len(self.time), np.bool_)
        for metric, tolerance in self.tolerances.items():
            outside |= np.abs(self.measured[metric.name]) > tolerance
        if outside[-1]:
            return None
        return float(self.time[np.flatnonzero(outside)[-1] + 1]) if outside.any() else 0.0

    def figures(self) -> dict[str, float]:
        """Return what is compared between agents, by name, the unit at its end.

        The return; each metric as its mean over the last third; effort and change of the actions; and of a task with
        something to hit, 1 for an episode in which it was hit, else 0.
        """
        steady = {
            metric.shown_name: float(metric.shown(self.measured[metric.name])[self.last_third].mean())
            for metric in self.metrics
        }
        hit = {} if self.collided is None else {"collided": float(self.collided)}
        own = {"effort": self.effort, "action_change": self.action_change}
        return {"return": self.total_reward, **steady, **own, **hit}

    def columns(self) -> dict[str, Array]:
        """Return everything by name, the unit at its end, each of shape (n + 1,).

        Actions, pushes and rewards are those of the period that begins at the instant; at the last one they are NaN.
        """

        def of_periods(values: Array) -> Array:
            return np.append(values, np.nan)

        columns = {"time_s": self.time} | ({} if self.track is None else self.track.columns())
        for index, name in enumerate(self.action_names):
            columns[f"action_{name.replace(' ', '_')}"] = of_periods(self.actions[:, index])
        if self.pushed is not None:
            columns["pushed"] = of_periods(self.pushed.astype(np.float64))
        columns["reward"] = of_periods(self.rewards)
        columns |= {name: of_periods(values) for name, values in self.reward_terms.items()}
        return columns | {
            metric.shown_name: metric.shown(self.measured[metric.name]) for metric in self.metrics
        }


def fly_episode(
    env: gym.Env[Any, Any],
    agent: Agent,
    *,
    seed: int,
    options: dict[str, Any] | None = None,
    interruptible: bool = False,
    track: bool = False,
) -> Episode:
    """Fly one episode to its end.

    Args:
        env: of this package, made with a time limit.
        agent: what flies it; it may end the flight by `FlightEndedError`.
        seed: of the episode.
        options: of the environment's reset.
        interruptible: whether Ctrl-C ends the flight and keeps what was flown; else it passes.
        track: keep where the vehicle was.

    Raises:
        InvalidInputError: an option is wrong, or the environment is not one of this package.
    """
    inner = marine(env)
    observation, info = env.reset(seed=seed, options=options)
    agent.reset(env)
    infos, actions, rewards = [info], [], []
    followed = Track() if track else None
    if followed is not None:
        followed.add(inner)
    validity = inner.flown_vehicle.validity
    through_water = []
    terminated = truncated = False
    while not (terminated or truncated):
        try:
            action = agent.act(observation)
            observation, reward, terminated, truncated, info = env.step(action)
        except FlightEndedError:
            break
        except KeyboardInterrupt:
            if not interruptible:
                raise
            break
        infos.append(info)
        actions.append(action)
        rewards.append(float(reward))
        if followed is not None:
            followed.add(inner)
        if validity is not None:
            through_water.append(inner.velocity_through_water)
    metrics = metrics_of(inner.definition)
    held = np.array(actions, dtype=np.float64).reshape(len(actions), *(env.action_space.shape or ()))
    return Episode(
        time=inner.control_period * np.arange(len(infos), dtype=np.float64),
        metrics=metrics,
        measured={metric.name: _series(infos, metric.name) for metric in metrics},
        actions=np.clip(held, -1.0, 1.0),
        action_names=tuple(inner.action_names),
        rewards=np.array(rewards, dtype=np.float64),
        reward_terms={name: _series(infos[1:], name) for name in reward_term_names(info)},
        success=bool(info.get(SUCCESS, False)),
        ended_early=terminated,
        collided=inner.collided,
        seed=seed,
        track=followed,
        notes=validity.notes(np.array(through_water)) if validity is not None and through_water else (),
    )


def with_pushes(episode: Episode, pushed: Sequence[bool]) -> Episode:
    """Return an episode that says in which control periods a person pulled the vehicle by hand; itself if in none.

    Args:
        episode: of n periods.
        pushed: whether it was, of each period; what goes beyond n is of a period that did not end.
    """
    of_periods = np.array(pushed[: len(episode.actions)], np.bool_)
    if not of_periods.any():
        return episode
    note = f"The vehicle was pulled by hand in {of_periods.sum()} of {of_periods.size} control periods."
    return replace(episode, notes=(*episode.notes, note), pushed=of_periods)


def _series(infos: list[dict[str, Any]], name: str) -> Array:
    return np.array([info[name] for info in infos], dtype=np.float64)
