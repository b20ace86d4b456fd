"""The vehicle model: what a vehicle file says, checked, with the matrices that follow from it.

Body frame forward-starboard-down, everything about the body origin (CO), SI units. 6-vectors and 6x6 matrices
in Fossen's order (surge, sway, heave, roll, pitch, yaw). Notation after Fossen (2021), Handbook of Marine
Craft Hydrodynamics and Motion Control.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.physics.actuators.tables import ActuatorSet, Azimuth, ChannelSheet, Fin, Thruster
from dq_marine.physics.constants import GRAVITY
from dq_marine.physics.damping.blended_table import BlendedDamping
from dq_marine.physics.damping.coupling_table import DampingCoupling, coupling_tensor
from dq_marine.physics.damping.cross_flow_table import CrossFlow
from dq_marine.physics.fields import (
    MOTIONS,
    Matrix3,
    Matrix6,
    NonNegative6,
    Positive,
    Share6,
    Table,
    Vector3,
    Vector6,
)
from dq_marine.physics.gravity import checked_gravity
from dq_marine.physics.hydrostatics.tables import HullBox, Hydrostatics, Payload
from dq_marine.physics.manoeuvring.tables import Manoeuvring
from dq_marine.physics.matrices import skew
from dq_marine.physics.waves.radiation import RadiationTable
from dq_marine.vehicles.appearance import Appearance
from dq_marine.vehicles.checks.plausibility import check_vehicle
from dq_marine.vehicles.validity import Validity


class RigidBody(Table):
    """The dry body.

    Attributes:
        mass: m [kg].
        center_of_mass: r_G [m].
        inertia: moments and products of inertia [kg m^2]: three numbers or a 3x3 matrix.
        inertia_about: the point that `inertia` refers to.
    """

    mass: Positive
    center_of_mass: Vector3 = (0.0, 0.0, 0.0)
    inertia: Matrix3
    inertia_about: Literal["body_origin", "center_of_mass"]


class Buoyancy(Table):
    """The displaced water.

    Attributes:
        volume: displaced volume [m^3].
        center: centre of buoyancy r_B [m].
        water_density: density of the water that all coefficients hold for [kg/m^3].
    """

    volume: Positive
    center: Vector3
    water_density: Positive = 1000.0


class Damping(Table):
    """Hydrodynamic damping, positive where it takes energy.

    Attributes:
        linear: six numbers or a 6x6 matrix [N s/m, N s, N m s].
        quadratic: coefficients of |nu_i| nu_i [N s^2/m^2, N m s^2].
        couplings: forces by other velocities and speeds: drag that couples axes, lift.
        blended: linear damping at rest that gives way to quadratic, or to none, under way.
        wave_share: how much of each number on the diagonal of `linear` stands for the waves that the hull makes, from 0
            to 1; None where it is not known. Radiation memory, see `dq_marine.Scene`, takes its place.
    """

    linear: Matrix6
    quadratic: NonNegative6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    couplings: tuple[DampingCoupling, ...] = ()
    blended: tuple[BlendedDamping, ...] = ()
    wave_share: Share6 | None = None


class Limits(Table):
    """The largest force and moment of the actuators.

    Attributes:
        wrench: largest force and moment of each axis [N, N m]; 0 where the vehicle is not actuated.
    """

    wrench: NonNegative6


class Dimensions(Table):
    """Overall size and kind of hull, for drawing and for plausibility checks.

    Attributes:
        length: along x [m].
        width: along y [m].
        height: along z [m].
        draft: depth of the keel below the body origin [m], for drawing; half the height if left out.
        shape: the kind of hull to draw.
    """

    length: Positive
    width: Positive
    height: Positive
    draft: Positive | None = None
    shape: Literal["open_frame", "torpedo", "ellipsoid", "catamaran", "ship"]


class Vehicle(Table):
    """A marine vehicle, as its file describes it.

    Attributes:
        name: as people call it.
        description: one sentence.
        sources: where the numbers come from, most important first.
        rigid_body: mass and its distribution.
        buoyancy: displaced water.
        added_mass: M_A, six numbers or a 6x6 matrix [kg, kg m, kg m^2]; minus the hydrodynamic derivatives.
        added_mass_asymmetry: how far `added_mass` as published is from symmetric, at most: |A_ij - A_ji| over
            sqrt(M_ii M_jj). It must be said where it is more than rounding; the symmetric part is what is used.
        damping: linear and quadratic, with couplings.
        cross_flow: drag of strips along the hull, besides.
        limits: of the actuators.
        dimensions: overall size.
        thrusters: propellers on fixed axes.
        azimuths: propellers whose axes turn.
        fins: rudders and planes.
        manoeuvring: the MMG model of a ship: its hull, and its propeller and rudder as one actuator.
        whole_ship: polynomials about a ship's service speed, its propeller and its rudder in them.
        hydrostatics: of a vessel that floats; None for one that is under water altogether.
        hull: boxes that displace water at any depth and attitude; needed for `Scene(hydrostatics="hull")` alone.
        payloads: weights that act besides.
        radiation: added mass and damping by frequency, for the forces of seas and for radiation memory; a file names a
            CSV file beside it.
        validity: the motions and seas that the numbers hold for; None where it is not known.
        appearance: a mesh to draw; None for a picture by the kind of hull.
        gravity: g [m/s^2], for weight and buoyancy, and for the lengths of waves; a stiffness in N/m holds for it.
    """

    name: str = Field(min_length=1)
    description: str
    sources: tuple[str, ...] = Field(min_length=1)
    rigid_body: RigidBody
    buoyancy: Buoyancy
    added_mass: Matrix6
    added_mass_asymmetry: Annotated[float, Field(ge=0.0, le=0.1)] = 0.0
    damping: Damping
    cross_flow: tuple[CrossFlow, ...] = ()
    limits: Limits
    dimensions: Dimensions
    thrusters: tuple[Thruster, ...] = ()
    azimuths: tuple[Azimuth, ...] = ()
    fins: tuple[Fin, ...] = ()
    manoeuvring: Manoeuvring | None = None
    whole_ship: WholeShip | None = None
    hydrostatics: Hydrostatics | None = None
    hull: tuple[HullBox, ...] = ()
    payloads: tuple[Payload, ...] = ()
    radiation: RadiationTable | None = None
    validity: Validity | None = None
    appearance: Appearance | None = None
    gravity: float = GRAVITY

    @model_validator(mode="before")
    @classmethod
    def _complete(cls, content: Any) -> Any:
        """Give a table of radiation the vehicle's own added mass at infinite frequency, where it has none."""
        if (
            not isinstance(content, Mapping)
            or content.get("radiation") is None
            or "added_mass" not in content
        ):
            return content
        table = content["radiation"]
        given = dict(table) if isinstance(table, RadiationTable | Mapping) else {}
        if not given or given.get("infinite") is not None:
            return content
        return {**content, "radiation": {**given, "infinite": content["added_mass"]}}

    @model_validator(mode="after")
    def _plausible(self) -> Self:
        check_vehicle(self)
        return self

    def in_gravity(self, gravity: float) -> Vehicle:
        """Return the vehicle under another gravity, or itself if it is the same.

        Weight, payloads and buoyancy change with it, and so does a stiffness that its file has in N/m. Forces of
        actuators and tables by frequency stay as they are.

        Args:
            gravity: g [m/s^2].

        Raises:
            InvalidInputError: it is no number from 0.1 to 30.
        """
        wanted = checked_gravity(gravity)
        if wanted == self.gravity:
            return self
        changed: dict[str, Any] = {"gravity": wanted}
        if self.hydrostatics is not None:
            changed["hydrostatics"] = self.hydrostatics.times(wanted / self.gravity)
        return Vehicle.model_validate(dict(self) | changed)

    @property
    def weight(self) -> float:
        """W = m g [N]."""
        return self.rigid_body.mass * self.gravity

    @property
    def specific_weight(self) -> float:
        """Specific weight of the water, rho g [N/m^3]."""
        return self.buoyancy.water_density * self.gravity

    @property
    def buoyant_force(self) -> float:
        """B = rho g V [N]."""
        return self.specific_weight * self.buoyancy.volume

    @property
    def waterplane_stiffness(self) -> NDArray[np.float64] | None:
        """C of heave, roll and pitch about the body origin, shape (3, 3) [N/m, N, N m]; None if it does not float."""
        if self.hydrostatics is None:
            return None
        return self.hydrostatics.stiffness_about_origin(self.specific_weight, self.buoyant_force)

    @property
    def equilibrium_depth(self) -> float:
        """Depth of the body origin of a vessel at rest [m]; 0 if it does not float."""
        return 0.0 if self.hydrostatics is None else self.hydrostatics.equilibrium_depth

    @property
    def payload_weight(self) -> float:
        """Weight of all payloads [N]."""
        return self.gravity * sum(payload.mass for payload in self.payloads)

    @property
    def payload_moment(self) -> NDArray[np.float64]:
        """First moment of the payloads' weights about the body origin [N m], shape (3,)."""
        moments = [payload.mass * np.array(payload.position) for payload in self.payloads]
        return np.asarray(self.gravity * np.sum([np.zeros(3), *moments], axis=0))

    @property
    def rigid_body_matrix(self) -> NDArray[np.float64]:
        """M_RB about the body origin, shape (6, 6) (Fossen 2021, ch. 3)."""
        mass = self.rigid_body.mass
        s = skew(np.array(self.rigid_body.center_of_mass))
        inertia = np.array(self.rigid_body.inertia)
        if self.rigid_body.inertia_about == "center_of_mass":
            inertia = inertia - mass * s @ s
        return np.array(np.block([[mass * np.eye(3), -mass * s], [mass * s, inertia]]))

    @property
    def added_mass_matrix(self) -> NDArray[np.float64]:
        """The symmetric part of M_A, shape (6, 6)."""
        added = np.array(self.added_mass)
        return np.asarray(0.5 * (added + added.T))

    @property
    def mass_matrix(self) -> NDArray[np.float64]:
        """M = M_RB + M_A, with the symmetric part of M_A, shape (6, 6)."""
        return np.asarray(self.rigid_body_matrix + self.added_mass_matrix)

    @property
    def linear_damping(self) -> NDArray[np.float64]:
        """Linear damping matrix, shape (6, 6)."""
        return np.array(self.damping.linear)

    @property
    def linear_damping_without_waves(self) -> NDArray[np.float64]:
        """Linear damping matrix without the part that stands for the waves that the hull makes, shape (6, 6).

        Couplings go in proportion, so that what is left takes energy.
        """
        left = np.sqrt(1.0 - np.array(self.damping.wave_share or (0.0,) * 6))
        return np.asarray(left[:, None] * self.linear_damping * left)

    @property
    def damping_at_rest(self) -> NDArray[np.float64]:
        """Linear damping matrix of small motions without way on: with the linear part of blends, shape (6, 6)."""
        damping = self.linear_damping
        for blended in self.damping.blended:
            damping[blended.index, blended.index] += blended.linear
        return damping

    @property
    def quadratic_damping(self) -> NDArray[np.float64]:
        """Quadratic damping coefficients, shape (6,)."""
        return np.array(self.damping.quadratic)

    @property
    def damping_couplings(self) -> NDArray[np.float64]:
        """C of the forces -sum_jk c_ijk |nu_k| nu_j on axes i, shape (6, 6, 6)."""
        return coupling_tensor(one for one in self.damping.couplings if not one.signed)

    @property
    def signed_damping_couplings(self) -> NDArray[np.float64]:
        """C of the forces -sum_jk c_ijk nu_k nu_j on axes i, shape (6, 6, 6)."""
        return coupling_tensor(one for one in self.damping.couplings if one.signed)

    @property
    def restoring_arm(self) -> NDArray[np.float64]:
        """W r_G - B r_B [N m], shape (3,): its product with the direction of down is the righting moment."""
        return self.weight * np.array(self.rigid_body.center_of_mass) - self.buoyant_force * np.array(
            self.buoyancy.center
        )

    @property
    def wrench_limits(self) -> NDArray[np.float64]:
        """Largest force and moment of each axis [N, N m], shape (6,)."""
        return np.array(self.limits.wrench)

    @property
    def actuators(self) -> ActuatorSet:
        """The actuators whose forces are known: without thrusters that are for drawing only."""
        driven = tuple(thruster for thruster in self.thrusters if thruster.driven)
        return ActuatorSet(driven, self.azimuths, self.fins, self.manoeuvring, self.whole_ship)

    @property
    def channels(self) -> tuple[ChannelSheet, ...]:
        """Channels that take commands, in the order of `ActuatorSet.channels`."""
        return self.actuators.channels

    @property
    def allocation_matrix(self) -> NDArray[np.float64]:
        """Wrench of unit thrusts, shape (6, n): of each thruster, then along x and y of each azimuth."""
        return self.actuators.thrust_matrix


__all__ = [
    "MOTIONS",
    "Azimuth",
    "Buoyancy",
    "Damping",
    "Dimensions",
    "Fin",
    "Limits",
    "RigidBody",
    "Thruster",
    "Vector6",
    "Vehicle",
]
