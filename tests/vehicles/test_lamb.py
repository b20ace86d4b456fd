"""Added mass of ellipsoids against published and tabulated values."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import elliprd

from dq_marine.errors import InvalidInputError
from dq_marine.vehicles.analysis.lamb import added_mass_coefficients, carlson_rd, ellipsoid_mass_matrix

lengths = st.floats(1e-3, 1e3)


@pytest.mark.parametrize(
    ("axes", "along", "about"),
    [
        ((1, 1, 1), (0.5, 0.5, 0.5), (0, 0, 0)),
        ((2, 1, 1), (0.210015, 0.704210, 0.704210), (0, 0.239424, 0.239424)),
        ((4, 1, 1), (0.081557, 0.859761, 0.859761), (0, 0.607938, 0.607938)),
        ((3, 2, 1), (0.185256, 0.364543, 1.361527), (0.383267, 0.708236, 0.059900)),
    ],
)
def test_tabulated_coefficients(axes, along, about):
    k, k_rotation = added_mass_coefficients(*axes)
    assert np.allclose(k, along, atol=1e-6)
    assert np.allclose(k_rotation, about, atol=1e-6)


def test_the_neutral_spheroid():
    expected = (35.39387824, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877)
    assert np.allclose(np.diag(ellipsoid_mass_matrix(0.5, 0.125, 0.125)), expected, rtol=1e-8)


@given(lengths, lengths, lengths)
def test_carlsons_integral_is_scipys(x, y, z):
    assert carlson_rd(x, y, z) == pytest.approx(float(elliprd(x, y, z)), rel=1e-14)


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_coefficients_follow_shape_not_size_and_turn_with_the_axes(a, b, c, size):
    k, k_rotation = added_mass_coefficients(a, b, c)
    assert np.allclose(added_mass_coefficients(size * a, size * b, size * c)[0], k, rtol=1e-9)
    turned, turned_rotation = added_mass_coefficients(b, c, a)
    assert np.allclose(turned, np.roll(k, -1), rtol=1e-9)
    assert np.allclose(turned_rotation, np.roll(k_rotation, -1), rtol=1e-6, atol=1e-9)
    assert (k > 0.0).all()
    assert (k_rotation >= -1e-12).all()


@pytest.mark.parametrize(
    "axes", [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, float("nan")), (0.1, 1e213, 1.77)]
)
def test_impossible_axes_are_refused(axes):
    with pytest.raises(InvalidInputError, match=r"[abc] = .*(give at least|give at most|not finite)"):
        added_mass_coefficients(*axes)
