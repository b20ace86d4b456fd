"""Flights with a panel: in a live page, episode after episode, until the person quits."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import gymnasium as gym

from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import Episode, fly_episode, with_pushes
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, options_of, periods_of, write_outputs
from dq_marine.agents.interactive.conductor import Conductor
from dq_marine.agents.interactive.flights import (
    HELM,
    Flight,
    MakeAgents,
    begun_flight,
    compile_step,
    opened_flight,
    replanned,
)
from dq_marine.agents.interactive.next_episode import NextEpisode
from dq_marine.agents.interactive.recording import Recorder
from dq_marine.envs.core.view import open_page, shape_of
from dq_marine.errors import DQMarineError
from dq_marine.viewer.live import LiveViewer

T = TypeVar("T")

MAKING = "Making the environment; the first time, compiling it takes 10 to 20 s."


def fly_interactively(
    plan: FlightPlan,
    make_agents: MakeAgents,
    outputs: Outputs,
    *,
    title: str,
    teleoperated: bool = False,
    recorder: Recorder | None = None,
) -> Episode:
    """Fly in a live page with a panel, until the person quits there or presses Ctrl-C.

    Args:
        plan: what to fly at first; the person may choose other seeds, and another environment.
        make_agents: given an environment, returns who can fly it besides the helm, by name.
        outputs: files that tell of the last episode.
        title: above the plot; "{seed}" in it becomes the seed.
        teleoperated: whether the helm flies at first, and not the first of the agents.
        recorder: keeps all episodes, if there is one; the caller leaves it.

    Returns:
        The last episode.

    Raises:
        InvalidInputError: the plan is wrong, or a file cannot be written.
        MissingDependencyError: the viewer's or the plot's libraries are not installed.
    """
    flight, seed = opened_flight(plan, make_agents, outputs, teleoperated=teleoperated)
    session = _Session(flight, make_agents, outputs, recorder)
    try:
        episode = session.fly(seed)
        write_outputs(session.env, episode, outputs, title=title.replace("{seed}", str(episode.seed)))
    finally:
        session.leave()
    return episode


class _Session:
    """Episodes one after the other, each in the environment that the person has chosen for it.

    Attributes:
        env: in which is flown now; around it, what records, if anything does.
    """

    _conductor: Conductor

    def __init__(
        self, flight: Flight, make_agents: MakeAgents, outputs: Outputs, recorder: Recorder | None
    ) -> None:
        self._make_agents, self._outputs, self._recorder = make_agents, outputs, recorder
        self._next_episode = NextEpisode(flight.plan.environment)
        self._enter(flight)

    def fly(self, seed: int) -> Episode:
        """Fly in a page of its own until the person quits; return the last episode."""
        flight, vehicle = self._flight, marine(self.env).vehicle
        with open_page(shape_of(vehicle), vehicle.name) as page:
            self._conductor = Conductor(
                page, flight.agents, flight.helm, seed=seed, next_episode=self._next_episode
            )
            self._show_start(page, seed)
            while True:
                episode = self._fly_one()
                if not self._goes_on_after(episode):
                    return episode
                if self._next_episode.changed:
                    self._change()
                if self._conductor.quitting:
                    return episode

    def leave(self) -> None:
        """Keep what was recorded, and close the environment."""
        self._keep_and_close(self.env)

    def _keep_and_close(self, env: gym.Env[Any, Any]) -> None:
        try:
            if self._recorder is not None:
                self._recorder.keep_flown(env)
        finally:
            env.close()

    def _enter(self, flight: Flight) -> None:
        self._flight = flight
        self.env: gym.Env[Any, Any] = flight.env
        if self._recorder is not None:
            self.env = self._recorder.recording_of(
                flight.env,
                lambda: self._conductor.flown_by == HELM,
                lambda: self._conductor.pushed[-1],
            )

    def _show_start(self, page: LiveViewer, seed: int) -> None:
        """Show where the first episode begins, while its steps are compiled; what can be done comes thereafter."""
        env = self._flight.env
        env.reset(seed=seed, options=options_of(env, self._flight.plan, seed))
        page.draw(marine(env).snapshot())
        self._aside(compile_step, env)

    def _aside(self, make: Callable[..., T], *arguments: Any) -> T:
        """Return what a function makes in another thread, while the page says that it does."""
        with ThreadPoolExecutor(1) as aside:
            work = aside.submit(make, *arguments)
            self._conductor.wait_for(work, MAKING)
        return work.result()

    def _fly_one(self) -> Episode:
        seed, track = self._conductor.seed, self._outputs.trajectory is not None
        options = options_of(self._flight.env, self._flight.plan, seed)
        episode = fly_episode(
            self.env, self._conductor, seed=seed, options=options, interruptible=True, track=track
        )
        return with_pushes(episode, self._conductor.pushed)

    def _goes_on_after(self, episode: Episode) -> bool:
        """Return whether the person wants another episode, which is asked where this one came to its end."""
        if self._conductor.restarting:
            return True
        whole = len(episode.actions) == periods_of(self._flight.plan, self._flight.env)
        if self._conductor.quitting or not (episode.ended_early or whole):  # the latter by Ctrl-C
            return False
        return self._conductor.goes_on_after(_end_of(episode))

    def _change(self) -> None:
        """Go over to the environment that the person has chosen, unless it cannot be made, or they quit meanwhile."""
        conductor = self._conductor
        try:
            plan = replanned(self._flight.plan, self._next_episode.settings, conductor.seed)
            flight = self._aside(begun_flight, plan, self._make_agents, self._outputs)
        except DQMarineError as error:
            conductor.say_next(str(error))
            return
        if conductor.quitting:  # the files tell of the episode before
            flight.env.close()
            return
        before = self.env
        self._enter(flight)
        self._keep_and_close(before)
        self._next_episode.changed = False
        conductor.take_over(flight.env, flight.agents, flight.helm)


def _end_of(episode: Episode) -> str:
    """Return how an episode ended, in words."""
    how = "The task is done" if episode.success else "The task is not done"
    when = f"after {episode.time[-1]:.1f} s"
    return f"{how} {when}. Press play, or New episode, for another one."
