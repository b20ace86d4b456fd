"""Vehicles with random numbers around those of the BlueROV2 Heavy, each another."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle, load_vehicle
from suite.bodies import VEHICLE

SPREAD = 0.2
"""Of scattered numbers, relative."""

WIDE_SPREAD = 0.4
COUPLED_LINEAR_DAMPING = (13.7, 13.7, 33.0, 0.5, 0.8, 0.5)
"""Diagonal around which coupled damping is scattered: the Heavy's, with something in every axis [N s/m, N m s]."""

OFFSET = 0.01
"""Largest offset of a coupled vehicle's centres along each axis [m]."""

NET_BUOYANCY = 0.03
"""Largest net weight or buoyancy of a coupled vehicle, relative to its weight."""

Array = NDArray[np.float64]
Content = dict[str, Any]


def scattered_vehicles(count: int) -> list[Vehicle]:
    """Return vehicles that have the Heavy's terms, with numbers of their own."""
    return [Vehicle.model_validate(scattered(base, rng)) for base, rng in drawn(count)]


def coupled_vehicles(count: int) -> list[Vehicle]:
    """Return vehicles whose every axis is coupled to every other, in inertia, added mass and damping."""
    return [Vehicle.model_validate(coupled(base, rng)) for base, rng in drawn(count)]


def drawn(count: int) -> Iterator[tuple[Content, np.random.Generator]]:
    """Yield the Heavy's content with one generator, as often as asked for."""
    base, rng = load_vehicle(VEHICLE).model_dump(), np.random.default_rng(0)
    for _ in range(count):
        yield base, rng


def scattered(base: Content, rng: np.random.Generator) -> Content:
    """Return a vehicle's content with every number that is not zero scattered; weight stays to buoyancy as it was."""
    size = float(rng.uniform(1.0 - SPREAD, 1.0 + SPREAD))
    body, water, damping = base["rigid_body"], base["buoyancy"], base["damping"]
    moments = around(moments_of(body), SPREAD, rng)
    return base | {
        "rigid_body": body | {"mass": size * body["mass"], "inertia": inertia_of(moments).tolist()},
        "buoyancy": water
        | {"volume": size * water["volume"], "center": around(water["center"], SPREAD, rng).tolist()},
        "added_mass": around(np.diag(base["added_mass"]), SPREAD, rng).tolist(),
        "damping": damping
        | {
            "linear": around(np.diag(damping["linear"]), SPREAD, rng).tolist(),
            "quadratic": around(damping["quadratic"], SPREAD, rng).tolist(),
            "couplings": couplings_around(damping["couplings"], SPREAD, rng),
        },
    }


def coupled(base: Content, rng: np.random.Generator) -> Content:
    """Return a vehicle's content scattered widely, with full matrices and centres off the axes."""
    size = float(rng.uniform(1.0 - WIDE_SPREAD, 1.0 + WIDE_SPREAD))
    body, water, damping = base["rigid_body"], base["buoyancy"], base["damping"]
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    moments = around(size * moments_of(body), WIDE_SPREAD, rng)
    volume = size * water["volume"] * float(rng.uniform(1.0 - NET_BUOYANCY, 1.0 + NET_BUOYANCY))
    added_mass = around(size * np.diag(base["added_mass"]), WIDE_SPREAD, rng)
    linear = around(COUPLED_LINEAR_DAMPING, WIDE_SPREAD, rng)
    return base | {
        "rigid_body": body
        | {
            "mass": size * body["mass"],
            "center_of_mass": offset(body["center_of_mass"], rng),
            "inertia": symmetric(axes @ np.diag(inertia_of(moments)) @ axes.T).tolist(),
        },
        "buoyancy": water | {"volume": volume, "center": offset(water["center"], rng)},
        "added_mass": with_diagonal(added_mass, rng).tolist(),
        "damping": damping
        | {
            "linear": with_diagonal(linear, rng).tolist(),
            "quadratic": around(damping["quadratic"], WIDE_SPREAD, rng).tolist(),
            "couplings": couplings_around(damping["couplings"], WIDE_SPREAD, rng),
        },
    }


def around(numbers: Any, spread: float, rng: np.random.Generator) -> Array:
    """Return numbers times factors between 1 - spread and 1 + spread."""
    values = np.array(numbers, dtype=float)
    return values * rng.uniform(1.0 - spread, 1.0 + spread, values.shape)


def couplings_around(couplings: Any, spread: float, rng: np.random.Generator) -> list[Content]:
    """Return the tables of couplings, each coefficient scattered."""
    return [one | {"coefficient": float(around(one["coefficient"], spread, rng))} for one in couplings]


def offset(point: Any, rng: np.random.Generator) -> list[float]:
    """Return a point moved a little."""
    return (np.array(point) + rng.uniform(-OFFSET, OFFSET, 3)).tolist()


def moments_of(body: Content) -> Array:
    """Return the second moments of mass of a body along its axes: whatever they are, the inertia is a body's."""
    inertia = np.diag(body["inertia"])
    return 0.5 * inertia.sum() - inertia


def inertia_of(moments: Array) -> Array:
    """Return the moments of inertia that follow from second moments of mass."""
    return moments.sum() - moments


def with_diagonal(diagonal: Array, rng: np.random.Generator) -> Array:
    """Return a random symmetric positive definite matrix with the given diagonal."""
    factor = rng.normal(size=(len(diagonal), len(diagonal)))
    definite = factor @ factor.T / len(diagonal) + np.eye(len(diagonal))
    scale = np.sqrt(diagonal / np.diag(definite))
    return symmetric(definite * np.outer(scale, scale))


def symmetric(matrix: Array) -> Array:
    """Return the symmetric part."""
    return 0.5 * (matrix + matrix.T)
