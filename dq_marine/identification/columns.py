"""Columns of a log: which quantities there are, and their units, which stand at the end of a column's name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError

TIMES = {"s": 1.0, "ms": 1e-3}
LENGTHS = {"m": 1.0}
ANGLES = {"rad": 1.0, "deg": math.pi / 180.0}
SPEEDS = {"m_s": 1.0, "kn": 1852.0 / 3600.0}
RATES = {"rad_s": 1.0, "deg_s": math.pi / 180.0}
FORCES = {"N": 1.0, "kN": 1e3}
MOMENTS = {"N_m": 1.0, "kN_m": 1e3}
SHAFT_SPEEDS = {"rad_s": 1.0, "rpm": math.pi / 30.0}
"""Units by their names in a header, and what one of them is in SI units."""

POSITION = ("north", "east", "down")
QUATERNION = ("q_scalar", "q_x", "q_y", "q_z")
EULER = ("roll", "pitch", "heading")
VELOCITY = ("u", "v", "w", "p", "q", "r")
WRENCH = ("X", "Y", "Z", "K", "M", "N")

QUANTITIES: dict[str, Mapping[str, float]] = {
    "time": TIMES,
    **dict.fromkeys((*POSITION, "depth"), LENGTHS),
    **dict.fromkeys(EULER, ANGLES),
    **dict.fromkeys(VELOCITY[:3], SPEEDS),
    **dict.fromkeys(VELOCITY[3:], RATES),
    **dict.fromkeys(WRENCH[:3], FORCES),
    **dict.fromkeys(WRENCH[3:], MOMENTS),
}
"""What has a unit in its column's name, as in `u_m_s`; the quaternion's components have none."""

CHANNEL_UNITS: dict[str, Mapping[str, float]] = {"rad/s": SHAFT_SPEEDS, "rad": ANGLES, "1": {"": 1.0}}
"""Units of commands, by the unit of the channel; a share of the largest speed has none."""

TIME_WORDS = ("s", "ms", "us", "min", "h")
LENGTH_WORDS = ("m", "mm", "cm", "km", "ft", "in")
SPEED_WORDS = ("kn", "mph", "kmh")
ANGLE_WORDS = ("rad", "mrad", "deg", "rev", "rpm")
FORCE_WORDS = ("N", "kN", "MN", "kgf", "lbf", "lb", "Nm", "kNm")

UNIT_WORDS = frozenset((*TIME_WORDS, *LENGTH_WORDS, *SPEED_WORDS, *ANGLE_WORDS, *FORCE_WORDS))
"""A name that ends in such words has a unit, known or not."""


class Column(NamedTuple):
    """A column that is read: its name in the header, the quantity, and what one of its unit is in SI units."""

    header: str
    quantity: str
    factor: float


def recognised(headers: Sequence[str], units: Mapping[str, Mapping[str, float]]) -> dict[str, Column]:
    """Return the columns that are known, by quantity; others are left out.

    Args:
        headers: names of all columns.
        units: of each quantity that is looked for.

    Raises:
        InvalidInputError: a quantity is there twice, has no unit or an unknown one.
    """
    found: dict[str, Column] = {}
    for header in headers:
        column = _recognised(header, units)
        if column is None:
            continue
        if column.quantity in found:
            raise InvalidInputError(
                f"columns {found[column.quantity].header!r} and {header!r} are both {column.quantity!r}; keep one"
            )
        found[column.quantity] = column
    return found


def _recognised(header: str, units: Mapping[str, Mapping[str, float]]) -> Column | None:
    for quantity, factors in units.items():
        for unit, factor in factors.items():
            if header == (f"{quantity}_{unit}" if unit else quantity):
                return Column(header, quantity, factor)
    for quantity, factors in units.items():
        rest = header.removeprefix(f"{quantity}_")
        known = " or ".join(f"{quantity}_{unit}" for unit in factors)
        if header == quantity:
            raise InvalidInputError(f"column {shown(header)} has no unit; name it {known}")
        if rest != header and header not in QUATERNION and UNIT_WORDS.issuperset(rest.split("_")):
            raise InvalidInputError(f"column {shown(header)} has an unknown unit; give {known}")
    return None
