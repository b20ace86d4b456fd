"""Vehicles with a closed form: homogeneous ellipsoids in unbounded water."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import finite_array, finite_number, shown
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles.analysis.lamb import ellipsoid_added_mass, ellipsoid_volume, squared_gyration_radii
from dq_marine.vehicles.model import Vehicle
from dq_marine.vehicles.validation import validated

LAMB = "Lamb, H. (1932). Hydrodynamics, 6th ed., secs. 114 and 115: added mass of an ellipsoid in unbounded water."

UNDAMPED = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def ellipsoid(
    a: float,
    b: float,
    c: float,
    *,
    mass: float | None = None,
    water_density: float = 1000.0,
    center_of_mass: Sequence[float] = (0.0, 0.0, 0.0),
    linear_damping: ArrayLike = UNDAMPED,
    quadratic_damping: Sequence[float] = UNDAMPED,
    wrench_limits: Sequence[float] | None = None,
    name: str | None = None,
) -> Vehicle:
    """Return an ellipsoid as a vehicle; its body origin is its centre, which is that of buoyancy, too.

    Args:
        a: semi-axis along x [m].
        b: along y [m].
        c: along z [m].
        mass: of the dry body [kg]; None for neutral buoyancy. Its moments of inertia about its centre of mass are those
            of a homogeneous ellipsoid.
        water_density: [kg/m^3].
        center_of_mass: [m], shape (3,): below the centre (z > 0) the body rights itself.
        linear_damping: six numbers or a 6x6 matrix [N s/m, N s, N m s]; none unless given: an ideal fluid.
        quadratic_damping: coefficients of |nu_i| nu_i, shape (6,) [N s^2/m^2, N m s^2].
        wrench_limits: largest force and moment of each axis, shape (6,) [N, N m]; None for those that give the body and
            its added mass 1 m/s^2 and 1 rad/s^2.
        name: None for one that tells the axes.

    Raises:
        InvalidInputError: a value is wrong, with the value, the limit and the remedy.
    """
    a, b, c = (finite_number(key, value, above=0.0) for key, value in (("a", a), ("b", b), ("c", c)))
    density = finite_number("water_density", water_density, above=0.0)
    volume = ellipsoid_volume(a, b, c)
    dry = density * volume if mass is None else finite_number("mass", mass, above=0.0)
    added = ellipsoid_added_mass(a, b, c, density)
    inertia = dry * squared_gyration_radii(a, b, c)
    if wrench_limits is None:
        wrench_limits = (np.concatenate([[dry] * 3, inertia]) + added).tolist()
    shown = name if name is not None else f"Ellipsoid {2.0 * a:g} x {2.0 * b:g} x {2.0 * c:g} m"
    content = {
        "name": shown,
        "description": "Homogeneous ellipsoid in unbounded water",
        "sources": [LAMB],
        "added_mass": added.tolist(),
        "rigid_body": {
            "mass": dry,
            "center_of_mass": finite_array("center_of_mass", center_of_mass, 3).tolist(),
            "inertia": inertia.tolist(),
            "inertia_about": "center_of_mass",
        },
        "buoyancy": {"volume": volume, "center": [0.0, 0.0, 0.0], "water_density": density},
        "damping": {
            "linear": _damping_rows(linear_damping).tolist(),
            "quadratic": finite_array("quadratic_damping", quadratic_damping, 6).tolist(),
        },
        "limits": {"wrench": finite_array("wrench_limits", wrench_limits, 6).tolist()},
        "dimensions": {"length": 2.0 * a, "width": 2.0 * b, "height": 2.0 * c, "shape": "ellipsoid"},
    }
    return validated(content, shown)


def spheroid(
    a: float,
    b: float,
    *,
    mass: float | None = None,
    water_density: float = 1000.0,
    center_of_mass: Sequence[float] = (0.0, 0.0, 0.0),
    linear_damping: ArrayLike = UNDAMPED,
    quadratic_damping: Sequence[float] = UNDAMPED,
    wrench_limits: Sequence[float] | None = None,
    name: str | None = None,
) -> Vehicle:
    """Return an ellipsoid of revolution about x as a vehicle: prolate (a > b), a sphere or oblate (a < b).

    Args:
        a: semi-axis along x [m].
        b: along y and z [m].
        mass: see `ellipsoid`, as for the others.
        water_density: [kg/m^3].
        center_of_mass: [m], shape (3,).
        linear_damping: six numbers or a 6x6 matrix [N s/m, N s, N m s].
        quadratic_damping: shape (6,) [N s^2/m^2, N m s^2].
        wrench_limits: shape (6,) [N, N m].
        name: None for one that tells the axes.

    Raises:
        InvalidInputError: a value is wrong, with the value, the limit and the remedy.
    """
    b = finite_number("b", b, above=0.0)
    return ellipsoid(
        a,
        b,
        b,
        mass=mass,
        water_density=water_density,
        center_of_mass=center_of_mass,
        linear_damping=linear_damping,
        quadratic_damping=quadratic_damping,
        wrench_limits=wrench_limits,
        name=name,
    )


def _damping_rows(value: ArrayLike) -> NDArray[np.float64]:
    """Return a damping matrix from six numbers or six rows of six, shape (6, 6)."""
    try:
        rows = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(
            f"linear_damping = {shown(value)} is not numeric; give six numbers or a 6x6 matrix"
        ) from error
    if rows.shape not in ((6,), (6, 6)):
        raise InvalidInputError(f"linear_damping has shape {rows.shape}; give shape (6,) or (6, 6)")
    finite = finite_array("linear_damping", rows.ravel(), rows.size).reshape(rows.shape)
    return np.diag(finite) if finite.ndim == 1 else finite
