"""Bodies of baselines, flown in plain Python: nothing is compiled."""

from __future__ import annotations

import numpy as np

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.packing import pack
from dq_marine.integrator.step import ACCEPTED, make_advance
from dq_marine.report.methods import METHODS
from dq_marine.report.names import OWN
from dq_marine.report.physics import Physics

BASELINES = tuple(name for name in METHODS if name not in OWN)


def make_physics(
    m, *, excess_weight=0.0, arm=(0.0,) * 3, linear=None, quadratic=None, current=(0.0,) * 3, forces=()
):
    """`Physics` with the arguments of `support.bodies.make_body`."""
    return Physics(
        np.asarray(m, dtype=float),
        excess_weight,
        np.asarray(arm, dtype=float),
        np.zeros((6, 6)) if linear is None else np.asarray(linear, dtype=float),
        np.zeros(6) if quadratic is None else np.asarray(quadratic, dtype=float),
        np.asarray(current, dtype=float),
        forces,
    )


def advance(body, wrench, steps):
    """Take steps in plain Python, and return the outcome."""
    force = from_fossen(tuple(np.asarray(wrench, dtype=float).tolist()))
    outcome = make_advance(body._composition)(body.parameters, body.state, force, body.time, steps)
    if outcome.status == ACCEPTED:
        body._state = pack(outcome.state)
        body.time += steps * body.step_size
    return outcome


def flown(method, physics, start, duration, count, wrench=(0.0,) * 6):
    """A body after `count` steps from `start`: position, quaternion and velocity."""
    body = METHODS[method].body(physics, duration / count)
    body.reset(*start)
    assert advance(body, wrench, int(count)).status == ACCEPTED
    return body
