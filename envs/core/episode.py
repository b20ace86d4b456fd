"""All that the future of an episode depends on, apart from the random generator."""

from __future__ import annotations

import copy
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.packing import pack, unpack
from dq_marine.checks import finite_array, finite_number, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import AT_REST, BODY_NUMBERS, BodyState
from dq_marine.integrator.step import StepParameters, in_water
from dq_marine.simulation.states import check_size, check_states
from dq_marine.task.start import CLOCK_SPAN

SINGLE_PRECISION = 1e-6
"""By which numbers may differ, relative, that went through environments of single precision."""


@dataclass
class Episode:
    """The arrays that a compiled control period reads and changes.

    Attributes:
        parameters: of the step, packed.
        episode_parameters: `task.episode.EpisodeParameters`, packed.
        state: pose, momentum and fluid memory, shape (14 + m,).
        memory: the task's memory, packed.
        action: of the last control period as compiled code takes it, normalised: of six axes, or of all channels.
        observation: at its end.
        report: `task.episode.Report` at its end, and the current in NED [m/s], packed.
        periods: control periods since reset.
        vehicle: number of the vehicle in the environment's pool; 0 without one.
        clock: time at reset [s], drawn where the weather changes, else 0.
    """

    parameters: NDArray[np.float64]
    episode_parameters: NDArray[np.float64]
    state: NDArray[np.float64]
    memory: NDArray[np.float64]
    action: NDArray[np.float64]
    observation: NDArray[np.float32]
    report: NDArray[np.float64]
    periods: int = 0
    vehicle: int = 0
    clock: float = 0.0

    @property
    def body(self) -> BodyState:
        """Pose and momentum as pure functions have them."""
        return unpack(AT_REST, self.state[: BODY_NUMBERS - 1])  # type: ignore[no-any-return]

    @property
    def current_ned(self) -> NDArray[np.float64]:
        """Velocity of the water where the vehicle is [m/s], shape (3,)."""
        return self.report[-3:].copy()

    def to_dict(self) -> dict[str, Any]:
        """Return copies of everything."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {
            name: value.copy() if isinstance(value, np.ndarray) else value for name, value in values.items()
        }


def restored_episode(template: Episode, like: StepParameters, saved: dict[str, Any]) -> Episode:
    """Return the episode saved by `Episode.to_dict`.

    Args:
        template: an episode of the environment that is to go on with it, of the same vehicle.
        like: the step's parameters in that environment; a saved episode's differ in their water only.
        saved: what comes in from outside.

    Raises:
        InvalidInputError: an array is of another size, not finite, or not what an episode can have.
    """
    episode = Episode(
        **_arrays(template, saved),
        periods=whole_number("state['periods']", saved["periods"], least=0),
        vehicle=template.vehicle,
        clock=finite_number("state['clock']", saved["clock"], least=0.0, most=CLOCK_SPAN),
    )
    check_states("state['state']", episode.state)
    if np.abs(episode.action).max(initial=0.0) > 1.0:
        raise InvalidInputError(f"state['action'] = {episode.action.tolist()} is beyond [-1, 1]")
    in_own_water = in_water(like, unpack(like, episode.parameters).water)
    if not np.allclose(pack(in_own_water), episode.parameters, rtol=SINGLE_PRECISION, atol=0.0):
        raise InvalidInputError(
            "state['parameters'] are of another vehicle or scene; restore it in one made alike"
        )
    positive = template.episode_parameters > 0.0
    lost = np.flatnonzero(positive & (episode.episode_parameters <= 0.0))
    if lost.size:
        raise InvalidInputError(
            f"state['episode_parameters'][{lost[0]}] = {episode.episode_parameters[lost[0]]:g} must be positive, as "
            f"{template.episode_parameters[lost[0]]:g} is, which it has in this environment"
        )
    return episode


def check_entries(state: Any) -> None:
    """Check that a saved state has the entries that `MarineEnv.get_state` gives it.

    Raises:
        InvalidInputError: it is no dictionary, or an entry is missing or unknown.
    """
    needed = {*(field.name for field in fields(Episode)), "random"}
    if not isinstance(state, dict) or set(state) != needed:
        found = sorted(map(shown, state)) if isinstance(state, dict) else shown(state)
        raise InvalidInputError(
            f"the state is not what get_state() returned: it has {found}, and needs the entries {sorted(needed)}"
        )


def _arrays(template: Episode, saved: dict[str, Any]) -> dict[str, NDArray[Any]]:
    """Return the saved arrays, each in size and type like the template's, and of numbers that can be computed with."""
    arrays = {}
    for name, own in template.to_dict().items():
        if isinstance(own, np.ndarray):
            given = finite_array(f"state[{name!r}]", saved[name], own.size)
            check_size(f"state[{name!r}]", given)
            arrays[name] = given.astype(own.dtype)
    return arrays


def restored_generator(saved: Any) -> np.random.Generator:
    """Return a generator at the state of a saved one.

    Raises:
        InvalidInputError: it is no such state.
    """
    random = np.random.default_rng()
    try:
        random.bit_generator.state = copy.deepcopy(saved)
    except Exception as error:  # NumPy takes what it is given apart without checking it first
        raise InvalidInputError(f"state['random'] is not a generator's state: {error}") from error
    return random
