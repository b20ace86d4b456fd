"""What the checks across fields raise, and a limit that several of them share."""

from __future__ import annotations


class Implausible(ValueError):  # noqa: N818 - reported by pydantic, which wants a ValueError
    """A field contradicts physics, or another field, by more than any real vehicle would."""

    def __init__(self, field: str, value: object, problem: str, remedy: str) -> None:
        self.field = field
        self.value = value
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"{problem}; {remedy}")


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
