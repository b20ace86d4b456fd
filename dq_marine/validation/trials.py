"""The kinds of trials that a vehicle can be validated by, as files of references describe them."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Annotated, Literal, NamedTuple, Self, TypeAlias

from pydantic import Field, model_validator

from dq_marine import manoeuvres
from dq_marine.manoeuvres import Conditions, Result
from dq_marine.manoeuvres.quantities import Quantity
from dq_marine.manoeuvres.run import Watch
from dq_marine.physics.fields import Positive, Table, Vector3, Vector6
from dq_marine.physics.implausible import Implausible
from dq_marine.physics.radiation.build import CONSTANT
from dq_marine.validation.steady_run import Drive, steady_run
from dq_marine.vehicles import Vehicle

LONGEST = 86400.0
"""Of a run [s]."""

Share: TypeAlias = Annotated[float, Field(gt=0, le=1)]


class Outcome(NamedTuple):
    """What a trial gave.

    Attributes:
        quantities: all its numbers.
        result: of a standard manoeuvre, which has a picture; None of other trials.
    """

    quantities: tuple[Quantity, ...]
    result: Result | None = None


class Expected(Table):
    """One number that a trial should give: a value and how near, or bounds.

    Attributes:
        quantity: its key, with the unit at its end.
        value: that was published or computed elsewhere.
        within: largest difference to it that agrees, as a share of the value.
        at_least: lower bound, if there is no value.
        at_most: upper bound, if there is no value.
        source: of the value or of the bounds.
        because: why the number differs, if it is known to.
    """

    quantity: str
    value: float | None = None
    within: Share = 0.03
    at_least: float | None = None
    at_most: float | None = None
    source: Annotated[str, Field(min_length=1)]
    because: str = ""

    @model_validator(mode="after")
    def _says_one_thing(self) -> Self:
        bounded = self.at_least is not None or self.at_most is not None
        if (self.value is None) != bounded:
            raise Implausible(
                "quantity", self.quantity, "it needs a value or bounds, and not both", "give one of them"
            )
        if self.value == 0.0:
            raise Implausible("value", 0, "a share of it says nothing", "give at_least and at_most instead")
        if self.at_least is not None and self.at_most is not None and self.at_least >= self.at_most:
            raise Implausible(
                "at_least", f"{self.at_least:g}", f"it is not below at_most = {self.at_most:g}", "swap them"
            )
        return self


class TrialTable(Table):
    """What all trials have in common.

    Attributes:
        name: of the trial, for people.
        variant: of the vehicle that does it, by its name in the catalogue; None for the vehicle itself.
        expected: the numbers that are compared.
    """

    name: Annotated[str, Field(min_length=1)]
    variant: str | None = None
    expected: Annotated[tuple[Expected, ...], Field(min_length=1)]

    @abstractmethod
    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return what a vehicle does in this trial, with constant radiation or with memory.

        Raises:
            InvalidInputError: the vehicle cannot do it.
            StepNotSolvableError: the integrator refused a step.
        """


class SteadyTrial(TrialTable):
    """A constant wrench, or constant commands, from rest over ground, heading north.

    Attributes:
        wrench: on the body, in Fossen's order [N, N m].
        commands: of actuators by the names of their channels, in their units; the others are left at 0.
        current: of the water in NED [m/s].
        duration: after which speeds and attitude are read off [s].
    """

    manoeuvre: Literal["steady"]
    wrench: Vector6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    commands: dict[str, float] = Field(default_factory=dict)
    current: Vector3 = (0.0, 0.0, 0.0)
    duration: Annotated[float, Field(gt=0, le=LONGEST)]

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return speeds through the water, attitude, rates and way at the end."""
        drive = Drive(self.wrench, self.commands, self.current, self.duration, radiation)
        return Outcome(steady_run(vehicle, drive, watch))


class AccelerationTrial(TrialTable):
    """From rest to the speed that a throttle holds; `throttle` is a fraction of full."""

    manoeuvre: Literal["acceleration"]
    throttle: Share = 1.0

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return top speed, times and distance."""
        conditions = Conditions(self.throttle, radiation=radiation)
        return _outcome(manoeuvres.acceleration(vehicle, conditions=conditions, watch=watch))


class TurningCircleTrial(TrialTable):
    """A turning circle; `helm` and `throttle` are fractions of full."""

    manoeuvre: Literal["turning-circle"]
    helm: Share = 1.0
    side: Literal["starboard", "port"] = "starboard"
    throttle: Share = 1.0

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return advance, transfer, diameters and the steady turn."""
        conditions = Conditions(self.throttle, radiation=radiation)
        return _outcome(
            manoeuvres.turning_circle(
                vehicle, helm=self.helm, side=self.side, conditions=conditions, watch=watch
            )
        )


class ZigZagTrial(TrialTable):
    """A zig-zag; `angle_deg` reverses the helm, `helm` and `throttle` are fractions of full."""

    manoeuvre: Literal["zig-zag"]
    angle_deg: Annotated[float, Field(gt=0, lt=90)]
    helm: Share | None = None
    side: Literal["starboard", "port"] = "starboard"
    throttle: Share = 1.0

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return overshoots and times."""
        return _outcome(
            manoeuvres.zig_zag(
                vehicle,
                angle=math.radians(self.angle_deg),
                helm=self.helm,
                side=self.side,
                conditions=Conditions(self.throttle, radiation=radiation),
                watch=watch,
            )
        )


class StoppingTrial(TrialTable):
    """A stop from a steady approach; `order` is "astern" (full) or "off"; `throttle` is a fraction of full."""

    manoeuvre: Literal["stopping"]
    order: Literal["astern", "off"] = "astern"
    throttle: Share = 1.0

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return time, track reach and head reach."""
        conditions = Conditions(self.throttle, radiation=radiation)
        return _outcome(manoeuvres.stopping(vehicle, order=self.order, conditions=conditions, watch=watch))


class DecayTrial(TrialTable):
    """A free decay; `release` is in degrees, or in metres of heave, None for the manoeuvre's own."""

    manoeuvre: Literal["decay"]
    motion: Literal["roll", "pitch", "heave"]
    release: Positive | None = None

    def run(self, vehicle: Vehicle, watch: Watch, radiation: str = CONSTANT) -> Outcome:
        """Return period and damping."""
        release = self.release
        if release is not None and self.motion != "heave":
            release = math.radians(release)
        return _outcome(
            manoeuvres.decay(vehicle, motion=self.motion, release=release, radiation=radiation, watch=watch)
        )


Trial: TypeAlias = Annotated[
    SteadyTrial | AccelerationTrial | TurningCircleTrial | ZigZagTrial | StoppingTrial | DecayTrial,
    Field(discriminator="manoeuvre"),
]


def _outcome(result: Result) -> Outcome:
    return Outcome(result.quantities(), result)
