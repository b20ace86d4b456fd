"""The exceptions that dq_marine raises, all at its public doors.

Each names the offending value, the limit it broke and the remedy, and leaves what it refused unchanged.
"""

from __future__ import annotations

from collections.abc import Sequence


class DQMarineError(Exception):
    """Base class of every exception that dq_marine raises on purpose."""


class InvalidInputError(DQMarineError, ValueError):
    """A value handed to a public function is outside what that function accepts."""


class UnknownKeywordError(InvalidInputError, TypeError):
    """A keyword is none of those that are taken.

    It is a `TypeError`, too, with Python's own words: TorchRL tries keywords and takes back those refused in this way.
    """

    @classmethod
    def of(cls, where: str, unknown: Sequence[str], remedy: str) -> UnknownKeywordError:
        """Return the error of a constructor that was given unknown keywords."""
        names = ", ".join(map(repr, unknown))
        what = "an unexpected keyword argument" if len(unknown) == 1 else "unexpected keyword arguments"
        return cls(f"{where} got {what} {names}; {remedy}")


class VehicleFileError(InvalidInputError):
    """A vehicle file is refused.

    The message names the file, the field, the value and the remedy, one line per mistake.
    """


class MissingDependencyError(DQMarineError, ImportError):
    """An optional package or program is needed for what was asked and is not installed."""


class StepNotSolvableError(DQMarineError, ArithmeticError):
    """The integrator refused a step; the state is the one before the call.

    Attributes:
        reason: one word from `dq_marine.simulation.one_body.REFUSALS`.
        residual: relative residual of the discrete equation where the solver stopped.
        step_times_spin: h |omega|, dimensionless [rad].
        step_times_speed: h |v| [m].
        admissible_step: a step size [s] that was tried and takes this state through; None if none does.
    """

    def __init__(
        self,
        reason: str,
        *,
        residual: float,
        step_times_spin: float,
        step_times_speed: float,
        admissible_step: float | None,
    ) -> None:
        self.reason = reason
        self.residual = residual
        self.step_times_spin = step_times_spin
        self.step_times_speed = step_times_speed
        self.admissible_step = admissible_step
        remedy = (
            "no smaller step was found that takes it through; reduce the wrench or the speed"
            if admissible_step is None
            else f"a step of {admissible_step:.3g} s takes it through"
        )
        super().__init__(
            f"the step was refused ({reason}): residual {residual:.3g}, "
            f"h|omega| = {step_times_spin:.3g} rad, h|v| = {step_times_speed:.3g} m; "
            f"{remedy}"
        )


class UnsuitableVehicleWarning(UserWarning):
    """A task cannot be done with the vehicle that an environment is made with."""


class BeyondValidityWarning(UserWarning):
    """A vehicle is where the numbers of its file were not measured or computed for."""
