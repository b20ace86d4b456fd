"""The conductor: an agent that lets a person play, pause and step a flight, and choose who flies."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import FlightEndedError
from dq_marine.agents.interactive.controls import (
    AGENT,
    CURRENT,
    GOAL,
    HOLD,
    POWER,
    PULL,
    QUIT,
    RESET,
    SEED,
    STICK,
    flight_controls,
    stick_positions,
)
from dq_marine.agents.interactive.gains import Gains
from dq_marine.agents.interactive.hand import Hand
from dq_marine.agents.interactive.helm import Helm
from dq_marine.agents.interactive.next_episode import NextEpisode
from dq_marine.agents.interactive.readings import readings
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.moved_goal import move_goal
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.view import shape_of
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.controls import LEFT, Event
from dq_marine.viewer.live import LiveViewer
from dq_marine.viewer.playback import PLAYING, STEP, Playback

LOOKED_EVERY = 0.2
"""Time on the wall between looks at the page while something else is waited for [s]."""

DRAWN_EVERY, READ_EVERY = 1.0 / 30.0, 0.1
"""Time on the wall between pictures, and between readings [s]; a fast flight draws less often than it steps."""


class Conductor:
    """Flies by the agent that a person has chosen, when and as fast as that person wants.

    Attributes:
        seed: of the next episode.
        quitting: whether the person has had enough.
        restarting: whether the person ended the episode, to have another.
        pushed: of each control period of the episode, whether the person pulled the vehicle by hand in it.
    """

    def __init__(
        self,
        viewer: LiveViewer,
        agents: Mapping[str, Agent],
        helm: Helm,
        *,
        seed: int,
        next_episode: NextEpisode,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Take who can fly; the first of them does at the beginning.

        Args:
            viewer: shows the flight, and the panel.
            agents: by name, in the order in which they are offered; the helm among them.
            helm: does what the stick says.
            seed: of the first episode.
            next_episode: takes what is chosen for it.
            sleep: waits for so many seconds.
        """
        self.seed, self.quitting, self.restarting = seed, False, False
        self._viewer, self._agents, self._helm = viewer, dict(agents), helm
        self._next_episode, self._hand = next_episode, Hand()
        self.pushed: list[bool] = []
        self._playback, self._sleep = Playback(sleep=sleep), sleep
        self._gains = Gains(self._agents)
        self._chosen = next(iter(self._agents))
        self._notice = ""
        self._current: tuple[float, float] | None = None
        self._drawn_at = self._read_at = -np.inf
        self._env: MarineEnv | None = None
        self._does: dict[str, Callable[[Any], None]] = {
            RESET: lambda _: self._restart(),
            QUIT: lambda _: self._quit(),
            SEED: self._take_seed,
            AGENT: self._choose,
            STICK: self._move_stick,
            PULL: self._hand.take,
            LEFT: lambda _: self._let_go(),
            POWER: lambda power: setattr(self._helm, "power", power),
            HOLD: lambda hold: setattr(self._helm, "hold", hold and self._helm.can_hold),
            GOAL: self._move_goal,
            CURRENT[0]: lambda speed: self._turn_current(speed, None),
            CURRENT[1]: lambda bearing: self._turn_current(None, bearing),
        }

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Show the beginning of an episode, and the controls that its environment has."""
        self._env = marine(env)
        self.restarting, self._current, self.pushed = False, None, []
        self._hand.take(None)
        for agent in self._agents.values():
            agent.reset(env)
        self._playback.begin()
        self._viewer.clear_trail()
        self._show_controls()
        self._viewer.show_notice(self._notice)
        self._notice = ""
        self._show(at_once=True)

    def take_over(self, env: gym.Env[Any, Any], agents: Mapping[str, Agent], helm: Helm) -> None:
        """Fly another environment from its next reset on; who flew flies on, if that is possible.

        Args:
            env: the other one.
            agents: who can fly it, by name, the helm among them.
            helm: its helm, which is left with what the person set at the one before.
        """
        inner = marine(env)
        helm.power = self._helm.power
        helm.hold = helm.can_hold and (self._helm.hold or not self._helm.can_hold)
        self._agents, self._helm = dict(agents), helm
        self._gains = Gains(self._agents)
        self._chosen = self._chosen if self._chosen in self._agents else next(iter(self._agents))
        self._viewer.show_vehicle(shape_of(inner.vehicle), inner.vehicle.name)

    def say_next(self, notice: str) -> None:
        """Show a notice with the next episode."""
        self._notice = notice

    def wait_for(self, work: Future[Any], notice: str) -> None:
        """Return when work that another thread does is done; the page says how long that takes, and is listened to.

        What a person wants meanwhile is done at its end: Quit, or Ctrl-C, a second of which is not waited for.
        """
        began = time.monotonic()
        while not work.done():
            try:
                self._viewer.show_notice(f"{notice} {time.monotonic() - began:.0f} s")
                with suppress(FlightEndedError):
                    self._hear()
                self._sleep(LOOKED_EVERY)
            except KeyboardInterrupt:
                if self.quitting:
                    raise
                self.quitting = True

    def act(self, observation: Observation) -> Action:
        """Return the chosen agent's action, once the person lets the flight go on.

        Raises:
            FlightEndedError: the person wants another episode, or none.
        """
        self._show(at_once=not self._playback.playing)
        self._playback.wait(self._flying.time, self._hear)
        action = self._agents[self._chosen].act(observation)
        self.pushed.append(self._hand.pull(self._flying))
        return action

    def goes_on_after(self, notice: str) -> bool:
        """Show how an episode ended, and wait; return whether the person wants another one."""
        self._playback.take(Event(PLAYING, False))
        try:
            self._viewer.show_values({PLAYING: False})
            self._viewer.show_notice(notice)
            self._show(at_once=True)
            self._playback.wait(self._flying.time, self._hear)
        except FlightEndedError:
            pass
        except KeyboardInterrupt:
            self.quitting = True
        self._playback.take(Event(PLAYING, True))
        return not self.quitting

    @property
    def flown_by(self) -> str:
        """Name of the agent that flies now."""
        return self._chosen

    @property
    def _flying(self) -> MarineEnv:
        """The environment of the episode under way."""
        if self._env is None:
            raise ResetNeeded("the conductor has no flight yet; reset it first")
        return self._env

    # What a person does

    def _hear(self) -> None:
        """Do what was asked for.

        Raises:
            FlightEndedError: that was to end the episode.
        """
        events: list[Event] = self._viewer.events()
        for event in events:
            self._playback.take(event)
            if event.name in self._does:
                self._does[event.name](event.value)
            elif self._next_episode.take(event):
                self._show_controls()
            else:
                self._tune(event)
        if any(event.name == STEP for event in events):
            self._viewer.show_values({PLAYING: False})
        if self.restarting or self.quitting:
            raise FlightEndedError

    def _restart(self) -> None:
        self.restarting = True

    def _quit(self) -> None:
        self.quitting = True

    def _take_seed(self, seed: int) -> None:
        self.seed = seed

    def _choose(self, name: str) -> None:
        self._chosen = name
        self._agents[name].reset(self._flying)

    def _let_go(self) -> None:
        self._helm.stick = np.zeros(6)
        self._hand.take(None)

    def _move_stick(self, positions: tuple[float, ...]) -> None:
        self._helm.stick = stick_positions(self._flying, positions)

    def _tune(self, event: Event) -> None:
        try:
            self._gains.take(event, self._flying)
        except InvalidInputError as error:
            self._viewer.show_notice(str(error))
            self._viewer.show_values({event.name: self._gains.value(event.name)})

    def _move_goal(self, position_ned: tuple[float, float, float]) -> None:
        try:
            move_goal(self._flying, position_ned)
        except InvalidInputError as error:
            self._viewer.show_notice(str(error))
        self._show(at_once=not self._playback.playing)

    def _turn_current(self, speed: float | None, bearing: float | None) -> None:
        env = self._flying
        north, east, _ = env.episode.current_ned
        was_speed, was_bearing = self._current or (
            float(np.hypot(north, east)),
            float(np.degrees(np.arctan2(east, north))),
        )
        self._current = (
            was_speed if speed is None else speed,
            was_bearing if bearing is None else bearing,
        )
        angle = np.radians(self._current[1])
        try:
            env.set_current((self._current[0] * np.cos(angle), self._current[0] * np.sin(angle), 0.0))
        except InvalidInputError as error:
            self._viewer.show_notice(str(error))

    # What a person sees

    def _show_controls(self) -> None:
        groups = flight_controls(
            self._flying,
            tuple(self._agents),
            self._chosen,
            seed=self.seed,
            playback=self._playback,
            helm=self._helm,
        )
        self._viewer.show_controls((*groups, *self._next_episode.groups(), *self._gains.groups()))

    def _show(self, *, at_once: bool) -> None:
        env, now = self._flying, time.monotonic()
        if at_once or now - self._drawn_at >= DRAWN_EVERY:
            self._viewer.draw(env.snapshot())
            self._drawn_at = now
        if at_once or now - self._read_at >= READ_EVERY:
            self._viewer.show_readings(env.time, readings(env))
            self._read_at = now
