"""Bodies of any inertia, damping and speed move as separately written equations say, solved by SciPy's DOP853."""

import numpy as np
import pytest
from support.bodies import PlainBody
from support.fossen import coriolis, errors, solve
from support.sweeps import sweep
from support.wild import body_of, wild

STEPS = 10


def quickest(drawn):
    """The rate at which the motion changes [1/s]: of the velocity in the metric of M, of the pose, and of damping."""
    m, velocity = drawn.mass_matrix, drawn.velocity
    root = np.linalg.cholesky(m)
    rates = [np.linalg.norm(velocity[3:])]
    for matrix in (coriolis(m, velocity), np.zeros((6, 6)) if drawn.linear is None else drawn.linear):
        scaled = np.linalg.solve(root, np.linalg.solve(root, matrix.T).T)
        rates.append(np.linalg.norm(scaled, 2))
    return max(rates)


@pytest.mark.parametrize(
    ("order", "share", "damped"), [(6, 0.05, False), (4, 0.01, True)], ids=["free", "damped"]
)
@pytest.mark.parametrize("seeds", sweep([range(20), range(20, 500)], plain=[range(20)]))
def test_wild_bodies_move_as_separately_written_equations_say(seeds, order, share, damped):
    """In small steps: what remains is rounding and the solver's residual, times the condition of M."""
    for seed in seeds:
        drawn = wild(np.random.default_rng(seed), damped)
        step = share / quickest(drawn)
        body = body_of(drawn, step=step, order=order, kind=PlainBody)
        body.step(steps=STEPS)
        start = (drawn.position, drawn.quaternion, drawn.velocity)
        reference = solve(drawn.mass_matrix, *start, STEPS * step, linear=drawn.linear)
        moved, turned, changed = errors(body, reference)
        tolerance = 1e-8 + 3e-12 * np.linalg.cond(drawn.mass_matrix)
        speed = np.linalg.norm(drawn.velocity)
        assert changed < tolerance * speed, seed
        assert turned < tolerance, seed
        assert moved < tolerance * speed * STEPS * step + 1e-14 * np.linalg.norm(drawn.position), seed
