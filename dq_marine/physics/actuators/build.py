"""From a vehicle's actuators to the pure functions and tuples of a step, leaving out what they do not have."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dq_marine.algebra.nesting import nested
from dq_marine.algebra.spatial import Spatial, from_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.actuation import Actuation
from dq_marine.physics.abkowitz.build import rudder_term
from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.physics.actuators.formulas.channels import (
    Channel,
    ChannelKind,
    Lag,
    LaggedSlew,
    Slew,
    follow_at_once,
    follow_with_lag,
    follow_with_lagged_slew,
    follow_with_slew,
    limited_target,
    turning_target,
)
from dq_marine.physics.actuators.formulas.effects import (
    AZIMUTH_THRUSTER,
    FIN,
    FIXED_THRUSTER,
    THRUSTER_IN_FLOW,
    AzimuthThruster,
    EffectKind,
    FixedThruster,
    Propeller,
    ThrusterInFlow,
)
from dq_marine.physics.actuators.formulas.effects import Fin as FinEffect
from dq_marine.physics.actuators.formulas.force import ActuatorKind, Actuators, Transient, make_actuation
from dq_marine.physics.actuators.tables import Azimuth, Fin, Propulsion, Thruster
from dq_marine.physics.manoeuvring.build import stern_term
from dq_marine.physics.manoeuvring.tables import Manoeuvring
from dq_marine.physics.term import ForceTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

ACTUATIONS = ("wrench", "thrusters")
"""The names that `actuation=` takes."""

NAME = "actuators"
"""Name of the force among a scene's terms."""


class ChannelPart(NamedTuple):
    """One channel: its functions and its numbers."""

    kind: ChannelKind
    numbers: Channel


class ActuatorPart(NamedTuple):
    """One actuator: its functions, the numbers of its effect, and its channels' numbers."""

    kind: ActuatorKind
    effect: Any
    channels: tuple[Channel, ...]


class ActuationTerm(NamedTuple):
    """A vehicle's actuators: their functions and numbers."""

    actuation: Actuation
    channels: Any
    effects: Any

    def force_at(self, step: float) -> ForceTerm:
        """Return the force for a step size [s], with the actuators at rest."""
        rest = self.actuation.rest
        numbers = Actuators(self.channels, self.effects, step, Transient(rest, rest, 0.0))
        moving = self.actuation.uses_velocity
        return ForceTerm(NAME, self.actuation.force, numbers, uses_velocity=moving, uses_pose=moving)


def actuation_term(vehicle: Vehicle) -> ActuationTerm:
    """Return a vehicle's actuators as a step takes them.

    Raises:
        InvalidInputError: the vehicle's file tells the thrust of none.
    """
    parts = actuator_parts(vehicle)
    if not parts:
        raise InvalidInputError(
            f"vehicle {vehicle.name!r} has no actuators whose force is known; add thrust_forward and thrust_reverse "
            'to its [[thrusters]], or [[fins]], or drive it with actuation="wrench"'
        )
    return ActuationTerm(
        make_actuation(tuple(part.kind for part in parts)),
        nested([channel for part in parts for channel in part.channels]),
        nested([part.effect for part in parts]),
    )


def actuator_parts(vehicle: Vehicle) -> tuple[ActuatorPart, ...]:
    """Return a vehicle's actuators one by one, in the order of their channels; none of those without a known force."""
    actuators = vehicle.actuators
    parts = [
        *map(_thruster, actuators.thrusters),
        *map(_azimuth, actuators.azimuths),
        *map(_fin, actuators.fins),
    ]
    if actuators.manoeuvring is not None:
        parts.append(_stern(actuators.manoeuvring, vehicle.buoyancy.water_density))
    if actuators.whole_ship is not None:
        parts.append(_whole_ship_rudder(actuators.whole_ship, vehicle.buoyancy.water_density))
    return tuple(parts)


