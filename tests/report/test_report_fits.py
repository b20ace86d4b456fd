"""Orders and costs are read off curves as one would by hand."""

from __future__ import annotations

import math

import pytest

from dq_marine.report.fits import cost_at, observed_order

STEPS = [0.1 / 2**k for k in range(10)]


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_the_order_of_a_power_law_is_its_power(order: int) -> None:
    errors = [0.5 * step**order for step in STEPS]
    found = observed_order(STEPS, errors, 1e-10, 1e-1)
    assert found is not None
    assert found.slope == pytest.approx(order, rel=1e-10)


def test_round_off_and_coarse_steps_do_not_count() -> None:
    errors = [max(step**4, 1e-11) for step in STEPS]
    errors[0], errors[1] = math.inf, 3.0
    found = observed_order(STEPS, errors, 1e-10, 1e-2)
    assert found is not None
    assert found.slope == pytest.approx(4.0, rel=1e-10)


def test_two_points_are_no_order() -> None:
    assert observed_order(STEPS[:2], [1e-3, 1e-4], 1e-10, 1e-2) is None
    assert observed_order(STEPS, [math.nan] * len(STEPS), 1e-10, 1e-2) is None


def test_a_cost_lies_on_the_line_between_two_points() -> None:
    costs, errors = [1.0, 10.0, 100.0], [1e-1, 1e-3, 1e-5]
    assert cost_at(costs, errors, 1e-2) == pytest.approx(10.0**0.5)
    assert cost_at(costs, errors, 1e-5) == pytest.approx(100.0)
    assert cost_at(costs, errors, 1e-4) == pytest.approx(10.0**1.5)


def test_a_first_point_that_is_exact_enough_is_the_cost() -> None:
    assert cost_at([3.0, 6.0], [1e-4, 1e-5], 1e-2) == 3.0


def test_an_error_that_is_not_reached_has_no_cost() -> None:
    assert cost_at([1.0, 2.0], [1e-1, 1e-2], 1e-3) is None
    assert cost_at([], [], 1e-3) is None
    assert cost_at([1.0, 2.0], [math.inf, math.nan], 1e-3) is None


def test_a_lucky_coarse_point_does_not_count() -> None:
    """An error that is met, missed and met again is met from the second time on."""
    assert cost_at([1.0, 2.0, 4.0], [1e-5, 1e-1, 1e-5], 1e-3) == pytest.approx(2.0 * 2.0**0.5)


def test_round_off_behind_an_exact_point_does_not_count() -> None:
    assert cost_at([1.0, 2.0, 4.0, 8.0], [1e-5, 1e-9, 1e-9, 3e-8], 1e-8) == pytest.approx(2.0**0.75)


def test_a_coarse_step_that_takes_long_is_no_fine_one() -> None:
    assert cost_at([50.0, 2.0, 4.0], [1.0, 1e-2, 1e-4], 1e-3) == pytest.approx(2.0 * 2.0**0.5)


def test_behind_a_failure_the_first_point_that_is_exact_enough_is_the_cost() -> None:
    assert cost_at([1.0, 2.0], [math.inf, 1e-5], 1e-3) == 2.0
