"""Trials run again, and each number beside the one that it should be."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import Any, NamedTuple

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import Result
from dq_marine.manoeuvres.quantities import Quantity
from dq_marine.manoeuvres.run import Watch, unwatched
from dq_marine.manoeuvres.table import shown
from dq_marine.physics.radiation.build import CONSTANT
from dq_marine.validation.trials import Expected, Outcome, Trial
from dq_marine.vehicles import Vehicle, load_vehicle


class Verdict(StrEnum):
    """What a comparison ends with."""

    AGREES = "agrees"
    EXPLAINED = "differs, as explained"
    DIFFERS = "differs"


class Line(NamedTuple):
    """One number of a trial beside its reference.

    Attributes:
        trial: name of the trial.
        quantity: the number.
        expected: what it should be.
    """

    trial: str
    quantity: Quantity
    expected: Expected

    @property
    def offset(self) -> float | None:
        """How far off the number is: 0 at the reference or amid its bounds, 1 or -1 at a limit; None if not reached.

        With a single bound it is 1 or -1 there, and beyond 1 on the wrong side only.
        """
        got, expected = self.quantity.value, self.expected
        if got is None:
            return None
        if expected.value is not None:
            return (got - expected.value) / (expected.within * abs(expected.value))
        low, high = expected.at_least, expected.at_most
        if low is not None and high is not None:
            return (2.0 * got - low - high) / (high - low)
        if low is not None:
            return -_beyond(-got, -low)
        return None if high is None else _beyond(got, high)

    @property
    def verdict(self) -> Verdict:
        """Whether the two agree."""
        offset = self.offset
        if offset is not None and abs(offset) <= 1.0:
            return Verdict.AGREES
        return Verdict.EXPLAINED if self.expected.because else Verdict.DIFFERS

    @property
    def wanted(self) -> str:
        """What the number should be, for reading."""
        expected = self.expected
        if expected.value is not None:
            return f"{shown(expected.value)} ± {100.0 * expected.within:.3g} %"
        if expected.at_least is None:
            return f"at most {shown(expected.at_most)}"
        if expected.at_most is None:
            return f"at least {shown(expected.at_least)}"
        return f"{shown(expected.at_least)} to {shown(expected.at_most)}"

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON has of it."""
        return {
            "trial": self.trial,
            "quantity": self.quantity.key,
            "value": self.quantity.value,
            "expected": self.expected.model_dump(exclude_defaults=True, exclude={"quantity"}),
            "verdict": self.verdict.value,
        }


class Comparison(NamedTuple):
    """A vehicle beside its references.

    Attributes:
        vehicle: its name in the catalogue, or that of its file.
        title: its name for people.
        lines: all numbers, in the order of the references.
        results: of the standard manoeuvres among the trials, by the trials' names.
    """

    vehicle: str
    title: str
    lines: tuple[Line, ...]
    results: tuple[tuple[str, Result], ...]


def compared(
    name: str,
    vehicle: Vehicle,
    trials: Sequence[Trial],
    watch: Watch = unwatched,
    radiation: str = CONSTANT,
) -> Comparison:
    """Return a vehicle beside its references, all trials run, with constant radiation or with memory.

    Raises:
        InvalidInputError: a trial cannot be done by this vehicle, or does not give what is expected of it, or its file
            has no radiation by frequency and memory is asked for.
        StepNotSolvableError: the integrator refused a step.
    """
    lines: list[Line] = []
    results: list[tuple[str, Result]] = []
    for trial in trials:

        def told(phase: str, time: float, name: str = trial.name) -> None:
            watch(f"{name}, {phase}", time)

        flown = vehicle if trial.variant is None else load_vehicle(trial.variant)
        outcome = trial.run(flown, told, radiation)
        lines += [Line(trial.name, _found(outcome, one, trial), one) for one in trial.expected]
        if outcome.result is not None:
            results.append((trial.name, outcome.result))
    return Comparison(name, vehicle.name, tuple(lines), tuple(results))


def _found(outcome: Outcome, expected: Expected, trial: Trial) -> Quantity:
    for quantity in outcome.quantities:
        if quantity.key == expected.quantity:
            return quantity
    known = ", ".join(quantity.key for quantity in outcome.quantities)
    raise InvalidInputError(
        f"quantity = {expected.quantity!r} is none of the trial {trial.name!r}; it gives {known}"
    )


def _beyond(value: float, limit: float) -> float:
    """Return 1 at a limit, 0 well below it and more than 1 beyond, whatever the signs."""
    return 1.0 + (value - limit) / max(abs(limit), abs(value)) if value != limit else 1.0
