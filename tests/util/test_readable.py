"""Numbers for people to read."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.util.readable import readable


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.67149, 3, "0.671"),
        (570.2, 3, "570"),
        (99.96, 3, "100"),
        (1034.0, 3, "1,030"),
        (-12345.6, 4, "-12,350"),
        (3.2e-9, 3, "3.2e-09"),
        (4.56e8, 3, "4.56e+08"),
        (0.0, 3, "0"),
    ],
)
def test_numbers_are_as_people_write_them(value, digits, text):
    assert readable(value, digits) == text


@given(st.floats(-1e12, 1e12), st.integers(1, 6))
def test_the_text_is_the_number_to_its_digits(value, digits):
    assert float(readable(value, digits).replace(",", "")) == float(f"{value:.{digits}g}")
