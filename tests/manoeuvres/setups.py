"""Vehicles whose manoeuvres have a closed form: spheres, whose added mass is the same along all axes."""

from __future__ import annotations

import numpy as np

from dq_marine.vehicles import Vehicle, ellipsoid

LINEAR = (400.0, 900.0, 900.0, 60.0, 60.0, 80.0)
LIMITS = (800.0, 0.0, 600.0, 0.0, 200.0, 60.0)


def sphere(linear=LINEAR, quadratic=(0.0,) * 6, limits=LIMITS):
    """A sphere of 1 m that nothing rights."""
    return ellipsoid(
        0.5, 0.5, 0.5, linear_damping=linear, quadratic_damping=quadratic, wrench_limits=limits, name="Sphere"
    )


def righted_sphere(linear=LINEAR, height=0.02):
    """The same with its centre of buoyancy above its centre of mass: M stays diagonal."""
    content = sphere(linear).model_dump()
    content["buoyancy"]["center"] = (0.0, 0.0, -height)
    return Vehicle.model_validate(content)


def spindle(linear, quadratic=(0.0,) * 6):
    """A slender body that the Munk moment turns away from its course."""
    return ellipsoid(
        1.0, 0.2, 0.2, linear_damping=linear, quadratic_damping=quadratic, wrench_limits=(60, 0, 60, 0, 60, 40),
        name="Spindle",
    )  # fmt: skip


def mass_of(vehicle):
    """The diagonal of M, which has nothing else."""
    assert np.allclose(vehicle.mass_matrix, np.diag(np.diag(vehicle.mass_matrix)))
    return np.diag(vehicle.mass_matrix)
