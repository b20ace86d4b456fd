"""The exception of the checks across fields, and limits that several of them share."""

from __future__ import annotations

from dq_marine.physics.gravity import LEAST_GRAVITY, MOST_GRAVITY


class Implausible(ValueError):  # noqa: N818 - reported by pydantic, which wants a ValueError
    """A field contradicts physics, or another field, by more than any real vehicle would."""

    def __init__(self, field: str, value: object, problem: str, remedy: str) -> None:
        self.field = field
        self.value = value
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"{problem}; {remedy}")


def check_gravity(field: str, gravity: float) -> None:
    """Refuse an acceleration of gravity that no scene may have [m/s^2].

    Raises:
        Implausible: it lies outside `LEAST_GRAVITY` to `MOST_GRAVITY`.
    """
    if not LEAST_GRAVITY <= gravity <= MOST_GRAVITY:
        raise Implausible(
            field,
            gravity,
            f"no water that a vehicle meets has a gravity outside {LEAST_GRAVITY:g} to {MOST_GRAVITY:g} m/s^2",
            "give it in m/s^2, such as 9.80665, or leave it out",
        )


def check_water_density(field: str, density: float) -> None:
    """Refuse a density that no water has [kg/m^3].

    Raises:
        Implausible: it lies outside 500 to 2000 kg/m^3.
    """
    if not 500.0 <= density <= 2000.0:
        raise Implausible(
            field,
            density,
            "no water has a density outside 500 to 2000 kg/m^3",
            "give it in kg/m^3",
        )
