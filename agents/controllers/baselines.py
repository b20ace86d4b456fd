"""What flies a vehicle: one protocol, and the agents that need no training."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Protocol, Self, runtime_checkable

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.avoidance import AvoidanceController
from dq_marine.agents.controllers.berthing import BerthingController
from dq_marine.agents.controllers.docking import DockingController
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.encounters import EncounterController
from dq_marine.agents.controllers.formations import FormationController
from dq_marine.agents.controllers.journeys import DepthHeadingController, PathController, WaypointController
from dq_marine.agents.controllers.pipelines import PipelineController
from dq_marine.agents.controllers.reading import shown_names
from dq_marine.agents.controllers.rendezvous import RendezvousController
from dq_marine.agents.controllers.terrain import TerrainController
from dq_marine.agents.controllers.tracking import TrackingController
from dq_marine.agents.environments import marine
from dq_marine.checks import one_of
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError

BASELINES = ("controller", "zero", "random")
"""Agents that fly any task, or nearly: "controller" is of the kind that suits a task."""


class Agent(Protocol):
    """Anything that turns observations into actions.

    The caller resets the environment first and then the agent, so that the agent finds the episode under way.
    """

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Prepare for the episode that has just begun in `env`."""

    def act(self, observation: Observation) -> Action:
        """Return the action for an observation."""


class Controller(Agent, Protocol):
    """An agent that flies any environment whose observation has the parts that it reads.

    Attributes:
        READS: names of these parts.
    """

    READS: ClassVar[tuple[str, ...]]

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any]) -> Self:
        """Return the controller for an environment's vehicle, actuation and control period.

        Raises:
            InvalidInputError: it cannot fly in this environment.
        """


@runtime_checkable
class Estimating(Protocol):
    """A controller that finds out, from what came before, what no observation shows."""

    @property
    def estimate(self) -> NDArray[np.float64]:
        """What it has found out by now, shape (k,)."""


def estimate_of(agent: Agent) -> NDArray[np.float64]:
    """Return what an agent has found out that no observation shows, shape (k,); k is 0 for one that tells of none."""
    return agent.estimate if isinstance(agent, Estimating) else np.zeros(0)


CONTROLLERS: tuple[type[Controller], ...] = (
    BerthingController,
    DockingController,
    TrackingController,
    DPController,
    PathController,
    WaypointController,
    DepthHeadingController,
    EncounterController,
    FormationController,
    RendezvousController,
    AvoidanceController,
    TerrainController,
    PipelineController,
)
"""What "controller" may mean: the first of them that an environment shows enough to."""


class ZeroAgent:
    """Drifts: every action is zero."""

    def __init__(self, axes: int) -> None:
        """Take the number of actuated axes."""
        self._action = np.zeros(axes, dtype=np.float32)

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Do nothing."""

    def act(self, observation: Observation) -> Action:
        """Return zeros, shape (axes,)."""
        return self._action.copy()


class RandomAgent:
    """Draws every action uniformly from [-1, 1]."""

    def __init__(self, axes: int, seed: int = 0) -> None:
        """Take the number of actuated axes and the seed of all episodes to come."""
        self._axes = axes
        self._random = np.random.default_rng(seed)

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Go on drawing: every episode gets actions of its own."""

    def act(self, observation: Observation) -> Action:
        """Return uniform numbers, shape (axes,)."""
        return self._random.uniform(-1.0, 1.0, self._axes).astype(np.float32)


def _lqr(env: gym.Env[Any, Any]) -> Agent:
    from dq_marine.agents.controllers.trajectory_control import LQRController  # here: it imports SciPy

    return LQRController.for_env(env)


def _mpc(env: gym.Env[Any, Any]) -> Agent:
    from dq_marine.agents.controllers.mpc import MPCController  # here: it imports SciPy and OSQP

    return MPCController.for_env(env)


MODEL_BASED: dict[str, Callable[[gym.Env[Any, Any]], Agent]] = {"lqr": _lqr, "mpc": _mpc}
"""Agents that track a point that moves, with a model of a vehicle; they need the extra `mpc`."""

AGENTS = (*BASELINES, *MODEL_BASED)
"""Names that `make_baseline` takes."""

DRAWING = ("random",)
"""Those whose actions in an episode depend on the episodes before: they go on drawing."""


def make_baseline(name: str, env: gym.Env[Any, Any], seed: int = 0) -> Agent:
    """Return one of `AGENTS` for an environment.

    Raises:
        InvalidInputError: the name is unknown, or the controller cannot fly in this environment.
        MissingDependencyError: a library that the controller needs is not installed.
    """
    axes = int(np.prod(env.action_space.shape or ()))
    if one_of("agent", name, AGENTS) == "controller":
        return controller_for(env)
    if name in MODEL_BASED:
        return MODEL_BASED[name](env)
    return ZeroAgent(axes) if name == "zero" else RandomAgent(axes, seed)


def controller_for(env: gym.Env[Any, Any]) -> Agent:
    """Return the first of `CONTROLLERS` whose parts an environment's observation has.

    Raises:
        InvalidInputError: there is none, or it cannot fly in this environment.
    """
    inner = marine(env)
    shown = set(shown_names(inner))
    for controller in CONTROLLERS:
        if shown.issuperset(controller.READS):
            return controller.for_env(env)
    reads = "; ".join(f"{one.__name__} reads {', '.join(one.READS)}" for one in CONTROLLERS)
    raise InvalidInputError(
        f"no controller of this package flies {inner.definition.id}, which shows "
        f"{', '.join(shown_names(inner))}: {reads}"
    )
