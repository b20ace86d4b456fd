"""From solids to what the step computes of them, nothing where there are none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.nesting import nested
from dq_marine.integrator.contact import (
    Contact,
    ContactParameters,
    HullSpheres,
    Surface,
    make_contact,
)
from dq_marine.physics.contact.formulas import make_placed
from dq_marine.physics.contact.hull import hull_spheres
from dq_marine.physics.contact.solid import Solid

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SWING = 20.0
"""Natural frequency of a vehicle on one place of contact, where a solid has no stiffness of its own [rad/s]."""

LEAVING = 1.0
"""Speed at which a critically damped surface pushes out what began deep in it, at most [m/s]."""


class ContactTerm(NamedTuple):
    """What contact does.

    Attributes:
        name: of the term; empty if nothing is solid.
        contact: the pure function; None if nothing is.
        parameters: its numbers.
    """

    name: str
    contact: Contact | None
    parameters: Any


NOTHING_SOLID = ContactTerm("", None, ())


def contact_term(vehicle: Vehicle, solids: Sequence[Solid]) -> ContactTerm:
    """Return what the step computes of solids for a vehicle."""
    if not solids:
        return NOTHING_SOLID
    return contact_of(hull_spheres(vehicle), vehicle.mass_matrix, solids)


def contact_of(
    spheres: HullSpheres, mass_matrix: NDArray[np.float64], solids: Sequence[Solid]
) -> ContactTerm:
    """Return what the step computes of solids, one or more, for a hull with a mass matrix in Fossen's order."""
    mass = float(np.linalg.eigvalsh(mass_matrix[:3, :3])[-1])
    distances = tuple(make_placed(solid.shape.distance) for solid in solids)
    surfaces = [_surface(solid, mass) for solid in solids]
    return ContactTerm("contact", make_contact(distances), ContactParameters(spheres, nested(surfaces)))


def _surface(solid: Solid, mass: float) -> Surface:
    """Return how a solid pushes back a vehicle, whose mass is the largest of any direction, with that of the water."""
    stiffness = mass * SWING**2 if solid.stiffness is None else solid.stiffness
    damping = 2.0 * solid.damping_ratio * (stiffness * mass) ** 0.5
    # A spring k d and a damper 2 sqrt(k m) push out at (d/2) sqrt(k/m); what hits at twice that speed goes less deep.
    deepest = 2.0 * LEAVING * (mass / stiffness) ** 0.5
    return Surface(solid.place, stiffness, damping, solid.friction, deepest)
