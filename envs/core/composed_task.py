"""What an environment is made of: a task, what is simulated, and their formulas joined and compiled."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.control_period import compiled_control_period
from dq_marine.backend.packing import pack, structure_type, unpack
from dq_marine.checks import finite_number, shown
from dq_marine.envs.core.action_mapping import ActionMapping, action_mapping_of
from dq_marine.envs.core.currents import check_current
from dq_marine.envs.core.definition import EpisodeContext, Observed, TaskDefinition
from dq_marine.envs.core.goals import check_goals
from dq_marine.envs.core.infos import Infos
from dq_marine.envs.core.observation import Places, places_of
from dq_marine.envs.core.observed import ages_shown
from dq_marine.envs.core.perturbations import perturbed
from dq_marine.envs.core.privileged import checked_privileged, privileged_numbers, told_pool
from dq_marine.envs.core.registry import arrived, task_named, tasks_suiting, travelling
from dq_marine.envs.core.rewards import checked_extra_rewards
from dq_marine.envs.core.start import at_origin, checked_options
from dq_marine.envs.core.vehicle_pool import prepared_pool, wrench_limits_of
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.integrator.step import StepParameters, make_motion
from dq_marine.physics.current.build import draw_of
from dq_marine.physics.waves.loads import WaveLoads
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.wind.build import Wind
from dq_marine.simulation.settings import Settings, VehicleLike
from dq_marine.task.delays import Delays, with_delays
from dq_marine.task.episode import EpisodeParameters, episode_task
from dq_marine.task.period import draws_of_period
from dq_marine.task.privileged import revealing
from dq_marine.task.protocol import RewardTerm
from dq_marine.task.ranging import Schedule, with_schedule
from dq_marine.task.sensors.build import nested_numbers, shown_numbers
from dq_marine.task.sensors.observing import with_sensors
from dq_marine.task.start import Drawn, make_beginning
from dq_marine.task.things import Thing
from dq_marine.vehicles import Vehicle

SETTINGS = frozenset(one.name for one in fields(Settings))


@dataclass(frozen=True, slots=True)
class PeriodStep:
    """What each step of an environment takes, in one place.

    An environment has the keywords of its task as attributes; the `__getattr__` that finds them makes all of its
    attributes twice as slow, and a step would look up a dozen.

    Attributes:
        compiled: see `compiled_control_period`.
        duration: of a control period [s].
        substeps: in it.
        draws: numbers that it takes from the random generator.
        action_mapping: what an action does.
        observation_places: where the parts of an observation are.
        infos: what is said of it.
    """

    compiled: Callable[..., Any]
    duration: float
    substeps: int
    draws: int
    action_mapping: ActionMapping
    observation_places: Places | None
    infos: Infos


class ComposedTask:
    """A task joined with a vehicle, its surroundings, sensors and what drives it. `MarineEnv` runs it.

    The keywords of the task are attributes, too; what is set there holds from the next episode on.

    Attributes:
        definition: of the task.
        settings: what is simulated.
        task_settings: the task's own keywords.
        reward_weights: of its reward.
        extra_rewards: terms that were added to it.
        privileged: names of what a part of the observation shows that only the simulator knows.
        pool: the vehicles that episodes fly: that of the settings, or those drawn from it.
        scene: what is integrated, with the pool's first vehicle.
        current_draw: what the current of an episode is drawn from.
        observation_places: where the parts of an observation are among its numbers; None where it has no parts.
        time_varying: whether the weather changes, so that episodes begin at a time that is drawn.
        task: the formulas, for these actions and sensors.
        action_mapping: what an action does.
    """

    definition: TaskDefinition
    settings: Settings
    task_settings: Any
    reward_weights: Any
    extra_rewards: tuple[RewardTerm, ...]
    privileged: tuple[str, ...]

    def _prepare(
        self,
        task: TaskDefinition | str,
        vehicle: VehicleLike | None,
        reward: Any,
        extra_rewards: Sequence[RewardTerm],
        settings: Settings | None,
        level: str | None,
        perturb: str | Sequence[str] | None,
        privileged: str | Sequence[str] | None,
        keywords: dict[str, Any],
    ) -> None:
        """Check everything and prepare the vehicles; see `MarineEnv` for the arguments."""
        definition = task_named(task)
        asked = dict(keywords) if vehicle is None else {**keywords, "vehicle": vehicle}
        given = definition.at_level(level, perturbed(definition, perturb, asked))
        of_task = {name: given.pop(name) for name in list(given) if name not in SETTINGS}
        if settings is not None and given:
            raise InvalidInputError(f"settings and {sorted(given)} are given; give the one or the others")
        if settings is not None and not isinstance(settings, Settings):
            raise InvalidInputError(f"settings = {shown(settings)}; give a dq_marine.Settings")
        chosen = settings or _with_defaults(definition, given)
        finite_number("control_period", chosen.control_period, above=0.0)
        own = definition.checked_settings(of_task, chosen.flown)
        weights = definition.checked_weights(reward)
        _check_parameters(
            definition, definition.parameters(own, EpisodeContext(chosen.flown, chosen.control_period, {}))
        )
        check_goals(definition, definition.observations(own, chosen.flown))
        definition.schedule(own, chosen.control_period)
        _check_delays(definition, chosen)
        self.__dict__.update(
            definition=definition,
            settings=chosen,
            task_settings=own,
            reward_weights=weights,
            extra_rewards=checked_extra_rewards(extra_rewards, definition),
            privileged=checked_privileged(privileged),
        )
        _warn_if_unsuitable(definition, chosen.flown)
        prepared = prepared_pool(chosen)
        self.pool = told_pool(prepared, chosen) if "vehicle" in self.privileged else prepared
        self.scene = self.pool.scene
        self.current_draw = draw_of(self.scene.current)
        self.time_varying = any(part.changes for part in self.scene.weather)
        self._compose()

    @property
    def sea(self) -> Sea | None:
        """The waves of the scene's weather, under its gravity; None for a calm surface."""
        seas = [part.sea for part in self.scene.weather if isinstance(part, WaveLoads)]
        return seas[0].in_gravity(self.scene.vehicle.gravity) if seas else None

    @functools.cached_property
    def solid_things(self) -> tuple[Thing, ...]:
        """The solids of the scene, as a viewer draws them."""
        from dq_marine.viewer.solids import things_of  # here: what is not looked at is not drawn

        return things_of(self.scene.solids, self.vehicle.dimensions.length)

    @property
    def wind_ned(self) -> NDArray[np.float64] | None:
        """Velocity of the mean wind of the scene's weather, shape (3,) [m/s]; None without wind."""
        winds = [part for part in self.scene.weather if isinstance(part, Wind)]
        return winds[0].mean_ned if winds else None

    @property
    def vehicle(self) -> Vehicle:
        """The nominal vehicle."""
        return self.settings.flown

    @property
    def control_period(self) -> float:
        """Time between actions [s]."""
        return self.settings.control_period

    @property
    def substeps(self) -> int:
        """Integrator steps in a control period."""
        return self.settings.substeps

    @property
    def action_names(self) -> tuple[str, ...]:
        """What each number of an action drives: axes such as "surge", or channels of the vehicle's actuators."""
        return self.action_mapping.names

    @property
    def observations(self) -> tuple[Observed, ...]:
        """What an observation consists of, in its order, but for what only the simulator knows."""
        own = self.definition.observations(self.task_settings, self.vehicle)
        ages = () if self.ping_schedule is None else (ages_shown(self.ping_schedule),)
        return (*own, *ages, *(Observed(*shown) for shown in shown_numbers(self.settings.sensor_list)))

    @property
    def privileged_observations(self) -> tuple[Observed, ...]:
        """What the part "privileged" of an observation consists of, in its order; nothing unless it was asked for."""
        return privileged_numbers(self)

    @property
    def ping_schedule(self) -> Schedule | None:
        """When the task's range sensor pings and tells; None for always and at once, or without one."""
        return self.definition.schedule(self.task_settings, self.control_period)

    @property
    def observation_bound(self) -> NDArray[np.float32]:
        """Largest magnitude of each observed number."""
        parts = (*self.observations, *self.privileged_observations)
        return np.array([one.bound for one in parts for _ in range(one.size)], dtype=np.float32)

    @property
    def report_names(self) -> tuple[str, ...]:
        """What the numbers of `Episode.report` are called in `info`, up to the success."""
        return (*self.definition.metric_names, *(f"reward/{name}" for name in self.reward_names))

    @property
    def reward_names(self) -> tuple[str, ...]:
        """Names of all terms of the reward, added ones included."""
        return (*self.definition.reward_names, *(term.name for term in self.extra_rewards))

    @property
    def base_parameters(self) -> StepParameters:
        """The numbers of the step of the pool's first vehicle."""
        return self.pool.parameters[0]

    def episode_parameters(self, options: dict[str, NDArray[np.float64]]) -> EpisodeParameters:
        """Return the numbers of an episode with the given options, for the nominal vehicle."""
        context = EpisodeContext(self.vehicle, self.control_period, options)
        return EpisodeParameters(
            task=self.definition.parameters(self.task_settings, context),
            weights=self.reward_weights,
            extra_weights=tuple(float(term.weight) for term in self.extra_rewards),
            wrench_limits=wrench_limits_of(self.vehicle),
            actions=float(len(self.action_mapping.places)),
            sensors=nested_numbers(self.settings.sensor_list, self.control_period, self.vehicle.gravity),
            vehicle=self.pool.told[
                0
            ],  # another one's where episodes fly different ones: see `VehiclePool.fitted`
        )

    @property
    def blank_memory(self) -> Any:
        """A memory at an episode's start, to tell its structure by."""
        drawn = self._blank_start()
        return self.task.initial_memory(self.episode_parameters({}).task, drawn.start, drawn.for_task)

    def checked_options(self, options: dict[str, Any] | None) -> dict[str, NDArray[np.float64]]:
        """Return reset's options as arrays.

        Raises:
            InvalidInputError: one is unknown or wrong.
        """
        return check_current(checked_options(options, self.definition.options, self.vehicle), self.scene)

    def __getattr__(self, name: str) -> Any:
        """Return a keyword of the task.

        Raises:
            AttributeError: there is no such attribute.
        """
        definition = self.__dict__.get("definition")
        if definition is not None and name in definition.keywords:
            return getattr(self.task_settings, name)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute, or a keyword of the task.

        Raises:
            InvalidInputError: the task refuses the value, or the keyword is `lasting`; nothing is changed.
        """
        if name in self.__dict__.get("definition", _NOTHING).keywords:
            if name in self.definition.lasting:
                raise InvalidInputError(
                    f"{name} holds as long as the environment does; make another one with {name}=..."
                )
            changed = replace(self.task_settings, **{name: value})
            self.__dict__["task_settings"] = self.definition.fitted(changed, self.vehicle)
        else:
            super().__setattr__(name, value)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what cannot travel: compiled code and open windows; registered tasks travel by name."""
        carried = {name: value for name, value in self.__dict__.items() if name not in _NOT_CARRIED}
        return carried | {"definition": travelling(self.definition)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Compile again (from the cache on disk) and start without a window."""
        self.__dict__.update(state | {"definition": arrived(state["definition"])})
        self._compose()

    def _compose(self) -> None:
        """Join the formulas and compile them; nothing of this travels."""
        delays = Delays(self.settings.action_delay, self.settings.observation_delay)
        self.action_mapping = action_mapping_of(self.scene, delays.action)
        functions = tuple(term.function for term in self.extra_rewards)
        own = episode_task(self.definition.task_for(self.task_settings), functions)
        whole = revealing(own, self.privileged) if self.privileged else own
        task = with_schedule(whole, self.ping_schedule) if self.ping_schedule else whole
        instruments = tuple(one.instrument for one in self.settings.sensor_list)
        sensed = with_sensors(task, instruments) if instruments else task
        self.task = driven = self.action_mapping.task(sensed)
        if any(delays):
            self.task = with_delays(driven, delays, self.action_mapping.size, self._blank_observation())
        self._motion = make_motion(self.scene.composition)
        self.observation_places = places_of((*self.observations, *self.privileged_observations))
        self._step = PeriodStep(
            compiled=self._compile(),
            duration=self.settings.control_period,
            substeps=self.settings.substeps,
            draws=sum(map(len, draws_of_period(self.scene.composition, self.task))),
            action_mapping=self.action_mapping,
            observation_places=self.observation_places,
            infos=Infos(self.report_names, self.pool.has_choice),
        )

    def _compile(self) -> Callable[..., Any]:
        return compiled_control_period(
            self.scene.composition,
            self.task,
            structure_type(self.base_parameters),
            structure_type(self.episode_parameters({})),
            structure_type(self.blank_memory),
        )

    def _blank_observation(self) -> Any:
        """Return an observation with zeros for its numbers, to tell its structure by."""
        parameters, drawn = self.episode_parameters({}), self._blank_start()
        begin = make_beginning(self.scene.composition, self.task)
        observation, _ = begin(self.base_parameters, parameters, drawn).observation
        return unpack(observation, np.zeros(pack(observation).size))

    def _blank_start(self) -> Drawn:
        return at_origin(self.task.draws, self.task.sensing.first_draws)


class _Nothing:
    keywords = ()


_NOTHING = _Nothing()
"""Stands for the definition while an environment is being made."""


_NOT_CARRIED = ("_step", "_motion", "_unpacked", "_view", "action_mapping", "task")


def _check_parameters(definition: TaskDefinition, parameters: Any) -> None:
    """Refuse parameters whose numbers have no names: environments in lanes tell by them what differs.

    Raises:
        InvalidInputError: they are no named tuple.
    """
    if not isinstance(parameters, tuple) or not hasattr(parameters, "_fields"):
        raise InvalidInputError(
            f"the parameters of {definition.id} are a {type(parameters).__name__}; return a NamedTuple of numbers"
        )


def _check_delays(definition: TaskDefinition, settings: Settings) -> None:
    """Refuse old observations where goals are judged by what is observed.

    Raises:
        InvalidInputError: they are, and observations are to be late.
    """
    if definition.has_goals and settings.observation_delay:
        raise InvalidInputError(
            f"observation_delay = {settings.observation_delay}, but {definition.id} has goals, and its reward at other "
            "goals is computed from what is observed of now; give 0"
        )


def _with_defaults(definition: TaskDefinition, given: dict[str, Any]) -> Settings:
    """Return settings with a task's own defaults for what is not given."""
    own = {"vehicle": definition.vehicle, "current": None, "substeps": definition.substeps}
    defaults = own | dict(definition.surroundings)
    chosen = Settings(**(defaults | given))
    if "control_period" in given:
        return chosen
    return replace(chosen, control_period=definition.period_for(chosen.flown))


def _warn_if_unsuitable(definition: TaskDefinition, vehicle: Vehicle) -> None:
    reason = definition.unsuitable(vehicle)
    if reason is not None:
        suiting = ", ".join(tasks_suiting(vehicle)) or "none of the registered tasks"
        warnings.warn(
            f"{definition.id} cannot be done with {vehicle.name}: {reason}. Tasks that suit it: {suiting}",
            UnsuitableVehicleWarning,
            stacklevel=3,
        )
