"""Free motion keeps the kinetic energy within the stated bound, damping never adds to it, or the step is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import make_body, random_inertia
from support.sweeps import sweep
from support.wild import body_of, wild

from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.drift_report import LARGEST_ENERGY_CHANGE
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import ellipsoid

ROUND_OFF = 1e-6
"""Of an energy whose M has a condition number up to 1e8, relative."""

STEPS = 20


def wild_body(rng, damped=False):
    return body_of(wild(rng, damped))


def energies(body, steps):
    """Kinetic energies before the first step and after each, up to the first that is refused."""
    found = [body.kinetic_energy]
    for _ in range(steps):
        try:
            body.step()
        except StepNotSolvableError as error:
            assert error.reason in ("not_converged", "wrong_branch", "energy_not_kept")
            break
        found.append(body.kinetic_energy)
    return np.array(found)


def relative_changes(energy):
    """Relative gain of each step, or loss; at rest, 0."""
    return np.diff(energy) / np.maximum(energy[:-1], np.finfo(float).tiny)


def worst_change(energy):
    """Largest relative gain or loss in a step."""
    return np.abs(relative_changes(energy)).max(initial=0.0)


def worst_gain(energy):
    """Largest relative gain in a step."""
    return relative_changes(energy).max(initial=0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("bodies", "steps"), sweep([(200, STEPS), (10_000, 100)], plain=[(200, STEPS)]))
def test_wild_free_bodies_keep_energy_and_momentum(bodies, steps):
    worst, longest, refused = 0.0, 0.0, 0
    for seed in range(bodies):
        body = wild_body(np.random.default_rng(seed))
        momentum = np.linalg.norm(body.spatial_momentum[:3])
        energy = energies(body, steps)
        refused += len(energy) <= steps
        worst = max(worst, worst_change(energy))
        longest = max(longest, np.abs(energy / energy[0] - 1.0).max())
        assert abs(np.linalg.norm(body.spatial_momentum[:3]) - momentum) < 1e-11 * momentum, seed
    assert 0.0 < worst < LARGEST_ENERGY_CHANGE + ROUND_OFF
    assert longest < 0.11  # what a run comes to: steps in turn gain and lose, as a symplectic method's do
    assert (
        refused < 0.25 * bodies
    )  # which meet a step that no number of pieces takes through, sooner or later


@pytest.mark.slow
@pytest.mark.parametrize("bodies", sweep([100, 10_000], plain=[100]))
def test_wild_damped_bodies_gain_no_energy(bodies):
    """Beyond what the free part of a step may add; where damping matters, that is nothing at all."""
    gains = [
        worst_gain(energies(wild_body(np.random.default_rng(seed), damped=True), STEPS))
        for seed in range(bodies)
    ]
    assert max(gains) < LARGEST_ENERGY_CHANGE + ROUND_OFF


def test_an_ellipsoid_that_multiplied_its_energy():
    """By 30 in one step of half a second, with the momentum exact: it is split now, and counted."""
    body = Scene(ellipsoid(2.0, 0.12, 0.1), step=0.5).stepper()
    body.reset(velocity_body=[15.697, 1.196, 11.085, 0.389, -4.407, -11.729])
    energy = energies(body, 1)
    assert len(energy) == 2
    assert worst_change(energy) < LARGEST_ENERGY_CHANGE
    assert body.fallback_steps == 1


@settings(max_examples=100)
@given(seed=st.integers(0, 2**32 - 1), spin=st.floats(0.3, 3.0))
def test_steps_of_about_a_radian(seed, spin):
    """A turn of 0.3 to 3 rad, where plain Newton finds solutions of the wrong energy on the right branch."""
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng, 1e3), 0.02)
    axis = rng.normal(size=3)
    body.reset(velocity_body=(*rng.normal(size=3), *(spin / 0.02 * axis / np.linalg.norm(axis))))
    assert worst_change(energies(body, STEPS)) < LARGEST_ENERGY_CHANGE + ROUND_OFF


def test_ordinary_steps_need_no_fallback():
    """A body that turns by an eighth of a radian in a step is solved at once."""
    rng = np.random.default_rng(0)
    for _ in range(50):
        body = make_body(random_inertia(rng), 0.02)
        velocity = rng.normal(size=6)
        body.reset(velocity_body=0.125 / 0.02 * velocity / np.linalg.norm(velocity))
        body.step(steps=20)
        assert body.fallback_steps == 0
