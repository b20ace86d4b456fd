"""What is simulated: a vehicle and the water it moves in, as functions of the free numbers theta."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeAlias

from dq_marine.identification.parameters import CURRENT, Parameter, Quantity, quantities_of, vehicle_with
from dq_marine.vehicles import Vehicle

Velocity: TypeAlias = tuple[float, float, float]


class Model(NamedTuple):
    """A vehicle in a current.

    Attributes:
        vehicle: with all its numbers.
        current_ned: velocity of the water, the same everywhere and always [m/s].
    """

    vehicle: Vehicle
    current_ned: Velocity


def model_with(model: Model, parameters: Sequence[Parameter], theta: Iterable[float]) -> Model:
    """Return the model with its parameters at theta: those of the current are 1 m/s each.

    Raises:
        ValueError: the numbers leave what a vehicle file may say.
    """
    values = dict(zip(parameters, map(float, theta), strict=True))
    own = {one: value for one, value in values.items() if one.group != CURRENT}
    current = list(model.current_ned)
    for one in values.keys() - own.keys():
        current[one.place[0]] += values[one]
    north, east, down = current
    return Model(vehicle_with(model.vehicle, own.keys(), own.values()), (north, east, down))


def numbers_of(model: Model, parameters: Sequence[Parameter]) -> tuple[Quantity, ...]:
    """Return the number that each parameter stands for, in its unit."""
    return tuple(
        Quantity(one.label, "m/s", model.current_ned[one.place[0]])
        if one.group == CURRENT
        else quantities_of(model.vehicle, [one])[0]
        for one in parameters
    )
