"""Whether a step's solution is the one that is connected to rest, found by following it from there.

A step's discrete equation may have several solutions. Along the one that counts, the momenta grow from nothing to their
values and the Jacobian stays regular. Plain Newton sees the end of that path only; here it is walked, in 400 strides
or more, by another function than those that the step uses to decide. A step that was split is compared with pieces
walked so.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.matrix3 import transform
from dq_marine.algebra.vector3 import Vector3, dot, scale
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type
from dq_marine.integrator.body import AT_REST
from dq_marine.integrator.drift import MAX_PIECES, DriftScheme, Solve, make_drift_by, make_newton
from dq_marine.integrator.drift_report import ACCEPTED_RESIDUAL, SolverReport
from dq_marine.integrator.inertia import Inertia
from dq_marine.integrator.midpoint_drift import MIDPOINT
from dq_marine.integrator.paper_drift import PAPER

SCHEMES = {"dqvi2": MIDPOINT, "dqvi_paper": PAPER}
"""Drifts of the methods that take one in a step."""

LONGEST_STRIDE = 1.0 / 400.0
"""Of the way from rest. Where Newton's method does not get along the branch with it, it is halved."""

SHORTEST_STRIDE = 1e-8
MOST_ITERATIONS = 100_000

SAME_ATTITUDE = 1e-6
"""Largest difference of the quaternions of equal solutions."""

Array = NDArray[np.float64]


def make_walk(scheme: DriftScheme) -> Solve:
    """Return (inertia, a, b) -> (equation, report): the solution walked to from rest."""
    newton = make_newton(scheme)

    def walk(inertia: Inertia, a: Vector3, b: Vector3) -> tuple[Any, SolverReport]:
        reached, stride, iterations = 0.0, LONGEST_STRIDE, 0
        here, report = newton(inertia, scale(0.0, a), scale(0.0, a), scale(0.0, b))
        while reached < 1.0 and stride >= SHORTEST_STRIDE and iterations < MOST_ITERATIONS:
            target = min(reached + stride, 1.0)
            start = scale(target / reached if reached > 0.0 else 1.0, here[0])
            there, report = newton(inertia, start, scale(target, a), scale(target, b))
            iterations += report.iterations
            if report.on_rest_branch and solved(inertia, there, scale(target, a), scale(target, b)):
                here, reached, stride = there, target, min(2.0 * stride, LONGEST_STRIDE)
            else:
                stride *= 0.5
        return here, SolverReport(here.relative_residual_squared, reached >= 1.0, iterations)

    return walk


def solved(inertia: Inertia, equation: Any, a: Vector3, b: Vector3) -> bool:
    """Whether a residual is small beside the equation's terms, Munk's moment y x zb counted by its factors.

    The integrator counts the product itself, which is round-off where a body moves straight on.
    """
    munk = dot(transform(inertia.linear_block_inverse, b), transform(inertia.linear_block_inverse, b)) * dot(
        b, b
    )
    return dot(equation.residual, equation.residual) <= ACCEPTED_RESIDUAL**2 * (dot(a, a) + munk)


@functools.cache
def compiled_walk(name: str, layout: Any) -> Callable[..., bool]:
    """Compile (inertia, state, h, pieces) -> whether it went: the state is moved by `pieces` drifts of h/pieces."""
    drift = make_drift_by(SCHEMES[name], make_walk(SCHEMES[name]))
    load_inertia = make_load(layout)
    load_state = make_load(structure_type(AT_REST))

    def walk_arrays(inertia: Any, state: Any, h: float, pieces: int) -> Any:
        numbers = load_inertia(inertia)
        pose, momentum, _ = load_state(state)
        for _ in range(pieces):
            pose, momentum, report = drift(numbers, h / pieces, pose, momentum)
            if not report.solver.on_rest_branch:
                return False
        store(state, (pose, momentum))
        return True

    return compile_function(walk_arrays, str(layout))


def confirmed_pieces(name: str, inertia: Inertia, h: float, before: Array, after: Array) -> int:
    """Return in how many pieces walking from rest leads to the same attitude, 0 if in none.

    Args:
        name: of the method.
        inertia: of the body.
        h: step size [s].
        before: pose and momentum before the step, shape (14,).
        after: what the method made of them.
    """
    numbers = pack(inertia)
    walk = compiled_walk(name, structure_type(inertia))
    pieces = 1
    while pieces <= MAX_PIECES:
        state = before.copy()
        if walk(numbers, state, h, pieces) and alike(state[:4], after[:4]):
            return pieces
        pieces *= 2
    return 0


def alike(one: Array, other: Array) -> bool:
    """Whether two quaternions are the same attitude."""
    return float(min(np.linalg.norm(one - other), np.linalg.norm(one + other))) <= SAME_ATTITUDE
