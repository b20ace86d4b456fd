"""The conductor: an agent that lets a person play, pause and step a flight, and choose who flies."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import FlightEndedError
from dq_marine.agents.interactive.controls import (
    AGENT,
    CURRENT,
    HOLD,
    PLAYING,
    POWER,
    QUIT,
    RESET,
    SEED,
    SPEED,
    STEP,
    STICK,
    flight_controls,
    stick_positions,
)
from dq_marine.agents.interactive.helm import Helm
from dq_marine.agents.interactive.readings import readings
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.controls import LEFT, Event
from dq_marine.viewer.live import LiveViewer
from dq_marine.viewer.pacing import RealTimePacer

HELM = "helm"
"""What the helm is called among the agents."""

PATIENCE = 0.02
"""Time between looks at what a person does, while the flight is paused [s]."""

DRAWN_EVERY, READ_EVERY = 1.0 / 30.0, 0.1
"""Time on the wall between pictures, and between readings [s]; a fast flight draws less often than it steps."""


class Conductor:
    """Flies by the agent that a person has chosen, when and as fast as that person wants.

    Attributes:
        seed: of the next episode.
        quitting: whether the person has had enough.
        restarting: whether the person ended the episode, to have another.
    """

    def __init__(
        self,
        viewer: LiveViewer,
        agents: Mapping[str, Agent],
        helm: Helm,
        *,
        seed: int,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Take who can fly; the first of them does at the beginning.

        Args:
            viewer: shows the flight, and the panel.
            agents: by name, in the order in which they are offered; the helm among them.
            helm: does what the stick says.
            seed: of the first episode.
            sleep: waits for so many seconds.
        """
        self.seed, self.quitting, self.restarting = seed, False, False
        self._viewer, self._agents, self._helm, self._sleep = viewer, dict(agents), helm, sleep
        self._chosen = next(iter(self._agents))
        self._playing, self._speed, self._steps = True, 1.0, 0
        self._current: tuple[float, float] | None = None
        self._drawn_at = self._read_at = -np.inf
        self._pacer = RealTimePacer(self._speed)
        self._env: MarineEnv | None = None
        self._does: dict[str, Callable[[Any], None]] = {
            PLAYING: self._play,
            STEP: lambda _: self._step(),
            RESET: lambda _: self._restart(),
            QUIT: lambda _: self._quit(),
            SEED: self._take_seed,
            SPEED: self._take_speed,
            AGENT: self._choose,
            STICK: self._move_stick,
            LEFT: lambda _: self._move_stick(None),
            POWER: lambda power: setattr(helm, "power", power),
            HOLD: lambda hold: setattr(helm, "hold", hold and helm.can_hold),
            CURRENT[0]: lambda speed: self._turn_current(speed, None),
            CURRENT[1]: lambda bearing: self._turn_current(None, bearing),
        }

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Show the beginning of an episode, and the controls that its environment has."""
        inner = self._env = marine(env)
        self._steps, self.restarting, self._current = 0, False, None
        for agent in self._agents.values():
            agent.reset(env)
        self._pacer = RealTimePacer(self._speed)
        self._viewer.clear_trail()
        self._viewer.show_controls(
            flight_controls(
                inner,
                tuple(self._agents),
                self._chosen,
                seed=self.seed,
                speed=self._speed,
                playing=self._playing,
                helm=self._helm,
            )
        )
        self._viewer.show_notice("")
        self._show(at_once=True)

    def act(self, observation: Observation) -> Action:
        """Return the chosen agent's action, once the person lets the flight go on.

        Raises:
            FlightEndedError: the person wants another episode, or none.
        """
        self._show(at_once=not self._playing)
        self._hear()
        while not (self._playing or self._steps):
            self._sleep(PATIENCE)
            self._hear()
        self._steps = max(self._steps - 1, 0)
        if self._env is not None:
            self._pacer.wait_until(self._env.time)
        return self._agents[self._chosen].act(observation)

    def goes_on_after(self, notice: str) -> bool:
        """Show how an episode ended, and wait; return whether the person wants another one."""
        self._playing, self._steps = False, 0
        self._viewer.show_values({PLAYING: False})
        self._viewer.show_notice(notice)
        self._show(at_once=True)
        try:
            while not self._playing:
                self._sleep(PATIENCE)
                self._hear()
        except FlightEndedError:
            pass
        except KeyboardInterrupt:
            self.quitting = True
        self._playing = True
        return not self.quitting

    # What a person does

    def _hear(self) -> None:
        """Do what was asked for.

        Raises:
            FlightEndedError: that was to end the episode.
        """
        events: list[Event] = self._viewer.events()
        for event in events:
            self._does[event.name](event.value)
        if self.restarting or self.quitting:
            raise FlightEndedError

    def _play(self, playing: bool) -> None:
        self._playing = playing
        self._pacer = RealTimePacer(self._speed)

    def _step(self) -> None:
        self._steps += 1
        self._playing = False
        self._viewer.show_values({PLAYING: False})

    def _restart(self) -> None:
        self.restarting = True

    def _quit(self) -> None:
        self.quitting = True

    def _take_seed(self, seed: int) -> None:
        self.seed = seed

    def _take_speed(self, speed: float) -> None:
        self._speed = speed
        self._pacer = RealTimePacer(speed)

    def _choose(self, name: str) -> None:
        self._chosen = name
        if self._env is not None:
            self._agents[name].reset(self._env)

    def _move_stick(self, positions: tuple[float, ...] | None) -> None:
        if self._env is not None:
            self._helm.stick = stick_positions(self._env, positions)

    def _turn_current(self, speed: float | None, bearing: float | None) -> None:
        env = self._env
        if env is None:
            return
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

    def _show(self, *, at_once: bool) -> None:
        env, now = self._env, time.monotonic()
        if env is None:
            return
        if at_once or now - self._drawn_at >= DRAWN_EVERY:
            self._viewer.draw(env.snapshot())
            self._drawn_at = now
        if at_once or now - self._read_at >= READ_EVERY:
            self._viewer.show_readings(env.time, readings(env))
            self._read_at = now
