"""All that the future of an episode depends on, apart from the random generator."""

from __future__ import annotations

import copy
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.packing import unpack
from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import AT_REST, BodyState

COUNTS = ("periods", "vehicle")
"""Entries of an episode that are whole numbers."""


@dataclass
class Episode:
    """The arrays that a compiled control period reads and changes.

    Attributes:
        parameters: of the step, packed.
        episode_parameters: `task.episode.EpisodeParameters`, packed.
        state: pose and momentum, shape (14,).
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
        return unpack(AT_REST, self.state)  # type: ignore[no-any-return]

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

    def restored(self, saved: dict[str, Any]) -> Episode:
        """Return the episode saved by `to_dict`, whose arrays must have the sizes of this one's.

        Raises:
            InvalidInputError: an entry is missing, unknown, of another size or not finite.
        """
        own = self.to_dict()
        if set(saved) != set(own):
            raise InvalidInputError(f"the state has entries {sorted(saved)}; it needs {sorted(own)}")
        periods, vehicle = (int(saved[name]) for name in COUNTS)
        clock = finite_number("state['clock']", saved["clock"])
        arrays = {
            name: finite_array(f"state[{name!r}]", saved[name], value.size).astype(value.dtype)
            for name, value in own.items()
            if isinstance(value, np.ndarray)
        }
        return Episode(**arrays, periods=periods, vehicle=vehicle, clock=clock)


def restored_generator(saved: Any) -> np.random.Generator:
    """Return a generator at the state of a saved one.

    Raises:
        InvalidInputError: it is no such state.
    """
    random = np.random.default_rng()
    try:
        random.bit_generator.state = copy.deepcopy(saved)
    except (TypeError, ValueError, KeyError) as error:
        raise InvalidInputError(f"state['random'] is not a generator's state: {error}") from error
    return random
