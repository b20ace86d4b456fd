"""What drove a logged vehicle: a wrench on its body, or the commands of its actuators."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.identification.columns import CHANNEL_UNITS, QUANTITIES, WRENCH, Column, recognised
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.model import MOTIONS

Array = NDArray[np.float64]
Values = Callable[[Column], Array]


@dataclass(frozen=True)
class Inputs:
    """What drove the vehicle, held from each instant to the next.

    Attributes:
        actuation: "wrench" or "thrusters", as scenes have it.
        values: wrenches [N, N m], shape (n, 6); or commands in the order of `Vehicle.channels`.
    """

    actuation: str
    values: Array


def inputs_of(name: str, headers: Sequence[str], vehicle: Vehicle, values: Values) -> Inputs:
    """Return the inputs of a log.

    They stand in columns of one of four kinds: a wrench, `X_N` to `N_N_m`, where those left out are zero; commands of
    channels, `command_NAME_UNIT` (no unit for a share of the largest speed); or actions as `dq-marine fly` writes
    them, `action_surge` for a share of the largest force of an axis, or `action_NAME` for a share of a channel's limit.

    Args:
        name: of the file.
        headers: names of its columns.
        vehicle: that was logged.
        values: returns the numbers of a column.

    Raises:
        InvalidInputError: none is there, or columns of two kinds, or not all channels.
    """
    wrench = {quantity: QUANTITIES[quantity] for quantity in WRENCH}
    channels = {_word(channel.name): channel for channel in vehicle.channels}
    commands = {f"command_{word}": CHANNEL_UNITS[channel.unit] for word, channel in channels.items()}
    plain: Mapping[str, float] = {"": 1.0}
    axes = dict.fromkeys((f"action_{motion}" for motion in MOTIONS), plain)
    shares = dict.fromkeys((f"action_{word}" for word in channels), plain)
    kinds = (wrench, commands, axes, shares)
    found = [recognised(headers, kind) for kind in kinds]
    if sum(map(bool, found)) != 1:
        raise InvalidInputError(_ambiguous(name, headers, commands, found))
    index = next(number for number, columns in enumerate(found) if columns)
    columns, kind = found[index], kinds[index]
    if kind in (commands, shares):
        _check_all(name, columns, kind)
    given = [values(columns[quantity]) if quantity in columns else None for quantity in kind]
    n = next(len(column) for column in given if column is not None)
    table = np.stack([np.zeros(n) if column is None else column for column in given], axis=1)
    if kind is axes:
        table = table * vehicle.wrench_limits
    if kind is shares:
        high = np.array([channel.high for channel in channels.values()])
        low = np.array([channel.low for channel in channels.values()])
        table = np.where(table >= 0.0, table * high, -table * low)
    return Inputs("wrench" if kind in (wrench, axes) else "thrusters", table)


def _word(name: str) -> str:
    return name.replace(" ", "_")


def _check_all(name: str, columns: Mapping[str, Column], kind: Mapping[str, Mapping[str, float]]) -> None:
    missing = [quantity for quantity in kind if quantity not in columns]
    if missing:
        raise InvalidInputError(
            f"{name} has no column {', '.join(missing)}; give the commands of all channels"
        )


def _ambiguous(
    name: str,
    headers: Sequence[str],
    commands: Mapping[str, Mapping[str, float]],
    found: Sequence[Mapping[str, Column]],
) -> str:
    present = [next(iter(columns.values())).header for columns in found if columns]
    if present:
        return f"{name} says twice what drove the vehicle, by {' and by '.join(present)}; keep columns of one kind"
    if {"throttle", "helm"} <= set(headers):
        return (
            f"{name} is the series of a manoeuvre: throttle and helm do not say what held depth and attitude; give "
            "a log with a wrench or with commands, such as dq-marine fly --trajectory writes"
        )
    known = [f"{quantity}_{next(iter(units))}".removesuffix("_") for quantity, units in commands.items()]
    ways = ["X_N, Y_N, Z_N, K_N_m, M_N_m, N_N_m", "action_surge, ..."]
    ways += [", ".join(known)] if known else []
    return f"{name} has no columns of what drove the vehicle; add {'; or '.join(ways)}"