def _thruster(thruster: Thruster) -> ActuatorPart:
    direction, position = np.array(thruster.unit_direction), np.array(thruster.position)
    axis = _spatial(direction, np.cross(position, direction))
    turned = np.cross(position, direction) + thruster.torque_over_thrust * direction
    propeller, wrench = Propeller(*thruster.gains), _spatial(direction, turned)
    shaft = _shaft(thruster)
    if thruster.inflow == 0.0:
        kind = ActuatorKind(FIXED_THRUSTER, (shaft.kind,))
        return ActuatorPart(kind, FixedThruster(propeller, wrench), (shaft.numbers,))
    effect = ThrusterInFlow(propeller, wrench, thruster.inflow, axis)
    return ActuatorPart(ActuatorKind(THRUSTER_IN_FLOW, (shaft.kind,)), effect, (shaft.numbers,))


def _azimuth(azimuth: Azimuth) -> ActuatorPart:
    shaft = _shaft(azimuth)
    rate = azimuth.angle_rate_limit_deg_s
    angle = _channel(
        azimuth.angle_limit,
        azimuth.angle_time_constant,
        None if rate is None else math.radians(rate),
        turns=azimuth.angle_limit_deg is None,
    )
    return ActuatorPart(
        ActuatorKind(AZIMUTH_THRUSTER, (shaft.kind, angle.kind)),
        AzimuthThruster(Propeller(*azimuth.gains), azimuth.position),
        (shaft.numbers, angle.numbers),
    )


def _fin(fin: Fin) -> ActuatorPart:
    rate = fin.rate_limit_deg_s
    deflection = _channel(fin.limit, fin.time_constant, None if rate is None else math.radians(rate))
    kind = ActuatorKind(FIN, (deflection.kind,))
    return ActuatorPart(kind, FinEffect(from_fossen(fin.coefficients)), (deflection.numbers,))


def _stern(tables: Manoeuvring, density: float) -> ActuatorPart:
    """Return propeller and rudder of the MMG model: one actuator, as the rudder lies in the race."""
    term, propeller, rudder = stern_term(tables, density), tables.propeller, tables.rudder
    follow, dynamics = _following(propeller.time_constant, propeller.rate_limit)
    shaft = ChannelPart(
        ChannelKind(limited_target, follow), Channel(0.0, propeller.speed_limit, 0.0, dynamics)
    )
    rate = rudder.rate_limit_deg_s
    angle = _channel(rudder.limit, rudder.time_constant, None if rate is None else math.radians(rate))
    effect = EffectKind(term.wrench, channels=2, uses_velocity=True)
    return ActuatorPart(
        ActuatorKind(effect, (shaft.kind, angle.kind)), term.numbers, (shaft.numbers, angle.numbers)
    )


def _whole_ship_rudder(tables: WholeShip, density: float) -> ActuatorPart:
    """Return the rudder that is in the polynomials of a ship."""
    term, rudder = rudder_term(tables, density), tables.rudder
    rate = rudder.rate_limit_deg_s
    angle = _channel(rudder.limit, rudder.time_constant, None if rate is None else math.radians(rate))
    effect = EffectKind(term.wrench, channels=1, uses_velocity=True)
    return ActuatorPart(ActuatorKind(effect, (angle.kind,)), term.numbers, (angle.numbers,))


def _shaft(propulsion: Propulsion) -> ChannelPart:
    follow, dynamics = _following(propulsion.time_constant, propulsion.rate_limit)
    numbers = Channel(propulsion.low, propulsion.high, propulsion.dead_band, dynamics)
    return ChannelPart(ChannelKind(limited_target, follow), numbers)


def _channel(limit: float, time_constant: float, rate: float | None, *, turns: bool = False) -> ChannelPart:
    follow, dynamics = _following(time_constant, rate)
    kind = ChannelKind(turning_target if turns else limited_target, follow)
    return ChannelPart(kind, Channel(-limit, limit, 0.0, dynamics))


def _following(time_constant: float, rate: float | None) -> tuple[Any, Any]:
    """Return the function and the parameters of how a channel follows: the cheapest that has all of it."""
    if rate is None:
        return (follow_with_lag, Lag(time_constant)) if time_constant else (follow_at_once, ())
    if time_constant:
        return follow_with_lagged_slew, LaggedSlew(time_constant, rate)
    return follow_with_slew, Slew(rate)


def _spatial(force: Any, moment: Any) -> Spatial:
    return from_fossen((*force.tolist(), *moment.tolist()))
