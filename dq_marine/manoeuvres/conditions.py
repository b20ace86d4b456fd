"""The conditions under which a manoeuvre is run."""

from __future__ import annotations

from dataclasses import dataclass

from dq_marine.checks import finite_number, one_of
from dq_marine.errors import InvalidInputError
from dq_marine.physics.actuators.build import ACTUATIONS
from dq_marine.physics.radiation.build import CONSTANT, RADIATIONS

LEAST_STEP = 1e-5
"""Of the integrator [s]: with a smaller one, minutes of a manoeuvre take hours."""


@dataclass(frozen=True)
class Conditions:
    """The conditions that all manoeuvres have in common. The water is still and deep.

    Attributes:
        throttle: of the approach, above 0 and at most 1.
        step: of the integrator [s]; None for one that suits the vehicle.
        actuation: what carries out throttle and helm: "wrench", a force and a moment on the body, or "thrusters", the
            vehicle's thrusters, azimuths and fins; None for these where its file has them.
        radiation: how the waves that the hull makes act on it: "constant", or "memory" where its file has added mass
            and damping by frequency. See `dq_marine.Scene`.

    Raises:
        InvalidInputError: a value is wrong.
    """

    throttle: float = 1.0
    step: float | None = None
    actuation: str | None = None
    radiation: str = CONSTANT

    def __post_init__(self) -> None:
        object.__setattr__(self, "throttle", fraction("throttle", self.throttle))
        if self.step is not None:
            object.__setattr__(self, "step", finite_number("step", self.step, least=LEAST_STEP))
        if self.actuation is not None:
            one_of("actuation", self.actuation, ACTUATIONS)
        one_of("radiation", self.radiation, RADIATIONS)


def fraction(name: str, value: float) -> float:
    """Return a fraction of full throttle or full helm.

    Raises:
        InvalidInputError: it is not above 0 and at most 1.
    """
    number = finite_number(name, value, above=0.0)
    if number > 1.0:
        raise InvalidInputError(f"{name} = {number:g} is above 1; give a fraction of what the vehicle has")
    return number
