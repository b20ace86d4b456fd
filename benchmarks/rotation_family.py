"""Which rotation variable should stand for the twist? Four second-order variational steps on the same free bodies.

Run: python benchmarks/rotation_family.py

All four keep the spatial momentum and are symmetric; they differ in what of the increment f stands for h times the
twist:

    sin   the vector parts of f itself: Xu & Halse, scheme="paper"
    mrp   modified Rodrigues parameters in the midpoint frame: scheme="midpoint", the default
    tan   Cayley's map of SE(3), mu = dcay^-T M xi
    log   the exponential map of SE(3), mu = dexp^-T M xi

The table gives attitude errors [rad] at the end against Kirchhoff's equations by DOP853. The last two are written here
in NumPy, for accuracy only; what each costs is said by the operations that it needs.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from dq_marine.algebra.spatial import ANGULAR_FIRST
from dq_marine.errors import StepNotSolvableError
from dq_marine.physics.current.build import uniform_water
from dq_marine.physics.damping.build import DampingTerm
from dq_marine.physics.matrices import angular_first
from dq_marine.simulation.assembly import Assembly
from dq_marine.simulation.one_body import OneBody
from dq_marine.vehicles import load_vehicle

Array = NDArray[np.float64]
BERNOULLI = (
    1.0,
    -1.0 / 2,
    1.0 / 12,
    0.0,
    -1.0 / 720,
    0.0,
    1.0 / 30240,
    0.0,
    -1.0 / 1209600,
    0.0,
    1.0 / 47900160,
)


def skew(a: Array) -> Array:
    """Return S(a)."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def hat(x: Array) -> Array:
    """Return the 4x4 matrix of a twist, angular first."""
    return np.block([[skew(x[:3]), x[3:, None]], [np.zeros((1, 4))]])


def vee(m: Array) -> Array:
    """Return the twist of a 4x4 matrix."""
    return np.array([m[2, 1], m[0, 2], m[1, 0], m[0, 3], m[1, 3], m[2, 3]])


def ad(x: Array) -> Array:
    """Return the adjoint matrix of a twist."""
    return np.block([[skew(x[:3]), np.zeros((3, 3))], [skew(x[3:]), skew(x[:3])]])


def dexp_inverse(x: Array) -> Array:
    """Return the inverse of the exponential's left tangent, by its series (|x| well below 2 pi)."""
    power, total = np.eye(6), np.zeros((6, 6))
    for coefficient in BERNOULLI:
        total = total + coefficient * power
        power = power @ ad(x)
    return total


def dcay_inverse(x: Array) -> Array:
    """Return the inverse of Cayley's left tangent: eta -> (1 - X/2) eta (1 + X/2)."""
    left, right = np.eye(4) - 0.5 * hat(x), np.eye(4) + 0.5 * hat(x)
    return np.array([vee(left @ hat(e) @ right) for e in np.eye(6)]).T


def cay(x: Array) -> Array:
    """Return Cayley's map of a twist, 4x4."""
    return np.linalg.solve(np.eye(4) - 0.5 * hat(x), np.eye(4) + 0.5 * hat(x))


def lie_map_run(
    m: Array,
    velocity: Array,
    h: float,
    count: int,
    tangent: Callable[[Array], Array],
    step: Callable[..., Array],
) -> Array:
    """Return the attitude after `count` steps of mu_k = tangent(h xi)^T M xi, g' = g step(h xi)."""
    inverse, mu, g = np.linalg.inv(m), m @ velocity, np.eye(4)
    for _ in range(count):
        xi = inverse @ mu
        for _ in range(60):
            change = inverse @ (mu - tangent(h * xi).T @ m @ xi)
            xi = xi + change
            if np.abs(change).max() < 1e-14 * np.abs(xi).max():
                break
        mu = tangent(-h * xi).T @ m @ xi
        g = g @ step(h * xi)
    return g[:3, :3]


def product_run(m: Array, velocity: Array, h: float, count: int, scheme: str) -> Array | None:
    """Return the attitude after `count` steps of one of the product's schemes; None if a step needed the fallback."""
    zero = np.zeros(6)
    damping, water = DampingTerm(np.zeros((6, 6)), zero, m), uniform_water(np.zeros(3))
    assembly = Assembly(angular_first(m), (), damping, water, scheme)
    body = OneBody(assembly.composition, assembly.parameters_at, h)
    body.reset(velocity_body=velocity[list(ANGULAR_FIRST)])
    try:
        body.step(steps=count)
    except StepNotSolvableError:
        return None
    if body.fallback_steps:
        return None
    return Rotation.from_quat(np.roll(body.quaternion_body_to_ned, -1)).as_matrix()


def exact(m: Array, velocity: Array, duration: float) -> Array:
    """Return the attitude of Kirchhoff's equations, by DOP853."""
    inverse = np.linalg.inv(m)

    def derivative(_: float, y: Array) -> Array:
        xi = inverse @ y[:6]
        return np.concatenate([ad(xi).T @ y[:6], (y[6:].reshape(3, 3) @ skew(xi[:3])).ravel()])

    start = np.concatenate([m @ velocity, np.eye(3).ravel()])
    solution = solve_ivp(derivative, (0.0, duration), start, method="DOP853", rtol=1e-12, atol=1e-13)
    return np.asarray(solution.y[6:, -1].reshape(3, 3))


def cases() -> dict[str, tuple[Array, Array, float, float]]:
    """Return name -> (M angular first, velocity angular first, duration, h)."""
    rng = np.random.default_rng(0)
    top = np.diag([1.0, 2.0, 3.0, 1.0, 1.0, 1.0])
    rov = angular_first(load_vehicle("bluerov2_heavy").mass_matrix)
    basis, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    dense = basis @ np.diag(np.geomspace(1.0, 20.0, 6)) @ basis.T
    return {
        "torque-free top": (top, np.array([0.31416, 0.5236, 0.3927, 0.0, 0.0, 0.0]), 30.0, 0.1),
        "BlueROV2 Heavy": (rov, np.array([0.5, 0.4, 0.6, 0.5, 0.3, 0.2]), 10.0, 0.02),
        "dense coupled 6x6": (0.5 * (dense + dense.T), 0.7 * rng.normal(size=6), 10.0, 0.02),
        "dense, moving fast": (0.5 * (dense + dense.T), 2.0 * rng.normal(size=6), 5.0, 0.02),
    }


def main() -> None:
    """Run all on all and print the table."""
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    print(f"{'attitude error [rad]':24}{'h':>6}{'sin':>10}{'mrp':>10}{'tan':>10}{'log':>10}")
    for name, (m, velocity, duration, h) in cases().items():
        count = round(duration / h)
        reference = exact(m, velocity, duration)
        attitudes = [
            product_run(m, velocity, h, count, "paper"),
            product_run(m, velocity, h, count, "midpoint"),
            lie_map_run(m, velocity, h, count, dcay_inverse, cay),
            lie_map_run(m, velocity, h, count, dexp_inverse, lambda x: expm(hat(x))),
        ]
        row = f"{name:24}{h:>6}"
        for attitude in attitudes:
            solved = attitude is not None and np.isfinite(attitude).all()
            error = Rotation.from_matrix(reference.T @ attitude).magnitude() if solved else np.nan
            row += f"{error:>10.1e}" if solved else f"{'none':>10}"
        print(row)


if __name__ == "__main__":
    main()
