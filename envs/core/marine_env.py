"""An environment of one vehicle: any registered task, with Gymnasium's interface."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, Unpack

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from dq_marine.algebra.spatial import to_fossen
from dq_marine.algebra.vector3 import dot
from dq_marine.backend.control_period import ACTION_NOT_FINITE
from dq_marine.backend.packing import Unpacker
from dq_marine.envs.core.action_mapping import whole_action
from dq_marine.envs.core.beginning import begun_episode
from dq_marine.envs.core.currents import turn_current
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.episode import Episode, check_entries, restored_episode, restored_generator
from dq_marine.envs.core.observation import Observation, as_shown, observation_space
from dq_marine.envs.core.refusal import integration_report
from dq_marine.envs.core.shared_memory import beams_told, memory_layers, parameters_of, task_memory
from dq_marine.envs.core.shown_task import ShownTask
from dq_marine.envs.core.start import NO_UNIFORMS, as_chosen, drawn_uniforms
from dq_marine.envs.core.view import EpisodeView, checked_render_mode
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import Motion
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import ACCEPTED, StepParameters
from dq_marine.simulation.settings import Settings, SettingsKeywords, VehicleLike
from dq_marine.task.episode import EpisodeParameters
from dq_marine.task.protocol import RewardTerm
from dq_marine.task.start import CLOCK_SPAN, Drawn, beginning_draws, make_draw
from dq_marine.vehicles import Vehicle
from dq_marine.viewer.snapshot import Snapshot

Action = NDArray[np.float32]


class MarineEnv(ShownTask, gym.Env[Observation, Action]):
    """One vehicle that does a task, driven by body thrust and torque, or by its thrusters. `gym.make` makes one.

    Action: Box(-1, 1, (n,)), the thrust and torque of the n actuated axes, in the order surge, sway, heave, roll,
    pitch, yaw, over the vehicle's limits; or with `actuation="thrusters"` the commands of the n channels of its
    actuators in the order of `Vehicle.channels`, each over its limit on that side. Beyond the box it saturates.

    Observation: what `observations` lists, in that order; with sensors as measured, followed by what they show. Of a
    task with goals it is a dictionary of "observation", "achieved_goal" and "desired_goal", see `GoalMarineEnv`. With
    `privileged` it is a dictionary, whose part of that name holds what `privileged_observations` lists.

    `info` of `reset` and of every `step` has the same keys: the task's metrics, `reward/<name>` of each term of the
    reward, `is_success`, `current_ned`, `refused` (whether the integrator refused the step: then the episode ends, and
    `refusal` says why), and `vehicle`, its number in the pool, where episodes fly different ones.

    Attributes, besides those of `ComposedTask` and `ShownTask`:
        refusal: why the integrator refused the last step; None if it did not.
        fallback_substeps: of all taken so far, those that plain Newton did not solve (see `integrator.drift`).
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["human", "rgb_array"], "render_fps": 10}  # type: ignore[misc]

    def __init__(
        self,
        task: TaskDefinition | str,
        vehicle: VehicleLike | None = None,
        *,
        reward: Any = None,
        extra_rewards: Sequence[RewardTerm] = (),
        settings: Settings | None = None,
        level: str | None = None,
        perturb: str | Sequence[str] | None = None,
        privileged: str | Sequence[str] | None = None,
        render_mode: str | None = None,
        record: bool = False,
        **keywords: Unpack[SettingsKeywords],
    ) -> None:
        """Check and compose.

        Args:
            task: the id of a registered task, or a definition.
            vehicle: None for the task's own.
            reward: a dictionary of weights of the reward's terms, and of what else shapes it, that are not the default.
            extra_rewards: terms that are added to it.
            settings: what is simulated, as an object; or else
            level: of difficulty, one of the task's `levels`: stands for keywords, over which those that are given win.
            perturb: what does not go as planned, by name, one or several of `dq_marine.envs.PERTURBATIONS`:
                stands for keywords, over which those that are given win, and which win over the level's.
            privileged: what of "current", "vehicle" and "truth" a part of the observation shows: for critics.
            keywords: those of `Settings`, with the task's own defaults, and the task's own keywords.
            render_mode: None, "human" (live page) or "rgb_array" (pictures).
            record: keep the episode for `save_html`.

        Raises:
            InvalidInputError: a value is wrong, or a keyword unknown.
            VehicleFileError: the vehicle file is wrong.

        Warns:
            UnsuitableVehicleWarning: the task cannot be done with this vehicle.
        """
        of_task = (reward, extra_rewards, settings, level, perturb, privileged)
        self._prepare(task, vehicle, *of_task, dict(keywords))
        self.render_mode = checked_render_mode(render_mode, self.metadata["render_modes"])
        self.record = bool(record)
        self.metadata = {**self.metadata, "render_fps": 1.0 / self.control_period}  # type: ignore[misc]
        self._view = EpisodeView(self)
        self.action_space = gym.spaces.Box(-1.0, 1.0, (len(self.action_mapping.places),), np.float32)
        self.observation_space = observation_space(self.observation_bound, self.observation_places)
        self.fallback_substeps = 0
        self.refusal: dict[str, Any] | None = None
        self._episode: Episode | None = None

    # Gymnasium

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start an episode.

        Args:
            seed: of the random draws; an episode follows from it bit for bit.
            options: what not to draw: any of `START_OPTIONS` and of the task's own options, in NED and SI units.

        Returns:
            The observation, and info.

        Raises:
            InvalidInputError: an option is unknown or wrong; the episode in progress is untouched.
        """
        chosen = self.checked_options(options)
        parameters = self.episode_parameters(chosen)
        super().reset(seed=seed)
        number = self.pool.drawn(self.np_random)
        parameters = self.pool.fitted(parameters, number)
        uniforms = tuple(self.np_random.random(beginning_draws(self.task)).tolist())
        drawn = make_draw(self.scene.composition, self.task)(parameters, self.current_draw, uniforms)
        self._episode = self._new_episode(parameters, as_chosen(drawn, chosen), number)
        if self.time_varying:
            self._episode.clock = CLOCK_SPAN * self.np_random.random()
        self.refusal = None
        self._view.begin(self)
        return self.observation, self.info

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
        episode = self._episode or self._running("step")
        step = self._step
        whole, outcome = self._advance(episode, action, self.np_random)
        status, completed, fallbacks, residual_squared, reward, terminated = outcome
        episode.action = whole
        episode.periods += 1
        if fallbacks:
            self.fallback_substeps += fallbacks
        if status != ACCEPTED:
            velocity = self.motion.velocity
            spin, speed = dot(velocity.angular, velocity.angular), dot(velocity.linear, velocity.linear)
            self.refusal = integration_report(
                self.scene.step, status, completed, residual_squared, spin, speed
            )
        elif self.refusal is not None:
            self.refusal = None
        if self._view.wants_frames:
            self._view.show(self)
        info = step.infos.of(episode, status != ACCEPTED, fallbacks)
        return as_shown(episode.observation, step.observation_places), reward, terminated != 0.0, False, info

    def foreseen(self, action: Action) -> Motion:
        """Return the motion at the end of the control period that an action would be held for; nothing is changed.

        Raises:
            InvalidInputError: the action has a wrong shape or a NaN or infinity.
            ResetNeeded: before the first reset.
        """
        episode = Episode(**self._running("foreseen").to_dict())
        self._advance(episode, action, copy.deepcopy(self.np_random))
        return self._motion(self._unpacked(episode.parameters), episode.body)

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

    # State

    @property
    def observation(self) -> Observation:
        """What the last `reset` or `step` returned."""
        return as_shown(self._running("observation").observation, self.observation_places)

    @property
    def info(self) -> dict[str, Any]:
        """What `reset` says of the episode as it is now."""
        return self._step.infos.of(self._running("info"), False, 0)

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

    @property
    def velocity_through_water(self) -> NDArray[np.float64]:
        """Linear velocity relative to the water where the vehicle is, in the body frame [m/s], shape (3,)."""
        inertia = self._parameters.inertia
        return np.array(twist_from_momentum(inertia, self._running("velocity").body.momentum).linear)

    @property
    def measured(self) -> dict[str, float]:
        """Metrics and terms of the reward at the end of the last control period, by the names of `info`."""
        report = self._running("measured").report
        return dict(zip(self.report_names, report.tolist(), strict=False))

    def set_current(self, current_ned: Sequence[float]) -> None:
        """Let the water move otherwise from now on; the vehicle keeps its velocity over ground.

        Args:
            current_ned: velocity of the water [m/s], shape (3,).

        Raises:
            InvalidInputError: the water is too fast, or the environment was made without a current, or with one that
                changes by itself or over depth; nothing is changed.
            ResetNeeded: before the first reset.
        """
        turn_current(self._running("set_current"), self.scene, self._parameters, current_ned)

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
            InvalidInputError: entries are missing, unknown, of the wrong size, or not what an episode of this
                environment can have; nothing is changed.
        """
        check_entries(state)
        number = self.pool.checked_number(state["vehicle"])
        parameters = self.pool.fitted(self.episode_parameters({}), number)
        template = self._new_episode(parameters, self._blank_start(), number)
        episode = restored_episode(template, self.pool.parameters[number], state)
        if not self.observation_space.contains(as_shown(episode.observation, self.observation_places)):
            raise InvalidInputError("state['observation'] is beyond the observation space")
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

    def snapshot(self) -> Snapshot:
        """Return what a viewer draws now."""
        episode, of_step = self._running("snapshot"), self._parameters
        motion = self._motion(of_step, episode.body)
        parameters, layers = parameters_of(self).task, memory_layers(self)
        memory = layers[-1]
        goal = self.definition.goal(parameters, memory)
        return Snapshot(
            time=self.time,
            position_ned=np.array(motion.position_ned),
            quaternion_body_to_ned=np.array(motion.attitude),
            wrench_body=self.action_mapping.wrench_body(self.flown_vehicle, of_step, episode),
            thrusts=self.action_mapping.thrusts(self.flown_vehicle, of_step, episode),
            current_ned=episode.current_ned,
            wind_ned=self.wind_ned,
            goal_position_ned=None if goal is None else np.array(goal.position_ned),
            goal_quaternion_body_to_ned=None if goal is None else np.array(goal.attitude),
            things=(*self.solid_things, *self.definition.scenery(parameters, memory)),
            beams=beams_told(self.definition.beams(parameters, memory), layers),
            sea=self.sea,
            sea_start=episode.clock,
        )

    @property
    def collided(self) -> bool | None:
        """Whether the vehicle has hit something in this episode; None of a task with nothing to hit."""
        own = self.definition.collided
        return None if own is None else bool(own(parameters_of(self).task, task_memory(self)))

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Compile again (from the cache on disk) and start without a window."""
        super().__setstate__(state)
        self._view = EpisodeView(self)

    # Inside

    def _running(self, what: str) -> Episode:
        if self._episode is None:
            raise ResetNeeded(f"{what} was asked for before reset(); call reset() first")
        return self._episode

    def _advance(
        self, episode: Episode, action: Action, random: np.random.Generator
    ) -> tuple[NDArray[np.float64], tuple[Any, ...]]:
        """Advance an episode by a control period; return the action as compiled code takes it, and what came of it.

        Raises:
            InvalidInputError: the action has a wrong shape or a NaN or infinity; nothing is changed.
        """
        step = self._step
        whole = whole_action(step.action_mapping, action)
        uniforms = drawn_uniforms(random, step.draws, whole) if step.draws else NO_UNIFORMS
        outcome = step.compiled(
            episode.parameters,
            episode.episode_parameters,
            episode.state,
            episode.memory,
            whole,
            episode.observation,
            episode.report,
            episode.periods * step.duration + episode.clock,
            step.substeps,
            uniforms,
        )
        if outcome[0] == ACTION_NOT_FINITE:
            raise InvalidInputError(
                f"action = {np.asarray(action).tolist()} is not finite; give finite numbers"
            )
        return whole, outcome

    def _new_episode(self, parameters: EpisodeParameters, drawn: Drawn, number: int = 0) -> Episode:
        parts = (self.scene.composition, self.task, self.pool.parameters[number], parameters, drawn)
        return begun_episode(*parts, number, self.action_mapping.size)

    @cached_property
    def _unpacked(self) -> Unpacker:
        return Unpacker(self.base_parameters)

    @property
    def _parameters(self) -> StepParameters:
        """The numbers of the step of the episode in progress, its water included."""
        return self._unpacked(self._running("the parameters").parameters)  # type: ignore[no-any-return]
