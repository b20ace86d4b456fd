"""Spectra against their published formulas; dispersion against its own equation and its limits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.dispersion import wave_numbers
from dq_marine.physics.weather import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz, Sea

SPECTRA = [
    Jonswap(2.0, 8.0),
    Jonswap(4.0, 11.0, gamma=1.0),
    PiersonMoskowitz(15.0),
    ModifiedPiersonMoskowitz(3.0, 9.0),
]
FREQUENCIES = np.linspace(0.02, 40.0, 400_001)


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_energy_is_that_of_the_significant_height_and_the_peak_is_at_its_period(spectrum):
    density = spectrum.density(FREQUENCIES)
    energy = density.sum() * (FREQUENCIES[1] - FREQUENCIES[0])
    assert 4.0 * math.sqrt(energy) == pytest.approx(spectrum.significant_height, rel=1e-5)
    peak = FREQUENCIES[density.argmax()]
    assert 2.0 * math.pi / peak == pytest.approx(spectrum.peak_period, rel=2e-4)


def test_jonswap_is_dnvs_formula():
    """DNV-RP-C205: S = (1 - 0.287 ln gamma) 5/16 Hs^2 omega_p^4 omega^-5 exp(...) gamma^b, good to a percent."""
    spectrum = Jonswap(2.5, 9.0, gamma=3.3)
    omega, peak = np.linspace(0.3, 3.0, 300), 2.0 * math.pi / 9.0
    sigma = np.where(omega <= peak, 0.07, 0.09)
    enhancement = 3.3 ** np.exp(-((omega - peak) ** 2) / (2.0 * sigma**2 * peak**2))
    pierson = 5.0 / 16.0 * 2.5**2 * peak**4 * omega**-5 * np.exp(-1.25 * (omega / peak) ** -4)
    published = (1.0 - 0.287 * math.log(3.3)) * pierson * enhancement
    np.testing.assert_allclose(spectrum.density(omega), published, rtol=0.01)


def test_a_grown_sea_is_pierson_and_moskowitzs_formula():
    omega, wind = np.linspace(0.2, 3.0, 300), 15.0
    published = 0.0081 * 9.81**2 * omega**-5 * np.exp(-0.74 * (9.81 / (wind * omega)) ** 4)
    np.testing.assert_allclose(PiersonMoskowitz(wind).density(omega), published, rtol=1e-6)


def test_two_parameters_are_the_ittcs_formula():
    omega, height, period = np.linspace(0.2, 3.0, 300), 3.0, 8.0
    published = 173.0 * height**2 / period**4 * omega**-5 * np.exp(-691.0 / period**4 * omega**-4)
    density = ModifiedPiersonMoskowitz(height, period).density(omega)
    np.testing.assert_allclose(density, published, rtol=0.01, atol=1e-9)


def test_there_is_no_energy_at_no_frequency():
    assert Jonswap(2.0, 8.0).density([-1.0, 0.0]).tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Jonswap(2.0, 3.0), "steepness"),
        (lambda: Jonswap(-1.0, 8.0), "height = -1"),
        (lambda: Jonswap(1.0, math.nan), "period"),
        (lambda: Jonswap(1.0, 8.0, gamma=0.5), "gamma = 0.5"),
        (lambda: PiersonMoskowitz(0.0), "wind_speed"),
        (lambda: Sea("rough"), "Jonswap"),
        (lambda: Sea(Jonswap(1.0, 8.0), components=0), "components"),
        (lambda: Sea(Jonswap(1.0, 8.0), components=10**6), "at most"),
        (lambda: Sea(Jonswap(1.0, 8.0), seed=-1), "seed = -1"),
        (lambda: Sea(Jonswap(1.0, 8.0), spreading=0.0), "spreading"),
        (lambda: Sea(Jonswap(1.0, 8.0), depth=-5.0), "depth"),
        (lambda: Sea(Jonswap(1.0, 8.0), direction=math.inf), "direction"),
    ],
)
def test_what_is_no_sea_is_refused(make, message):
    with pytest.raises(InvalidInputError, match=message):
        make()


@given(st.floats(0.01, 20.0), st.floats(0.1, 5000.0))
def test_waves_are_as_long_as_their_dispersion_says(frequency, depth):
    k = float(wave_numbers(frequency, depth))
    assert 9.81 * k * math.tanh(k * depth) == pytest.approx(frequency**2, rel=1e-12)


def test_waves_are_those_of_deep_or_of_shallow_water_at_the_limits():
    omega = np.array([0.5, 1.0, 2.0])
    assert wave_numbers(omega).tolist() == (omega**2 / 9.81).tolist()
    np.testing.assert_allclose(wave_numbers(omega, 1e4), omega**2 / 9.81, rtol=1e-13)
    np.testing.assert_allclose(wave_numbers(0.01, 1.0), 0.01 / math.sqrt(9.81), rtol=1e-5)
