"""Bodies that may fail: many are tried at step sizes which no method can take."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.errors import StepNotSolvableError
from dq_marine.report.methods import Method
from dq_marine.report.physics import Physics
from dq_marine.simulation.one_body import OneBody

P = ParamSpec("P")
T = TypeVar("T")

DONE, BLEW_UP = "done", "blew up"
NO_WRENCH = np.zeros(6)


class Trial(OneBody):
    """A body that says why it was refused, and does not look for a step that would have done."""

    def _admissible_step(self, wrench: NDArray[np.float64], steps: int) -> float | None:
        return None

    def attempt(self, wrench: ArrayLike = NO_WRENCH, steps: int = 1) -> str:
        """Advance, and return how that went: `DONE`, `BLEW_UP`, or the reason of a refusal."""
        try:
            self.step(wrench, steps)
        except StepNotSolvableError as error:
            return BLEW_UP if error.reason == "not_finite" else error.reason
        return DONE

    def bare_calls(self, wrench: ArrayLike, steps: int) -> tuple[Callable[[], None], Callable[[], Any]]:
        """Return what puts the body back where it is now, and the compiled call that advances it from there.

        For timing: the calls check nothing and count nothing.
        """
        start, push = self._state.copy(), np.array(wrench, dtype=np.float64)

        def put_back() -> None:
            self._state[:] = start

        return put_back, functools.partial(self._advance, self._numbers, self._state, push, self.time, steps)


def trial(method: Method, physics: Physics, step: float) -> Trial:
    """Return a body that a method steps, at rest at the origin."""
    return Trial(*method.compose(physics), step)


def evaluations_of(method: Method, physics: Physics) -> int:
    """Return how often a step of a method evaluates the forces of a physics."""
    return method.damped_evaluations if physics.assembly().dissipation else method.evaluations


def overflow_allowed(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function in which NumPy does not warn: what blows up is an outcome, not an accident."""

    @functools.wraps(function)
    def quiet(*arguments: P.args, **named: P.kwargs) -> T:
        with np.errstate(over="ignore", invalid="ignore"):
            return function(*arguments, **named)

    return quiet


def finite(value: float) -> Any:
    """Return a number as JSON has it: None for what is infinite or not a number."""
    return float(value) if np.isfinite(value) else None
