"""The tables of a randomisation file, named like those of a vehicle file; what is not named stays as it is."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from dq_marine.physics.fields import NonNegative, Table
from dq_marine.randomisation.distributions import Angle, Factor, Factors3, Factors6, NetWeight, Offsets3

Coupling = Annotated[float, Field(ge=0.0, le=0.15)]
"""Largest correlation added between two axes: up to it, one plus a 6x6 matrix of them is diagonally dominant."""


class RigidBodyDraw(Table):
    """The dry body.

    Attributes:
        mass: factor.
        inertia: factors of the second moments of mass along the body axes, about the centre of mass; a factor of
            0.8 to 1.2 keeps each moment of inertia within the same. None: the inertia grows with the mass.
        inertia_coupling: of the second moments, which tilts the principal axes.
        center_of_mass: offsets [m]; the inertia about it stays.
    """

    mass: Factor | None = None
    inertia: Factors3 | None = None
    inertia_coupling: Coupling = 0.0
    center_of_mass: Offsets3 | None = None


class BuoyancyDraw(Table):
    """The displaced water.

    A vessel that floats displaces its weight in every draw: its volume and the width of its hull follow the mass;
    of what is below only `righting_lever` applies, to its metacentric heights.

    Attributes:
        volume: factor, independent of the mass, so that a neutral vehicle sinks or rises.
        net_weight: added to (W - B)/W; the volume follows the mass, as if ballasted.
        center: offsets of the centre of buoyancy [m], however short the vehicle's righting lever is.
        righting_lever: factor of the righting moment's lever, |W r_G - B r_B| / W; the centre of buoyancy follows.
        list_angle: roll at rest [deg], positive to starboard; the centre of buoyancy follows.
        trim_angle: pitch at rest [deg], positive bow up; the centre of buoyancy follows.
    """

    volume: Factor | None = None
    net_weight: NetWeight | None = None
    center: Offsets3 | None = None
    righting_lever: Factor | None = None
    list_angle: Angle | None = None
    trim_angle: Angle | None = None

    @property
    def places_center(self) -> bool:
        """Whether the centre of buoyancy follows from the attitude at rest."""
        return (self.righting_lever, self.list_angle, self.trim_angle) != (None, None, None)

    @model_validator(mode="after")
    def _no_contradiction(self) -> Self:
        if self.volume is not None and self.net_weight is not None:
            raise ValueError("volume and net_weight both set the volume; give one of them")
        if self.center is not None and self.places_center:
            raise ValueError(
                "center on the one hand, righting_lever, list_angle and trim_angle on the other set the centre of "
                "buoyancy; give one or the other"
            )
        return self


class AddedMassDraw(Table):
    """The added mass.

    Attributes:
        factor: of its six diagonal entries; another entry grows with the root of both factors.
        coupling: added between the axes.
    """

    factor: Factors6 | None = None
    coupling: Coupling = 0.0


class DampingDraw(Table):
    """Hydrodynamic damping.

    Attributes:
        linear: factors of the six diagonal entries; another entry grows with the root of both factors.
        linear_coupling: added between the axes that have linear damping; a matrix that was diagonal is then full, which
            costs time in the step.
        quadratic: factors of the six coefficients; a coupling grows with the root of the factors of its force's and its
            velocity's axes, cross-flow drag with the factor of sway or heave, blended damping with that of its axis
            (of `linear` where it has no quadratic part).
    """

    linear: Factors6 | None = None
    linear_coupling: Coupling = 0.0
    quadratic: Factors6 | None = None


class ActuatorsDraw(Table):
    """Factors of what the actuators deliver.

    Attributes:
        wrench: factors of the largest force and moment of each axis.
        thrust: factor of the thrust of every propeller, drawn separately for each.
        fins: factor of the force of every fin, drawn separately for each.
        lost: how many propellers, drawn anew for each vehicle, give nothing.
    """

    wrench: Factors6 | None = None
    thrust: Factor | None = None
    fins: Factor | None = None
    lost: Annotated[int, Field(ge=0, le=8)] = 0


class CurrentSpeed(Table):
    """The water, for environments.

    Attributes:
        speed: up to which every episode draws a horizontal current [m/s].
    """

    speed: NonNegative
