"""What every environment of one vehicle shares: stepping, checks, state, rendering. A task adds its formulas."""

from __future__ import annotations

import copy
import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from dq_marine.checks import finite_number, positive_integer
from dq_marine.engines.control_period import ACTION_NOT_FINITE, compiled_control_period
from dq_marine.engines.packing import pack, structure_type, unpack
from dq_marine.envs.beginning import begun_episode
from dq_marine.envs.currents import EnvironmentCurrent, check_current, current_met, drawn_current, numbers_of
from dq_marine.envs.drive import commanded, drive_of
from dq_marine.envs.episode import Episode, restored_generator
from dq_marine.envs.refusal import integration_report
from dq_marine.envs.start import as_chosen, at_origin, checked_options, drawn_uniforms
from dq_marine.envs.vehicle_pool import FIXED_VEHICLE, VehicleDraw, prepared_pool
from dq_marine.envs.view import EpisodeView, checked_render_mode
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.beginning import CLOCK_SPAN, Drawn, beginning_draws, make_draw
from dq_marine.kernel.body import Motion
from dq_marine.kernel.spatial import to_fossen
from dq_marine.kernel.step import ACCEPTED, StepParameters, make_motion
from dq_marine.kernel.task import Task, draws_of_period
from dq_marine.kernel.vector3 import dot
from dq_marine.scene import Scene
from dq_marine.vehicles import Vehicle, load_vehicle
from dq_marine.viewer.snapshot import Snapshot
from dq_marine.weather import weather_of, weather_terms

MOST_SUBSTEPS = 10_000
"""Integrator steps in a control period: more would hold the process for long, and never be needed."""

Observation = NDArray[np.float32]
Action = NDArray[np.float32]


