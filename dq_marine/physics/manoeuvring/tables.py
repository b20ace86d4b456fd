"""The MMG model of a ship in its vehicle file: hull, propeller and rudder.

Notation and numbers as published (Yasukawa and Yoshimura 2015): forces over rho/2 L d U^2, moments over
rho/2 L^2 d U^2, v' = v/U and r' = r L/U at midship, where the body origin must lie. The density is that of `buoyancy`.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from dq_marine.physics.fields import NonNegative, Positive, Table

Share = Annotated[float, Field(ge=0.0, lt=1.0)]


class SurgeTable(Table):
    """X': resistance R'_0, X'_vv, X'_vr, X'_rr and X'_vvvv."""

    resistance: Positive
    vv: float = 0.0
    vr: float = 0.0
    rr: float = 0.0
    vvvv: float = 0.0


class LateralTable(Table):
    """Y' or N': coefficients of v', r', v'^3, v'^2 r', v' r'^2 and r'^3."""

    v: float
    r: float
    vvv: float = 0.0
    vvr: float = 0.0
    vrr: float = 0.0
    rrr: float = 0.0


class ManoeuvringHullTable(Table):
    """The hull.

    Attributes:
        surge: X'.
        sway: Y'.
        yaw: N'.
        depth: z at which surge and sway force act [m].
        drift_limit_deg: drift angle up to which the polynomials are used; beyond it they are continued.
        turn_limit: |r'| up to which they are used.
    """

    surge: SurgeTable
    sway: LateralTable
    yaw: LateralTable
    depth: float = 0.0
    drift_limit_deg: Annotated[float, Field(ge=5.0, le=80.0)] = 40.0
    turn_limit: Annotated[float, Field(ge=0.1, le=5.0)] = 1.5


class TwoConstants(Table):
    """(1 - w_P)/(1 - w_P0) = 1 + (1 - exp(-C_1 |beta_P|)) (C_2 - 1).

    Attributes:
        form: of the wake.
        straight: w_P0.
        growth: C_1.
        most_positive: C_2 where beta_P is positive.
        most_negative: C_2 elsewhere.
    """

    form: Literal["two_constants"]
    straight: Share
    growth: NonNegative
    most_positive: Positive
    most_negative: Positive


class Gaussian(Table):
    """w_P = w_P0 exp(-decay beta_P^2).

    Attributes:
        form: of the wake.
        straight: w_P0.
        decay: 4 as usual.
    """

    form: Literal["gaussian"]
    straight: Share
    decay: NonNegative = 4.0


class PropellerTable(Table):
    """The propeller.

    Attributes:
        diameter: D_P [m].
        thrust: k_0, k_1, k_2 of K_T = k_0 + k_1 J + k_2 J^2.
        deduction: t_P.
        wake: w_P.
        position: x'_P, its lever for beta_P over the length.
        depth: z of the shaft [m].
        speed_limit: largest shaft speed ahead [rad/s]; the curve is not known astern.
        time_constant: of the first-order lag of the shaft speed [s]; 0 for none.
        rate_limit: largest rate of the shaft speed [rad/s^2].
    """

    diameter: Positive
    thrust: tuple[float, float, float]
    deduction: Share
    wake: Annotated[TwoConstants | Gaussian, Field(discriminator="form")]
    position: float
    depth: float = 0.0
    speed_limit: Positive
    time_constant: NonNegative = 0.0
    rate_limit: Positive | None = None


class RudderTable(Table):
    """The rudder.

    Attributes:
        area: A_R [m^2].
        height: H_R [m].
        lift_slope: f_alpha.
        surge_deduction: t_R.
        sway_increase: a_H.
        position: x'_R over the length.
        increase_position: x'_H over the length.
        straightening_positive: gamma_R where beta_R is positive.
        straightening_negative: gamma_R elsewhere.
        lever: l'_R over the length.
        inflow: epsilon.
        acceleration: kappa.
        depth: z of its centre [m].
        limit_deg: largest angle.
        rate_limit_deg_s: largest rate of the angle.
        time_constant: of the first-order lag of the angle [s]; 0 for none.
    """

    area: Positive
    height: Positive
    lift_slope: Positive
    surge_deduction: Share
    sway_increase: NonNegative
    position: float
    increase_position: float
    straightening_positive: Positive
    straightening_negative: Positive
    lever: float
    inflow: Positive
    acceleration: NonNegative
    depth: float = 0.0
    limit_deg: Annotated[float, Field(gt=0.0, le=90.0)]
    rate_limit_deg_s: Positive | None = None
    time_constant: NonNegative = 0.0

    @property
    def limit(self) -> float:
        """Largest angle [rad]."""
        return math.radians(self.limit_deg)


class Manoeuvring(Table):
    """The MMG model of a ship.

    Attributes:
        length: L between perpendiculars [m].
        draft: d [m].
        hull: its polynomials.
        propeller: on the centre line.
        rudder: in its race.
    """

    length: Positive
    draft: Positive
    hull: ManoeuvringHullTable
    propeller: PropellerTable
    rudder: RudderTable
