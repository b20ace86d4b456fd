"""A propeller and the rudder in its race, by the MMG model.

Yasukawa and Yoshimura (2015), eqs. 9 to 24; (P6) to (P15) are those of docs/theory.md. The published quotients by the
advance ratio J and by the speed U are multiplied out, so that nothing is divided by what may be zero.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import arctangent, sine_and_cosine
from dq_marine.algebra.selection import select, smallest_normal
from dq_marine.algebra.spatial import Spatial


class ThrustCurve(NamedTuple):
    """k_0, k_1 and k_2 of K_T(J)."""

    constant: float
    slope: float
    curvature: float


class ShipPropeller(NamedTuple):
    """The numbers of a propeller.

    Attributes:
        curve: of K_T(J).
        wake: as its formula wants it.
        diameter: D_P [m].
        share: 1 - t_P, of its thrust that is left for the ship.
        position: x'_P, its lever for beta_P over the length.
        density: of the water [kg/m^3].
        depth: z of its shaft [m].
    """

    curve: ThrustCurve
    wake: Any
    diameter: float
    share: float
    position: float
    density: float
    depth: float


class ShipRudder(NamedTuple):
    """The numbers of a rudder.

    Attributes:
        pressure: rho A_R f_alpha/2: normal force over the square of a speed and the sine of an angle [kg/m].
        wetted: eta, the share of its height in the race.
        acceleration: kappa, the share of the race's gain in speed that reaches it.
        inflow: epsilon, the wake's ratio between rudder and propeller.
        straightening_positive: gamma_R where beta_R is positive.
        straightening_negative: gamma_R elsewhere.
        lever: l'_R, for beta_R over the length.
        surge: 1 - t_R.
        sway: 1 + a_H.
        yaw: x_R + a_H x_H [m].
        depth: z of its centre [m].
    """

    pressure: float
    wetted: float
    acceleration: float
    inflow: float
    straightening_positive: float
    straightening_negative: float
    lever: float
    surge: float
    sway: float
    yaw: float
    depth: float


class Stern(NamedTuple):
    """Propeller, rudder, the ship's length [m], and the largest |r'| that the wake knows."""

    propeller: ShipPropeller
    rudder: ShipRudder
    length: float
    turn: float


def thrust_of_propeller(propeller: ShipPropeller, speed: float, advance: float) -> float:
    """Return T at a shaft speed [1/s] and a speed of advance [m/s]: (P7)."""
    through = advance / propeller.diameter
    curve, squared = propeller.curve, propeller.diameter * propeller.diameter
    per_density = curve.constant * speed * speed + (curve.slope * speed + curve.curvature * through) * through
    return propeller.density * squared * squared * per_density


def rudder_inflow(own: ShipRudder, propeller: ShipPropeller, advance: float, thrust: float) -> float:
    """Return u_R from the speed of advance and the thrust: (P11), (P12)."""
    disc = math.pi * propeller.density * propeller.diameter * propeller.diameter
    race = math.sqrt(max(0.0, advance * advance + 8.0 * thrust / disc))
    behind = advance + own.acceleration * (race - advance)
    return own.inflow * math.sqrt(own.wetted * behind * behind + (1.0 - own.wetted) * advance * advance)


def rudder_crossflow(own: ShipRudder, speed: float, beta: float, round_speed: float) -> float:
    """Return v_R = U gamma_R beta_R with beta_R = beta - l'_R r', for L r: (P13)."""
    across = speed * beta - own.lever * round_speed
    return select(across < 0.0, own.straightening_negative, own.straightening_positive) * across


def rudder_normal_force(own: ShipRudder, ahead: float, across: float, sine: float, cosine: float) -> float:
    """Return F_N in a flow u_R, v_R, for the sine and cosine of the rudder's angle.

    This is (P14), with the sine of the difference of two angles written out.
    """
    size = math.sqrt(ahead * ahead + across * across)
    return own.pressure * size * (ahead * sine - across * cosine)


@functools.cache
def make_stern_wrench(inflow: Callable[[Any, float], float]) -> Callable[[Stern, Any, Spatial], Spatial]:
    """Return (stern, values, twist) -> wrench, for one form of the wake.

    The values are the shaft speed values[0] [rad/s] and the rudder's angle values[1][0] [rad], positive to turn the
    ship to starboard.
    """

    def stern_wrench(stern: Stern, values: Any, twist: Spatial) -> Spatial:
        propeller, rudder = stern.propeller, stern.rudder
        revolutions, angle = values[0] / (2.0 * math.pi), values[1][0]
        u, v, round_speed = twist.linear[0], twist.linear[1], stern.length * twist.angular[2]
        speed = math.sqrt(u * u + v * v)
        beta = arctangent(-v, abs(u))  # (P6)
        turn = round_speed / (speed + smallest_normal(speed))
        turn = max(-stern.turn, min(stern.turn, turn))
        advance = max(0.0, u) * inflow(propeller.wake, beta - propeller.position * turn)  # (P10)
        thrust = thrust_of_propeller(propeller, revolutions, advance)
        ahead = rudder_inflow(rudder, propeller, advance, thrust)
        across = rudder_crossflow(rudder, speed, beta, round_speed)
        sine, cosine = sine_and_cosine(angle)
        normal = rudder_normal_force(rudder, ahead, across, sine, cosine)
        lateral = -normal * cosine
        drive, drag = propeller.share * thrust, -rudder.surge * normal * sine  # (P15)
        y = rudder.sway * lateral
        pitch = propeller.depth * drive + rudder.depth * drag
        return Spatial((-rudder.depth * y, pitch, rudder.yaw * lateral), (drive + drag, y, 0.0))

    return stern_wrench
