"""The part of an observation that only the simulator knows: which numbers it has, and of which vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from dq_marine.checks import shown
from dq_marine.envs.core.definition import PRIVILEGED, Observed
from dq_marine.envs.core.vehicle_pool import VehiclePool
from dq_marine.errors import InvalidInputError
from dq_marine.physics.current.formulas.uniform import STILL_WATER
from dq_marine.randomisation.differences import LARGEST_DIFFERENCE, Spreading, differences
from dq_marine.simulation.settings import Settings
from dq_marine.task.common import SPEED_BOUND

if TYPE_CHECKING:
    from dq_marine.envs.core.composed_task import ComposedTask

CURRENT = Observed(
    "current_body", "m/s", 3, SPEED_BOUND, "velocity of the water where the vehicle is", PRIVILEGED
)
"""What `dq_marine.task.privileged.current_in_body` gives."""


def checked_privileged(privileged: Any) -> bool:
    """Return whether the observation has a part that only the simulator knows.

    Raises:
        InvalidInputError: it is neither true nor false.
    """
    if not isinstance(privileged, bool | np.bool_):
        raise InvalidInputError(f"privileged = {shown(privileged)}; give True or False")
    return bool(privileged)


def told_pool(pool: VehiclePool, settings: Settings) -> VehiclePool:
    """Return a pool whose episodes know in what their vehicle is not the nominal one."""
    parts = _spreading(pool, settings)
    if not parts:
        return pool
    rows = np.concatenate([one.numbers for one in parts], axis=1)
    return pool.telling([tuple(row) for row in rows.tolist()])


def privileged_parts(env: ComposedTask) -> tuple[Observed, ...]:
    """Return what the part of an environment consists of, in the order of `dq_marine.task.privileged.revealing`.

    What the task itself observes stands there once more, as it is in truth, where the agent is told otherwise.
    """
    drawn = [
        Observed(one.name, one.unit, numbers.shape[1], LARGEST_DIFFERENCE, one.meaning, PRIVILEGED)
        for one, numbers in _spreading(env.pool, env.settings)
    ]
    own = env.definition.observations(env.task_settings, env.vehicle) if hides_truth(env) else ()
    true = [
        one._replace(name=f"true_{one.name}", meaning=f"true: {one.meaning}", part=PRIVILEGED) for one in own
    ]
    return (CURRENT, *drawn, *true)


def hides_truth(env: ComposedTask) -> bool:
    """Whether sensors, old observations or pings stand between what is observed and the true motion."""
    return bool(env.settings.sensor_list or env.settings.observation_delay or env.ping_schedule)


def hides_anything(env: ComposedTask) -> bool:
    """Whether the simulator knows more than the agent observes: moving water, other vehicles, or the true motion."""
    return env.scene.composition.water != STILL_WATER or env.pool.has_choice or hides_truth(env)


def _spreading(pool: VehiclePool, settings: Settings) -> tuple[Spreading, ...]:
    """Return in what the vehicles of a pool differ; nothing where it has one."""
    return differences(pool.vehicles, settings.flown, settings.actuation) if pool.has_choice else ()