class MarineEnv(gym.Env[Observation, Action], ABC):
    """One vehicle in a current, driven by body thrust and torque, or by its thrusters.

    A task derives from it, names its kernel functions in `task` and says how goals and starts are drawn.

    Attributes:
        vehicle: the validated vehicle.
        pool: the vehicles that episodes fly: that one, or those drawn from it.
        scene: what is integrated, with the largest current that may be drawn and the pool's first vehicle.
        weather: what makes the scene's forces besides.
        restless: whether it changes, so that episodes begin at a time that is drawn.
        task: the formulas of the task, for what drives the vehicle.
        drive: what an action does.
        control_period: time between actions [s].
        substeps: integrator steps in a control period.
        substeps_rescued: of all taken so far, those that plain Newton did not solve (see `kernel.drift`).
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["human", "rgb_array"], "render_fps": 10}  # type: ignore[misc]
    task: Task

    def __init__(
        self,
        vehicle: Vehicle | str | os.PathLike[str],
        *,
        current: EnvironmentCurrent,
        control_period: float,
        substeps: int,
        scheme: str,
        hydrostatics: str,
        actuation: str,
        weather: Sequence[Any],
        render_mode: str | None,
        record: bool,
        vehicle_draw: VehicleDraw = FIXED_VEHICLE,
    ) -> None:
        """Check and compose; see the tasks for the arguments."""
        self.control_period = finite_number("control_period", control_period, above=0.0)
        self.substeps = positive_integer("substeps", substeps)
        if self.substeps > MOST_SUBSTEPS:
            raise InvalidInputError(f"substeps = {self.substeps}; give at most {MOST_SUBSTEPS}")
        self.vehicle = load_vehicle(vehicle)
        wanted, self.current_draw = drawn_current(current)
        self.current_speed = self.current_draw.speed
        step = self.control_period / self.substeps
        self.weather = weather_of(weather)
        self.restless = any(part.changes for part in self.weather)
        compose = partial(Scene, current=wanted, step=step, scheme=scheme, hydrostatics=hydrostatics)

        def scene_of(one: Vehicle) -> Scene:
            forces = weather_terms(self.weather, one, np.array(self.current_draw.fixed))
            return compose(one, actuation=actuation, forces=forces)

        numbers = partial(numbers_of, period=self.control_period)
        vehicles = vehicle_draw.vehicles(self.vehicle)
        self.pool = prepared_pool(vehicles, scene_of, numbers, self.vehicle_aim)
        self.scene = self.pool.scene
        self.drive = drive_of(self.scene)
        self.task = self.drive.task(self.own_task())
        self.render_mode = checked_render_mode(render_mode, self.metadata["render_modes"])
        self.record = bool(record)
        self.metadata = {**self.metadata, "render_fps": 1.0 / self.control_period}  # type: ignore[misc]

        bound = self.observation_bound
        self.action_space = gym.spaces.Box(-1.0, 1.0, (len(self.drive.places),), np.float32)
        self.observation_space = gym.spaces.Box(-bound, bound, dtype=np.float32)
        self.base_parameters = self.pool.parameters[0]
        self._period_draws = len(pack(draws_of_period(self.scene.composition, self.task)))
        self._motion = make_motion(self.scene.composition)
        self._compiled = self._compile()
        self._view = EpisodeView(self)
        self.substeps_rescued = 0
        self._episode: Episode | None = None

    # What a task adds

    @abstractmethod
    def own_task(self) -> Task:
        """Return the task's formulas, whatever drives the vehicle."""

    @property
    @abstractmethod
    def observation_bound(self) -> NDArray[np.float32]:
        """Largest magnitude of each observed number."""

    @abstractmethod
    def new_aim(self, options: dict[str, Any]) -> Any:
        """Return the task's parameters for an episode."""

    def vehicle_aim(self, vehicle: Vehicle) -> dict[str, Any]:
        """Return those of the task's parameters that are a vehicle's, by name: the same names for every vehicle."""
        return {"wrench_limits": tuple(vehicle.wrench_limits.tolist())}

    @abstractmethod
    def goal_pose(self, aim: Any) -> tuple[Any, Any] | None:
        """Return the goal's position and attitude for drawing, None if there is none."""

    @abstractmethod
    def succeeds(self, measures: dict[str, Any]) -> Any:
        """Whether the measures are those of success; for arrays of them, an array."""

    # Gymnasium

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start an episode.

        Args:
            seed: of the random draws; an episode follows from it bit for bit.
            options: what not to draw: any of `START_OPTIONS`, in NED and SI units.

        Returns:
            The observation, and info with the task's measures, `is_success`, `current_ned` and, where there is a
            choice, `vehicle`: its number in the pool.

        Raises:
            InvalidInputError: an option is unknown or wrong; the episode in progress is untouched.
        """
        super().reset(seed=seed)
        chosen = self.checked_options(options)
        aim = self.new_aim(chosen)
        number = self.pool.drawn(self.np_random)
        aim = self.pool.fitted(aim, number)
        uniforms = self.np_random.random(beginning_draws(self.task))
        drawn = make_draw(self.scene.composition, self.task)(aim, self.current_draw, tuple(uniforms.tolist()))
        self._episode = self._new_episode(aim, as_chosen(drawn, chosen), number)
        if self.restless:
            self._episode.clock = CLOCK_SPAN * self.np_random.random()
        self._view.begin(self)
        begun = {"vehicle": number} if self.pool.has_choice else {}
        return self.observation, self._info() | {"current_ned": self._episode.current_ned.copy()} | begun

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Hold an action for one control period.

        Args:
            action: thrust and torque of the actuated axes, or commands of the channels, over their limits;
                saturates beyond [-1, 1].

        Returns:
            Observation, reward, terminated, truncated (False: `gym.make` adds the time limit), info.

        Raises:
            InvalidInputError: the action has a wrong shape or a NaN or infinity; the state is untouched.
            ResetNeeded: before the first reset.
        """
        episode = self._running("step")
        command = commanded(self.drive, action)
        uniforms = drawn_uniforms(self.np_random, self._period_draws, command)
        status, completed, rescued, residual_squared, reward, terminated = self._compiled(
            episode.parameters,
            episode.aim,
            episode.state,
            episode.memory,
            command,
            episode.observation,
            episode.measures,
            episode.periods * self.control_period + episode.clock,
            self.substeps,
            uniforms,
        )
        if status == ACTION_NOT_FINITE:
            raise InvalidInputError(
                f"action = {np.asarray(action).tolist()} is not finite; give finite numbers"
            )
        self.substeps_rescued += rescued
        episode.action = command
        episode.periods += 1
        episode.current_ned = current_met(self.scene, self.base_parameters, episode)
        info = self._info()
        if status != ACCEPTED:
            velocity = self.motion.velocity
            spin, speed = dot(velocity.angular, velocity.angular), dot(velocity.linear, velocity.linear)
            report = (self.scene.step, status, completed, residual_squared, spin, speed)
            info["integration"] = integration_report(*report)
        if self._view.wants_frames:
            self._view.show(self)
        return episode.observation.copy(), reward, terminated != 0.0, False, info

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture, uint8 (height, width, 3), in mode "rgb_array"; None otherwise.

        In mode "human" the page follows `step` and `reset` by itself, at real time.

        Raises:
            ResetNeeded: before the first reset.
            MissingDependencyError: meshcat, or for pictures a Chromium, is not installed.
        """
        self._running("render")
        return self._view.render(self)

    def render_still(self) -> NDArray[np.uint8]:
        """Return a picture as `render` does, without the trail that led here."""
        self._running("render")
        return self._view.render_still(self)

    def save_html(self, path: str | os.PathLike[str]) -> None:
        """Write the episode so far as a standalone page with a timeline (play, pause, scrub).

        Raises:
            InvalidInputError: the environment was made without `record=True`, or the folder does not exist.
            MissingDependencyError: meshcat is not installed.
        """
        self._view.save_html(path)

    def close(self) -> None:
        """End whatever rendering started."""
        self._view.close()

    # State

    @property
    def observation(self) -> Observation:
        """What the last `reset` or `step` returned."""
        return self._running("observation").observation.copy()

    @property
    def motion(self) -> Motion:
        """Position, attitude and velocity over ground now."""
        return self._motion(self._parameters, self._running("motion").body)

    @property
    def time(self) -> float:
        """Simulated time since reset [s]."""
        return self._running("time").periods * self.control_period

    @property
    def position_ned(self) -> NDArray[np.float64]:
        """Position of the body origin [m], shape (3,)."""
        return np.array(self.motion.position_ned)

    @property
    def quaternion_body_to_ned(self) -> NDArray[np.float64]:
        """Attitude, scalar first, shape (4,)."""
        return np.array(self.motion.attitude)

    @property
    def velocity_body(self) -> NDArray[np.float64]:
        """Velocity over ground, Fossen's order [m/s, rad/s], shape (6,)."""
        return np.array(to_fossen(self.motion.velocity))

    def get_state(self) -> dict[str, Any]:
        """Return all that the future depends on, the random generator included, for `set_state`.

        Raises:
            ResetNeeded: before the first reset.
        """
        episode = self._running("get_state").to_dict()
        return episode | {"random": copy.deepcopy(self.np_random.bit_generator.state)}

    def set_state(self, state: dict[str, Any]) -> None:
        """Restart bit for bit from what `get_state` returned, here or in an environment made alike.

        Raises:
            InvalidInputError: entries are missing, unknown or of the wrong size; nothing is changed.
        """
        if not isinstance(state, dict) or "random" not in state:
            raise InvalidInputError("the state is not what get_state() returned: it has no entry 'random'")
        template = self._new_episode(self.new_aim({}), at_origin(self.task.sensing.first_draws))
        episode = template.restored({name: value for name, value in state.items() if name != "random"})
        self.pool.check_number(episode.vehicle)
        random = restored_generator(state["random"])
        self.adopt(episode, random)
        self._view.begin(self)

    def adopt(self, episode: Episode, random: np.random.Generator, seed: int | None = -1) -> None:
        """Go on with an episode, and a generator, with its seed if that is known, for those that follow."""
        self.np_random = random
        self._np_random_seed = seed
        self._episode = episode

    @property
    def episode(self) -> Episode:
        """The one in progress.

        Raises:
            ResetNeeded: before the first reset.
        """
        return self._running("the episode")

    @property
    def flown_vehicle(self) -> Vehicle:
        """The one of the pool that the episode in progress flies."""
        return self.pool.vehicles[self.episode.vehicle]

    @property
    def action_names(self) -> tuple[str, ...]:
        """What each number of an action drives: axes such as "surge", or channels of the vehicle's actuators."""
        return self.drive.names

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what cannot travel: compiled code and open windows."""
        return {name: value for name, value in self.__dict__.items() if name not in _NOT_CARRIED}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Compile again (from the cache on disk) and start without a window."""
        self.__dict__.update(state)
        self.drive = drive_of(self.scene)
        self.task = self.drive.task(self.own_task())
        self._motion = make_motion(self.scene.composition)
        self._compiled = self._compile()
        self._view = EpisodeView(self)

    def snapshot(self) -> Snapshot:
        """Return what a viewer draws now."""
        episode, motion = self._running("snapshot"), self.motion
        goal = self.goal_pose(unpack(self.new_aim({}), episode.aim))
        return Snapshot(
            time=self.time,
            position_ned=np.array(motion.position_ned),
            quaternion_body_to_ned=np.array(motion.attitude),
            wrench_body=self.drive.wrench_body(self.flown_vehicle, self._parameters, episode),
            current_ned=episode.current_ned,
            goal_position_ned=None if goal is None else np.array(goal[0]),
            goal_quaternion_body_to_ned=None if goal is None else np.array(goal[1]),
        )

    # Inside

    def _compile(self) -> Callable[..., Any]:
        return compiled_control_period(
            self.scene.composition,
            self.task,
            structure_type(self.base_parameters),
            structure_type(self.new_aim({})),
            structure_type(self.task.forget(self.new_aim({}))),
        )

    def _running(self, what: str) -> Episode:
        if self._episode is None:
            raise ResetNeeded(f"{what} was asked for before reset(); call reset() first")
        return self._episode

    def _new_episode(self, aim: Any, drawn: Drawn, number: int = 0) -> Episode:
        parts = (self.scene.composition, self.task, self.pool.parameters[number], aim, drawn)
        return begun_episode(*parts, number, self.drive.size)

    def _info(self) -> dict[str, Any]:
        numbers = self._running("info").measures.tolist()
        measures = dict(zip(self.task.measure_names, numbers, strict=True))
        return measures | {"is_success": self.succeeds(measures)}

    @property
    def _parameters(self) -> StepParameters:
        """The numbers of the step of the episode in progress, its water included."""
        return unpack(self.base_parameters, self._running("the parameters").parameters)  # type: ignore[no-any-return]

    def checked_options(self, options: dict[str, Any] | None) -> dict[str, NDArray[np.float64]]:
        """Return reset's options as arrays."""
        return check_current(checked_options(options), self.scene)


_NOT_CARRIED = ("_compiled", "_motion", "_view", "drive", "task")
