"""The part of an observation that only the simulator knows: what it may show, and which numbers these are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dq_marine.checks import one_of, shown
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


HIDDEN_BY = {
    "current": "a current",
    "vehicle": "randomise",
    "truth": "sensors, or an observation_delay",
}
"""What may be privileged, in the order of its numbers: the water's velocity, in what the vehicle is not the nominal
one, and what the task would observe of the true motion. Of each, the keywords by which an agent is not told of it."""


def checked_privileged(privileged: Any) -> tuple[str, ...]:
    """Return the names of what an environment shows of what only the simulator knows, in the order of its numbers.

    Args:
        privileged: one name of `HIDDEN_BY`, or several; None for nothing.

    Raises:
        InvalidInputError: there is no such thing.
    """
    if privileged is None:
        return ()
    given = [privileged] if isinstance(privileged, str) else privileged
    if not isinstance(given, list | tuple):
        raise InvalidInputError(
            f"privileged = {shown(privileged)}; give a name of {list(HIDDEN_BY)}, or a list"
        )
    wanted = {one_of("privileged", name, HIDDEN_BY) for name in given}
    return tuple(name for name in HIDDEN_BY if name in wanted)


def told_pool(pool: VehiclePool, settings: Settings) -> VehiclePool:
    """Return a pool whose episodes know in what their vehicle is not the nominal one.

    Raises:
        InvalidInputError: none of its vehicles differs from another.
    """
    parts = _spreading(pool, settings)
    if not parts:
        raise InvalidInputError(
            "privileged has 'vehicle', but no number of the vehicle differs between episodes; give randomise, or leave "
            "'vehicle' out"
        )
    rows = np.concatenate([one.numbers for one in parts], axis=1)
    return pool.telling([tuple(row) for row in rows.tolist()])


def privileged_numbers(env: ComposedTask) -> tuple[Observed, ...]:
    """Return what the privileged part of an environment's observation consists of, in its order."""
    shown_by = {"current": _current, "vehicle": _of_vehicle, "truth": _true}
    return tuple(one for name in env.privileged for one in shown_by[name](env))


def hidden_parts(env: ComposedTask) -> tuple[str, ...]:
    """Return the names of `HIDDEN_BY` of what the agent is not told in an environment."""
    settings = env.settings
    hidden = {
        "current": env.scene.composition.water != STILL_WATER,
        "vehicle": env.pool.has_choice,
        "truth": settings.sensor_list or settings.observation_delay or env.ping_schedule,
    }
    return tuple(name for name in HIDDEN_BY if hidden[name])


def _current(env: ComposedTask) -> Sequence[Observed]:
    return (CURRENT,)


def _of_vehicle(env: ComposedTask) -> Sequence[Observed]:
    return [
        Observed(one.name, one.unit, numbers.shape[1], LARGEST_DIFFERENCE, one.meaning, PRIVILEGED)
        for one, numbers in _spreading(env.pool, env.settings)
    ]


def _true(env: ComposedTask) -> Sequence[Observed]:
    own = env.definition.observations(env.task_settings, env.vehicle)
    return [
        one._replace(name=f"true_{one.name}", meaning=f"true: {one.meaning}", part=PRIVILEGED) for one in own
    ]


def _spreading(pool: VehiclePool, settings: Settings) -> tuple[Spreading, ...]:
    """Return in what the vehicles of a pool differ; nothing where it has one."""
    return differences(pool.vehicles, settings.flown, settings.actuation) if pool.has_choice else ()
