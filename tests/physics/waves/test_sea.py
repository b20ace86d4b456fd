"""A simulated sea has the height, the peak and the energy of its spectrum, whatever the seed."""

import numpy as np
import pytest
from scipy.signal import welch

from dq_marine.physics.weather import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz, Sea

SPECTRA = [Jonswap(2.0, 8.0), PiersonMoskowitz(12.0), ModifiedPiersonMoskowitz(3.0, 9.0)]
RATE = 4.0
TIMES = np.arange(0.0, 10_000.0, 1.0 / RATE)


def peak_estimate(frequencies, density):
    """The period about which the fourth power of a spectrum has its weight."""
    return (density**4).sum() / (frequencies * density**4).sum()


@pytest.mark.parametrize("seed", [0, 1, 2, 17, 2**40])
@pytest.mark.parametrize("spectrum", SPECTRA, ids=lambda s: type(s).__name__)
def test_height_and_peak_of_ten_thousand_seconds_are_the_spectrums_within_three_percent(spectrum, seed):
    elevation = Sea(spectrum, seed=seed).elevation(TIMES)
    assert 4.0 * elevation.std() == pytest.approx(spectrum.significant_height, rel=0.03)
    frequencies, density = welch(elevation, RATE, nperseg=1024)
    target = spectrum.density(2.0 * np.pi * frequencies)
    # The estimate's own bias, from a spectrum's steeper side, is the same for the target.
    bias = peak_estimate(frequencies, target) / spectrum.peak_period
    assert peak_estimate(frequencies, density) / bias == pytest.approx(spectrum.peak_period, rel=0.03)


def test_components_hold_the_energy_of_their_bins():
    """Half the amplitude squared each, as much in every band of frequencies as the spectrum has there."""
    spectrum = Jonswap(2.0, 8.0)
    sea = Sea(spectrum, components=200, seed=3)
    energy = 0.5 * sea.amplitudes**2
    assert energy.sum() == pytest.approx(spectrum.significant_height**2 / 16.0, rel=1e-12)
    fine = np.linspace(0.01, 6.0, 60_001)
    density = spectrum.density(fine)
    for low, high in [(0.5, 0.7), (0.7, 0.8), (0.8, 1.0), (1.0, 3.0)]:
        own = energy[(sea.frequencies >= low) & (sea.frequencies < high)].sum()
        band = (fine >= low) & (fine < high)
        assert own == pytest.approx(density[band].sum() * (fine[1] - fine[0]), abs=1.1 * energy[0])


def test_the_sea_does_not_repeat_itself():
    sea = Sea(Jonswap(2.0, 8.0), seed=5)
    first, later = sea.elevation(TIMES[:4000]), sea.elevation(TIMES[:4000] + 5000.0)
    assert abs(np.corrcoef(first, later)[0, 1]) < 0.3
    assert np.diff(sea.frequencies).min() > 0.0


def test_a_seed_is_a_sea():
    times = TIMES[:50]
    make = lambda seed: Sea(Jonswap(1.0, 6.0), 0.3, seed=seed, spreading=2.0).elevation(times, 3.0, -2.0)  # noqa: E731
    assert np.array_equal(make(4), make(4))
    assert not np.array_equal(make(4), make(5))


@pytest.mark.parametrize("s", [1.0, 4.0])
def test_spreading_is_about_the_direction_and_as_wide_as_it_should_be(s):
    """Of cos^2s about a direction, the mean of cos^2 is (2s + 1)/(2s + 2)."""
    sea = Sea(Jonswap(1.0, 6.0), direction=0.7, spreading=s, components=1000)
    off = sea.directions - 0.7
    assert np.mean(off) == pytest.approx(0.0, abs=1e-3)
    assert np.mean(np.cos(off) ** 2) == pytest.approx((2.0 * s + 1.0) / (2.0 * s + 2.0), abs=2e-3)
    assert abs(np.corrcoef(off, sea.frequencies)[0, 1]) < 0.1
    assert np.all(Sea(Jonswap(1.0, 6.0), direction=0.7).directions == 0.7)


@pytest.mark.parametrize("depth", [None, 15.0])
def test_crests_travel_in_the_direction_at_their_speed(depth):
    sea = Sea(Jonswap(1.0, 6.0), direction=0.7, components=1, depth=depth)
    speed = float(sea.frequencies[0] / sea.wave_numbers[0])
    times = np.linspace(0.0, 20.0, 30)
    moving = sea.elevation(times, speed * times * np.cos(0.7), speed * times * np.sin(0.7))
    np.testing.assert_allclose(moving, moving[0], atol=1e-12)
