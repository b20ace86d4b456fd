"""Another vehicle for every episode, in SIMD lanes: each draws one of a pool that was prepared beforehand.

A member of the pool is a row of numbers: its step's parameters and those of the task's parameters that are the
vehicle's. A step then costs what it does with one vehicle for all.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from numba import types
from numba.core.typing import signature
from numba.extending import intrinsic

from dq_marine.algebra.selection import select_call
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.packing import make_load
from dq_marine.backend.pcg64 import next_uniform
from dq_marine.backend.simd.rows import make_load_column, store_rows
from dq_marine.integrator.step import StepParameters


@dataclass(frozen=True)
class PoolLayout:
    """What a row of a pool holds.

    Attributes:
        member: Numba's type of (parameters of the step, (fields of the episode's parameters)).
        episode_fields: names of those fields.
    """

    member: types.Type
    episode_fields: tuple[str, ...]


def member_index(members: int, uniform: float) -> int:
    """Return which member of a pool a uniform random number in [0, 1) means."""
    return int(members * uniform)


def keep_vehicle(
    renewed: bool, arrays: Any, block: int, bodies: int, parameters: StepParameters, episode: Any
) -> Any:
    """Return the parameters of step and episode: there is one vehicle."""
    return parameters, episode


@functools.cache
def make_renew_vehicle(pool: PoolLayout | None, lanes: Lanes) -> Callable[..., Any]:
    """Return (renewed, arrays, block, bodies, parameters, episode) -> (parameters, episode), for compiled code.

    Where episodes are renewed, their vehicle is drawn, its number kept in `arrays.vehicles`; the water stays.
    """
    if pool is None:
        return keep_vehicle
    load_member, load_numbers = make_load(pool.member), make_load_column(lanes)
    replace = make_replace(pool.episode_fields)

    def draw_vehicle(
        generators: Any, members: Any, body: int, parameters: StepParameters, episode: Any
    ) -> Any:
        index = member_index(len(members), next_uniform(generators[body]))
        drawn, fields = load_member(members[index])
        return float(index), drawn, replace(episode, fields)

    def renew_vehicle(
        renewed: bool, arrays: Any, block: int, bodies: int, parameters: StepParameters, episode: Any
    ) -> Any:
        arguments = (arrays.generators, arrays.pool, bodies, parameters, episode)
        going_on = (load_numbers(arrays.vehicles, block), parameters, episode)
        number, parameters, episode = select_call(renewed, draw_vehicle, arguments, going_on)
        store_rows(arrays.vehicles, block, number)
        return parameters, episode

    return renew_vehicle


def make_replace(names: tuple[str, ...]) -> Callable[[Any, Any], Any]:
    """Return (named tuple, parts) -> the tuple with the named fields replaced, for compiled code."""

    @intrinsic
    def replace(typing_context: Any, structure: Any, parts: Any) -> Any:
        places = {structure.fields.index(name): number for number, name in enumerate(names)}

        def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            items = [
                builder.extract_value(values[1], places[index])
                if index in places
                else builder.extract_value(values[0], index)
                for index in range(len(structure.types))
            ]
            return context.make_tuple(builder, structure, items)

        return signature(structure, structure, parts), generate

    return replace
