"""A vehicle made ready for its manoeuvres: scene, step, scales of length and time, steering."""

from __future__ import annotations

import math
from dataclasses import dataclass

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.actuator_steering import ActuatorSteering
from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.manoeuvres.rudder_steering import RudderSteering
from dq_marine.manoeuvres.steering import SURGE, Steering, WrenchSteering
from dq_marine.manoeuvres.whole_ship_steering import WholeShipSteering
from dq_marine.physics.radiation.build import CONSTANT
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, vehicle_sheet
from dq_marine.vehicles.analysis.sheet import terminal_speed

SAMPLES = 100
"""Smallest number of samples while the vehicle runs its own length at full speed; the helm may change at each."""

ACCURATE_STEP = 0.1
"""Step size over the largest step of the vehicle's sheet."""

DEPTH = 5.0
"""Depth of a submerged vehicle, in metres or in its lengths, whichever is more."""


@dataclass(frozen=True)
class Setup:
    """A vehicle that can be steered.

    Attributes:
        scene: still water.
        conditions: of all its runs.
        steering: carries out throttle and helm.
        full_speed: about what full throttle holds [m/s]; sets scales, not results.
        sample_steps: steps between samples.
    """

    scene: Scene
    conditions: Conditions
    steering: Steering
    full_speed: float
    sample_steps: int

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle."""
        return self.scene.vehicle

    @property
    def settings(self) -> dict[str, float | str]:
        """The conditions that a result names."""
        own = radiation_setting(self.scene.radiation)
        return {"throttle": self.conditions.throttle, "actuation": self.scene.actuation, **own}

    @property
    def length(self) -> float:
        """Length that figures are counted in [m]: between perpendiculars of a ship that says it, else overall."""
        ship = self.vehicle.manoeuvring or self.vehicle.whole_ship
        return self.vehicle.dimensions.length if ship is None else ship.length

    @property
    def time_scale(self) -> float:
        """Time to run its own length at full speed [s]."""
        return self.length / self.full_speed

    @property
    def sample_period(self) -> float:
        """Time between samples [s]."""
        return self.sample_steps * self.scene.step

    @property
    def depth(self) -> float:
        """Depth at which it runs: position of the body origin in NED [m]."""
        return running_depth(self.vehicle)

    def check_throttle(self, throttle: float) -> None:
        """Check a throttle, -1 to 1.

        Raises:
            InvalidInputError: the vehicle has no other than full.
        """
        ship = self.vehicle.whole_ship
        if ship is not None and self.scene.actuation == "thrusters" and throttle != 1.0:
            raise InvalidInputError(
                f"throttle = {throttle:g}: the propeller of {self.vehicle.name!r} is in its polynomials and turns as "
                f"at {ship.service_speed:g} m/s, never otherwise; give throttle 1, or "
                'actuation="wrench", whose force acts besides'
            )


def radiation_setting(radiation: str) -> dict[str, str]:
    """Return what a result says of radiation: nothing where it is constant, as usual."""
    return {} if radiation == CONSTANT else {"radiation": radiation}


def running_depth(vehicle: Vehicle) -> float:
    """Return the depth of the body origin [m]: at rest of a vessel that floats, well below the surface of others."""
    if vehicle.hydrostatics is not None:
        return vehicle.equilibrium_depth
    return DEPTH * max(1.0, vehicle.dimensions.length)


def prepared(vehicle: Vehicle, conditions: Conditions) -> Setup:
    """Return a vehicle made ready to be steered.

    Raises:
        InvalidInputError: it cannot be driven ahead or turned, nothing damps it in surge, it has no such throttle, its
            file has no radiation by frequency and memory is asked for, or the step is too large.
    """
    actuation = conditions.actuation or ("thrusters" if vehicle.channels else "wrench")
    speed = full_speed(vehicle, actuation)
    step, samples = sampling(vehicle, speed, conditions.step)
    scene = Scene(vehicle, step=step, actuation=actuation, radiation=conditions.radiation)
    setup = Setup(scene, conditions, steering_of(vehicle, actuation, speed), speed, samples)
    setup.check_throttle(conditions.throttle)
    return setup


def steering_of(vehicle: Vehicle, actuation: str, speed: float) -> Steering:
    """Return what carries out throttle and helm, with scales made for a speed [m/s].

    Raises:
        InvalidInputError: the vehicle cannot be driven ahead or turned so.
    """
    if actuation == "wrench":
        return WrenchSteering(vehicle)
    if vehicle.manoeuvring is not None:
        return RudderSteering(vehicle.manoeuvring, vehicle.buoyancy.water_density)
    if vehicle.whole_ship is not None:
        return WholeShipSteering(vehicle.whole_ship, vehicle.buoyancy.water_density, len(vehicle.channels))
    return ActuatorSteering(vehicle, speed)


def full_speed(vehicle: Vehicle, actuation: str) -> float:
    """Return about what full throttle holds [m/s]: of a whole ship by its own propeller, its service speed.

    Raises:
        InvalidInputError: nothing drives the vehicle ahead, or nothing damps it in surge.
    """
    if vehicle.whole_ship is not None and actuation == "thrusters":
        return vehicle.whole_ship.service_speed
    speed = terminal_speed(vehicle, SURGE)
    if speed == 0.0:
        raise InvalidInputError(
            f"limits.wrench[{SURGE}] = 0: {vehicle.name!r} has nothing in surge to drive it ahead; give it a limit "
            "above 0, or a vehicle that has one"
        )
    if not math.isfinite(speed):
        raise InvalidInputError(
            f"damping of {vehicle.name!r} in surge is 0: it would gain speed for ever; give damping.linear or "
            "damping.quadratic a surge entry above 0"
        )
    return speed


def sampling(vehicle: Vehicle, speed: float, step: float | None) -> tuple[float, int]:
    """Return the step [s] and the steps between samples.

    The step is the largest round one that divides the longest time between samples and is accurate for the vehicle's
    stiffest motion, unless it is given.
    """
    period = vehicle.dimensions.length / speed / SAMPLES
    if step is None:
        step = rounded_down(min(period, ACCURATE_STEP * vehicle_sheet(vehicle, speed=speed).largest_step))
    return step, max(1, math.floor(period / step + 1e-9))


def rounded_down(value: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above a value."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-12)
    factor = max(
        factor for factor in (1.0, 2.0, 5.0) if factor * power <= value * (1.0 + 1e-9) or factor == 1.0
    )
    return factor * power
