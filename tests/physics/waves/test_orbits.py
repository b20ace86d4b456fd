"""The water under waves: the formulas' arithmetic against NumPy, and the laws of linear waves."""

import math

import numpy as np
import pytest

from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.table import Table
from dq_marine.backend.batched import batched
from dq_marine.backend.packing import pack, unpack
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.formulas.kinematics import bottom_orbit, deep_orbit
from dq_marine.physics.weather import Jonswap, Sea
from dq_marine.simulation.scene import Scene, batch_of


def test_sines_are_those_of_numpy_in_any_engine():
    random = np.random.default_rng(0)
    angles = np.concatenate(
        [random.uniform(-10.0, 10.0, 5000), random.uniform(-1e6, 1e6, 5000), [0.0, math.pi]]
    )
    sine, cosine = batched(sine_and_cosine)(angles)
    np.testing.assert_allclose(sine, np.sin(angles), rtol=0.0, atol=2.3e-16)
    np.testing.assert_allclose(cosine, np.cos(angles), rtol=0.0, atol=2.3e-16)
    plain = np.array([sine_and_cosine(float(angle)) for angle in angles[::50]])
    assert np.array_equal(plain, np.stack([sine, cosine], axis=1)[::50])


def seas():
    spectrum = Jonswap(2.0, 8.0)
    return [
        (deep_orbit, Sea(spectrum, 0.6, seed=2, spreading=2.0)),
        (bottom_orbit, Sea(spectrum, 0.6, seed=2, spreading=2.0, depth=20.0)),
    ]


@pytest.mark.parametrize(("orbit", "sea"), seas(), ids=["deep", "bottom"])
def test_water_moves_as_a_potential_flow_whose_surface_is_the_seas(orbit, sea):
    """Velocity divergence and curl vanish, acceleration is its rate, and the surface rises with the water in it."""
    at, time, h = np.array([3.0, -7.0, 4.0]), 11.0, 1e-4

    def velocity(place, t):
        return np.array(orbit(sea.field, tuple(place.tolist()), t).velocity)

    gradient = np.array(
        [(velocity(at + h * e, time) - velocity(at - h * e, time)) / (2 * h) for e in np.eye(3)]
    )
    scale = np.abs(gradient).max()
    assert abs(np.trace(gradient)) < 1e-7 * scale
    np.testing.assert_allclose(gradient, gradient.T, atol=1e-7 * scale)
    rate = (velocity(at, time + h) - velocity(at, time - h)) / (2 * h)
    np.testing.assert_allclose(orbit(sea.field, tuple(at.tolist()), time).acceleration, rate, rtol=1e-6)
    surface = np.array([3.0, -7.0, 0.0])
    rising = (sea.elevation(time + h, *surface[:2]) - sea.elevation(time - h, *surface[:2])) / (2 * h)
    assert velocity(surface, time)[2] == pytest.approx(-float(rising), rel=1e-6)


def test_water_stands_at_the_bottom_and_is_as_at_the_surface_above_it():
    sea = Sea(Jonswap(2.0, 8.0), depth=20.0)
    assert bottom_orbit(sea.field, (0.0, 0.0, 20.0), 3.0).velocity[2] == pytest.approx(0.0, abs=1e-12)
    above, surface = (bottom_orbit(sea.field, (1.0, 2.0, z), 3.0) for z in (-5.0, 0.0))
    assert above == surface


def test_far_from_the_bottom_water_is_deep():
    deep, bottom = Sea(Jonswap(2.0, 8.0)), Sea(Jonswap(2.0, 8.0), depth=2000.0)
    place, time = (10.0, 20.0, 5.0), 40.0
    np.testing.assert_allclose(
        pack(bottom_orbit(bottom.field, place, time)), pack(deep_orbit(deep.field, place, time)), rtol=1e-9
    )


def test_velocity_variance_is_that_of_its_components():
    sea = Sea(Jonswap(2.0, 8.0), seed=1)
    z = 3.0
    times = np.arange(0.0, 10_000.0, 0.5).tolist()
    down = np.array([deep_orbit(sea.field, (0.0, 0.0, z), t).velocity[2] for t in times[::20]])
    weights = (sea.frequencies * np.exp(-sea.wave_numbers * z)) ** 2
    assert down.var() == pytest.approx(float((0.5 * sea.amplitudes**2 * weights).sum()), rel=0.1)


# Tables: numbers that stay in memory


def test_a_table_keeps_its_kind_through_packing():
    structure = (1.0, Table((2.0, 3.0)), (4.0,))
    again = unpack(structure, pack(structure))
    assert again == structure
    assert isinstance(again[1], Table)


def test_bodies_of_one_batch_are_in_one_sea():
    calm, rough = (Scene(weather=[Sea(Jonswap(h, 8.0), components=5)]) for h in (0.5, 2.0))
    with pytest.raises(InvalidInputError, match="different seas"):
        batch_of([calm, rough])
