"""Many environments at once: Gymnasium's vector interface to control periods compiled for SIMD lanes and threads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from dq_marine.backend.simd.lanes import lanes_of
from dq_marine.backend.simd.period import (
    compiled_begin,
    compiled_period,
    renew_at_next_step,
    renew_at_same_step,
)
from dq_marine.backend.workers import Workers
from dq_marine.checks import positive_integer, shown
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.observation import as_shown
from dq_marine.envs.core.registry import task_named
from dq_marine.envs.core.view import open_page, shape_of
from dq_marine.envs.vector.lane_memory import FALLBACKS, LaneMemory
from dq_marine.envs.vector.lane_singles import LaneSingles, made_singles
from dq_marine.envs.vector.vector_infos import VectorInfos
from dq_marine.envs.vector.vector_options import (
    CHOSEN_SLICES,
    checked_actions,
    checked_index,
    checked_mask,
    checked_mode,
    checked_seeds,
    chosen_rows,
    split_options,
)
from dq_marine.errors import InvalidInputError
from dq_marine.simulation.settings import VehicleLike

if TYPE_CHECKING:
    from dq_marine.envs.vector.lane_watch import LaneWatch

Observations = NDArray[np.float32] | dict[str, NDArray[np.float32]]
Flags = NDArray[np.bool_]
StepResult = tuple[Observations, NDArray[np.float64], Flags, Flags, dict[str, Any]]

RENEWALS = {
    AutoresetMode.NEXT_STEP: renew_at_next_step,
    AutoresetMode.SAME_STEP: renew_at_same_step,
    AutoresetMode.DISABLED: renew_at_next_step,
}


class MarineVectorEnv(VectorEnv[Observations, NDArray[Any], NDArray[Any]]):
    """n environments of one task, stepped together. `gym.make_vec` makes one.

    Environment i behaves like the single environment seeded with its seed: to the last bit with strict arithmetic in
    double precision.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["human", "rgb_array"], "render_fps": 10}  # type: ignore[misc]

    def __init__(
        self,
        task: TaskDefinition | str,
        num_envs: int = 1,
        *,
        vehicle: VehicleLike | Sequence[VehicleLike] | None = None,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        precision: str = "float64",
        arithmetic: str = "strict",
        copy: bool = True,
        **single_arguments: Any,
    ) -> None:
        """Check, lay out and compose.

        Args:
            task: the id of a registered task, or a definition.
            num_envs: how many.
            vehicle: as for the single environment; or a list of them, one for each, which may differ in every number.
            max_episode_steps: control periods after which an episode is truncated; None for the task's own number.
            autoreset_mode: what follows the end of an episode, see Gymnasium's `AutoresetMode`.
            threads: None for as many as pay: up to all cores that the process may use.
            precision: "float64", or "float32", which is faster.
            arithmetic: "strict", with the bits of the single environment, or "fast", with other rounding errors.
            copy: whether what `step` returns is the caller's own; if not, the next step overwrites it.
            single_arguments: the single environment's other arguments.

        Raises:
            InvalidInputError: a value is wrong, something is to be recorded, or the vehicles differ in what is
                to be computed.
            VehicleFileError: a vehicle file is wrong.
        """
        self.num_envs = positive_integer("num_envs", num_envs)
        definition = task_named(task)
        most = definition.max_episode_steps if max_episode_steps is None else max_episode_steps
        self.max_episode_steps = positive_integer("max_episode_steps", most)
        self.autoreset_mode = checked_mode(autoreset_mode)
        singles = made_singles(definition, vehicle, self.num_envs, single_arguments)
        single = singles[0]
        keeps_ends = self.autoreset_mode is AutoresetMode.SAME_STEP
        lanes = lanes_of(precision, arithmetic)
        self._lanes = LaneSingles(singles, self.num_envs, lanes, keeps_ends=keeps_ends)
        self._threads = threads
        self._workers = Workers(threads, len(self._memory.arrays.states))
        self._compile()

        self.render_mode = single.render_mode
        self.metadata = {**single.metadata, "autoreset_mode": self.autoreset_mode}  # type: ignore[misc]
        self.single_observation_space = single.observation_space
        self.single_action_space = single.action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)

        self.copy = bool(copy)
        self._infos = VectorInfos(self, self._lanes)
        self._begun = False
        self._watch: LaneWatch | None = None

    # Gymnasium

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Start an episode in every environment, or in those of the option `reset_mask`.

        Args:
            seed: a number s seeds environment i with s + i; or one for each. None goes on with the generators.
            options: `reset_mask`, bools of shape (num_envs,); and what not to draw, as for the single environment: one
                for all, or with a row for each.

        Raises:
            InvalidInputError: a value is wrong; nothing is changed.
        """
        seeds = checked_seeds(seed, self.num_envs)
        wanted = checked_mask(options, self.num_envs)
        for_all, for_each = split_options(
            options, self.num_envs, self.single.checked_options, self.single.definition.options
        )
        if not self._begun and not wanted.all():
            raise InvalidInputError("options['reset_mask'] leaves out environments that were never reset")
        self._lanes.seed(seeds, np.flatnonzero(wanted).tolist())
        self._begin(wanted, for_all, for_each)
        self._begun = True
        if self.render_mode == "human" and self._watch is None:
            self.watch(0)
        return self._observations(), self._infos.at_reset(wanted)

    def step(self, actions: NDArray[Any]) -> StepResult:
        """Hold an action in every environment for one control period.

        Args:
            actions: shape (num_envs, actions), as for the single environment; they saturate beyond [-1, 1].

        Returns:
            Observations, rewards, terminations, truncations, infos, as Gymnasium's `SyncVectorEnv` has them.

        Raises:
            InvalidInputError: the shape is wrong, or there is a NaN or an infinity; nothing is changed.
            ResetNeeded: before the first reset, or where autoreset is disabled and an episode has ended.
        """
        self._need_reset("step")
        arrays = self._memory.arrays
        if self.autoreset_mode is AutoresetMode.DISABLED and arrays.ended[: self.num_envs].any():
            waiting = int(arrays.ended.argmax())
            raise ResetNeeded(
                f"the episode of environment {waiting} has ended and autoreset is disabled; reset it with "
                "options={'reset_mask': ...}"
            )
        self._take(actions)
        self._infos.before_step()
        self._workers.run(
            self._period,
            arrays,
            self._lanes.actions,
            self.single.control_period,
            self.single.substeps,
            float(self.max_episode_steps),
        )
        fallbacks = self._memory.outcome(FALLBACKS).astype(np.int64)
        self._lanes.fallbacks += fallbacks
        if self._watch is not None:
            index = self._watch.index
            self._watch.offer(lambda: self.at(index).snapshot())
        terminated, truncated = arrays.terminated[: self.num_envs], arrays.truncated[: self.num_envs]
        return (
            self._observations(),
            self._given(arrays.rewards[: self.num_envs]),
            self._given(terminated),
            self._given(truncated),
            self._infos.at_step(terminated | truncated, fallbacks),
        )

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Return a picture of every environment in mode "rgb_array", about 50 ms each; None otherwise.

        In mode "human" a page follows the first environment from `reset` on; see `watch`.

        Raises:
            ResetNeeded: before the first reset.
            MissingDependencyError: meshcat or a Chromium is not installed.
        """
        self._need_reset("render")
        if self.render_mode != "rgb_array":
            return None
        return tuple(self.at(index).render_still() for index in range(self.num_envs))

    def watch(self, index: int | None) -> str | None:
        """Open a page that follows one environment while the batch runs, at its own pace; None closes it.

        Args:
            index: of the environment.

        Returns:
            The page's address, which only this computer can reach.

        Raises:
            InvalidInputError: there is no such environment.
            MissingDependencyError: meshcat is not installed.
        """
        if index is not None:
            index = checked_index(index, self.num_envs)
        if self._watch is not None:
            self._watch.close()
            self._watch = None
        if index is None:
            return None
        from dq_marine.envs.vector.lane_watch import LaneWatch  # here: it imports the viewer

        vehicle = self._lanes.single(index).vehicle
        self._watch = LaneWatch(index, lambda: open_page(shape_of(vehicle), vehicle.name))
        return self._watch.url

    def close_extras(self, **kwargs: Any) -> None:
        """End threads and windows."""
        self.watch(None)
        self._workers.close()
        self.single.close()

    # Environments one by one

    def at(self, index: int) -> MarineEnv:
        """Return one environment as a single one, at the present state of its episode.

        What is done to it does not change the batch. The next call may give the same object.

        Raises:
            ResetNeeded: before the first reset.
        """
        self._need_reset("an environment")
        return self._lanes.at(checked_index(index, self.num_envs))

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Call a method of every environment, or get an attribute; what the call changes is kept."""
        return tuple(self.call_at(index, name, *args, **kwargs) for index in range(self.num_envs))

    def call_at(self, index: int, name: str, *args: Any, **kwargs: Any) -> Any:
        """Call a method of one environment, or get an attribute; what the call changes is kept."""
        value = self.attribute_at(index, name)
        if not callable(value) or not self._begun:
            return value(*args, **kwargs) if callable(value) else value
        return self._lanes.call(index, name, *args, **kwargs)

    def attribute_at(self, index: int, name: str) -> Any:
        """Return an attribute of one environment."""
        return getattr(self.at(index) if self._begun else self._lanes.single(index), name)

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Return an attribute of every environment."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Set an attribute of every environment; episodes that begin later follow it.

        Numbers of the task that then differ between environments have to be laid out, and the step compiled, anew.

        Args:
            name: of the attribute.
            values: a list or tuple of one value for each environment, else one value for all.

        Raises:
            InvalidInputError: there is not one for each.
        """
        if not isinstance(name, str):
            raise InvalidInputError(f"name = {shown(name)}; give the name of an attribute")
        each = values if isinstance(values, list | tuple) else [values] * self.num_envs
        if len(each) != self.num_envs:
            raise InvalidInputError(f"{len(each)} values for {self.num_envs} environments; give one for each")
        if self._lanes.set_attribute(range(self.num_envs), name, each):
            self._compile()

    def set_attribute_at(self, indices: Sequence[int], name: str, value: Any) -> None:
        """Set an attribute of some environments to one value; see `set_attr`."""
        if self._lanes.set_attribute(indices, name, [value] * len(indices)):
            self._compile()

    @property
    def np_random_seed(self) -> tuple[int | None, ...]:  # type: ignore[override]
        """Seeds of the environments."""
        return tuple(self._lanes.seeds)

    @property  # type: ignore[misc]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """Generators at the state of the environments' own."""
        return self.get_attr("np_random")

    @property
    def single(self) -> MarineEnv:
        """A single environment that stands for all."""
        return self._lanes.first

    @property
    def fallback_substeps(self) -> int:
        """Of all integrator steps so far, those that plain Newton did not solve (see `integrator.drift`)."""
        return int(self._lanes.fallbacks.sum())

    @property
    def episodes_refused(self) -> int:
        """Episodes so far that ended because the integrator refused a step."""
        return self._infos.episodes_refused

    @property
    def refusals(self) -> dict[int, dict[str, Any]]:
        """Why the integrator refused the last step, by the index of the environment."""
        return self._infos.refusals

    @property
    def threads(self) -> int:
        """Number of threads in use."""
        return self._workers.threads

    @property
    def bytes_per_environment(self) -> float:
        """Memory held for each environment."""
        return self._memory.bytes_per_environment + self._lanes.actions.nbytes / self.num_envs

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what cannot travel: compiled code and threads."""
        return {name: value for name, value in self.__dict__.items() if name not in _NOT_CARRIED}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Compile again, from the cache on disk."""
        self.__dict__.update(state)
        self._workers = Workers(self._threads, len(self._memory.arrays.states))
        self._watch = None
        self._compile()

    @property
    def _memory(self) -> LaneMemory:
        return self._lanes.memory

    def _compile(self) -> None:
        parts = (self.single.scene.composition, self.single.task, self._memory.layout)
        self._period = compiled_period(*parts, RENEWALS[self.autoreset_mode])
        self._begin_compiled = compiled_begin(*parts)

    def _begin(self, wanted: Flags, for_all: dict[str, Any], for_each: dict[str, Any]) -> None:
        """Begin episodes in the wanted environments, drawn but for what was chosen."""
        arrays, n = self._memory.arrays, self.num_envs
        mask = np.zeros(self._memory.bodies, np.bool_)
        mask[:n] = wanted
        mask[n:] = not self._begun
        self._memory.reset_episodes(mask)
        if {*for_all, *for_each} - set(CHOSEN_SLICES):
            self._memory.set_episodes(wanted, self._lanes.episodes(for_all, for_each))
        chosen = chosen_rows(for_all, for_each, n, self._memory.bodies)
        self._workers.run(self._begin_compiled, arrays._replace(chosen=chosen), mask)
        arrays.periods[mask] = 0.0
        arrays.ended[mask] = False

    def _take(self, actions: NDArray[Any]) -> None:
        """Check the actions and put them where compiled code takes them."""
        places, taken = self.single.action_mapping.places, self._lanes.actions
        given = checked_actions(actions, (self.num_envs, len(places)))
        if given.shape == taken.shape:  # a plain copy, which is several times as fast
            taken[:] = given
        else:
            taken[:, places] = given

    def _observations(self) -> Observations:
        flat, places = self._memory.arrays.observations[: self.num_envs], self.single.observation_places
        return as_shown(flat, places) if self.copy or places is not None else flat

    def _given(self, array: NDArray[Any]) -> NDArray[Any]:
        return array.copy() if self.copy else array

    def _need_reset(self, what: str) -> None:
        if not self._begun:
            raise ResetNeeded(f"{what} was asked for before reset(); call reset() first")


_NOT_CARRIED = ("_period", "_begin_compiled", "_workers", "_watch")
