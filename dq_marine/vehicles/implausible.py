"""The error of a vehicle that cannot be."""

from __future__ import annotations


class Implausible(ValueError):  # noqa: N818 - reported by pydantic, which wants a ValueError
    """A field contradicts physics, or another field, by more than any real vehicle would."""

    def __init__(self, field: str, value: object, problem: str, remedy: str) -> None:
        self.field = field
        self.value = value
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"{problem}; {remedy}")
