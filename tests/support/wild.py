"""Bodies of any inertia and damping, at any speed, with any step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dq_marine.simulation.batch import Batch
from support.bodies import make_body, random_damping, random_inertia, random_quaternion


class Wild(NamedTuple):
    """A body and how it moves at first.

    Attributes:
        mass_matrix: positive definite, of a condition up to 1e8.
        linear: damping, of any size beside it; None for none.
        step: 0.1 ms to 1 s.
        velocity: in Fossen's order, up to 50 m/s and 1,000 rad/s.
        position: in NED [m].
        quaternion: body to NED.
    """

    mass_matrix: np.ndarray
    linear: np.ndarray | None
    step: float
    velocity: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray


def wild(rng, damped=False):
    """A draw of all these numbers."""
    mass_matrix = 10.0 ** rng.uniform(-3.0, 9.0) * random_inertia(rng, 10.0 ** rng.uniform(0.0, 8.0))
    linear = 10.0 ** rng.uniform(-6.0, 6.0) * random_damping(rng) if damped else None
    step = 10.0 ** rng.uniform(-4.0, 0.0)
    direction, axis = rng.normal(size=(2, 3))
    speed, spin = 10.0 ** rng.uniform(-3.0, np.log10(50.0)), 10.0 ** rng.uniform(-3.0, 3.0)
    velocity = np.concatenate(
        [speed * direction / np.linalg.norm(direction), spin * axis / np.linalg.norm(axis)]
    )
    return Wild(mass_matrix, linear, step, velocity, rng.normal(size=3), random_quaternion(rng))


def body_of(drawn, **keywords):
    """The body, on its way; keywords are those of `make_body`."""
    body = make_body(drawn.mass_matrix, keywords.pop("step", drawn.step), linear=drawn.linear, **keywords)
    body.reset(drawn.position, drawn.quaternion, drawn.velocity)
    return body


def batch_of_wild(seeds, step, damped=False):
    """A body for each seed, in lanes and on its way, all with one step."""
    drawn = [wild(np.random.default_rng(seed), damped) for seed in seeds]
    made = [make_body(one.mass_matrix, step, linear=one.linear, kind=_composed) for one in drawn]
    batch = Batch(made[0][0], [parameters for _, parameters in made], step, len(made))
    batch.reset(
        *(np.array([getattr(one, name) for one in drawn]) for name in ("position", "quaternion", "velocity"))
    )
    return batch


def _composed(composition, parameters_at, step):
    return composition, parameters_at(step)
