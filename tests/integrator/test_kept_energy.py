"""Free motion keeps the kinetic energy within the stated bound, damping never adds to it, or the step is refused."""

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import make_body, random_inertia
from support.wild import batch_of_wild

from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.drift_report import LARGEST_ENERGY_CHANGE
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import ellipsoid

ROUND_OFF = 1e-6
"""Of an energy whose M has a condition number up to 1e8, relative."""

STEPS = 20


HERD = 40
"""Bodies that fly side by side, with one step."""

REASONS = {"not_converged", "wrong_branch", "energy_not_kept"}
"""Why a step may be refused."""


def herds(bodies, damped=False):
    """Batches of wild bodies, so many in all, with steps from 0.1 ms to 1 s."""
    firsts = range(0, bodies, HERD)
    for first, step in zip(firsts, np.geomspace(1e-4, 1.0, len(firsts)), strict=True):
        with contextlib.closing(batch_of_wild(range(first, first + HERD), step, damped)) as herd:
            yield herd


def energies(body, steps):
    """Kinetic energies before the first step and after each: of one body until one is refused, of a batch in rows."""
    found = [body.kinetic_energy]
    for _ in range(steps):
        try:
            body.step()
        except StepNotSolvableError as error:
            assert error.reason in REASONS
            break
        found.append(body.kinetic_energy)
    return np.array(found)


def relative_changes(energy):
    """Relative gain of each step, or loss; at rest, 0."""
    return np.diff(energy, axis=0) / np.maximum(energy[:-1], np.finfo(float).tiny)


def worst_change(energy):
    """Largest relative gain or loss in a step."""
    return np.abs(relative_changes(energy)).max(initial=0.0)


def worst_gain(energy):
    """Largest relative gain in a step."""
    return relative_changes(energy).max(initial=0.0)


@pytest.mark.sweep
@pytest.mark.slow
@pytest.mark.parametrize(("bodies", "steps"), [(200, STEPS), (10_000, 100)])
def test_wild_free_bodies_keep_energy_and_momentum(bodies, steps):
    """A body whose step is refused stays where it is, and tries again."""
    worst, longest, refused = 0.0, 0.0, 0
    for herd in herds(bodies):
        momentum = herd.spatial_momentum[:, :3]
        energy = energies(herd, steps)
        refused += len(herd.refusals)
        assert set(herd.refusals.values()) <= REASONS
        worst = max(worst, worst_change(energy))
        longest = max(longest, np.abs(energy / energy[0] - 1.0).max())
        change = np.linalg.norm(herd.spatial_momentum[:, :3] - momentum, axis=1)
        assert (change < 1e-11 * np.linalg.norm(momentum, axis=1)).all()
    assert 0.0 < worst < LARGEST_ENERGY_CHANGE + ROUND_OFF
    assert longest < 0.11  # what a run comes to: steps in turn gain and lose, as a symplectic method's do
    assert refused < 0.25 * bodies  # they met a step that no number of pieces takes through


@pytest.mark.sweep
@pytest.mark.slow
@pytest.mark.parametrize("bodies", [200, 10_000])
def test_wild_damped_bodies_gain_no_energy(bodies):
    """Beyond what the free part of a step may add; where damping matters, that is nothing at all."""
    gains = [worst_gain(energies(herd, STEPS)) for herd in herds(bodies, damped=True)]
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
