"""Orders and costs are read off curves as one would by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dq_marine.report.showing.fits import cost_at, observed_order

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


@pytest.mark.parametrize("order", [2, 4, 8])
def test_what_round_off_brings_back_into_the_range_does_not_count(order: int) -> None:
    """Round-off grows with the number of steps: finer points have larger errors, and are among the finest."""
    steps = [0.5 / 2**k for k in range(16)]
    errors = [step**order + 3e-13 / step for step in steps]
    assert sum(1e-10 < error < 1e-2 for error in errors[-8:]) >= 7
    found = observed_order(steps, errors, 1e-10, 1e-1)
    assert found is not None
    assert found.slope == pytest.approx(order, abs=0.05)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("order", [2, 3, 4])
def test_a_slope_survives_a_noisy_floor_and_steps_that_are_too_large(order: int, seed: int) -> None:
    """Errors saturate at 3, bend down from there, and end in noise some way above what is called smallest."""
    random = np.random.default_rng(seed)
    steps = [1.0 / 2**k for k in range(20)]
    noise = 1e-9 * np.abs(random.normal(size=len(steps))) + 2e-10
    truncated = [3.0 * (1.0 - math.exp(-(step**order) * (1.0 + step))) for step in steps]
    errors = [truncation + extra for truncation, extra in zip(truncated, noise, strict=True)]
    found = observed_order(steps, errors, 1e-10, 1e-2)
    assert found is not None
    assert found.slope == pytest.approx(order, abs=0.1)


def test_two_good_points_and_a_noisy_one_are_no_order() -> None:
    """An order of 8 on Dzhanibekov's nut: the finest error is in the range again, and gave a slope of 1.25."""
    errors = [0.6, 0.07, 1.7e-5, 7.7e-8, 4.8e-10, 1.1e-9, 6.5e-11, 3.2e-9, 1.8e-8]
    steps = [1.5 / 2**k for k in range(len(errors))]
    assert observed_order(steps, errors, 1.5e-8, 1e-2) is None


def test_a_lucky_step_among_those_that_are_too_large_does_not_count() -> None:
    errors = [0.5, 1e-3, 0.3, *(step**3 for step in STEPS)]
    steps = [0.8, 0.4, 0.2, *STEPS]
    found = observed_order(steps, errors, 1e-12, 1e-2)
    assert found is not None
    assert found.slope == pytest.approx(3.0, rel=1e-10)
    assert observed_order(steps[:5], errors[:5], 1e-12, 1e-2) is None


def test_an_error_that_stops_falling_far_above_round_off_shows() -> None:
    found = observed_order(STEPS, [step**2 + 1e-4 for step in STEPS], 1e-10, 1e-1)
    assert found is not None
    assert found.slope < 0.5


def test_two_points_are_no_order() -> None:
    assert observed_order(STEPS[:2], [1e-3, 1e-4], 1e-10, 1e-2) is None
    assert observed_order(STEPS, [math.nan] * len(STEPS), 1e-10, 1e-2) is None


def test_a_cost_lies_on_the_line_between_two_points() -> None:
    costs, errors = [1.0, 10.0, 100.0], [1e-1, 1e-3, 1e-5]
    assert cost_at(costs, errors, 1e-2) == pytest.approx(10.0**0.5)
    assert cost_at(costs, errors, 1e-5) == pytest.approx(100.0)
    assert cost_at(costs, errors, 1e-4) == pytest.approx(10.0**1.5)


def test_a_coarser_point_that_costs_more_is_not_read_towards():
    """Steps too long for a method are left to its fallback, which costs more than shorter steps do."""
    assert cost_at([9.0, 2.0, 4.0], [1.0, 1e-3, 1e-5], 1e-2) == 2.0
    assert 2.0 < cost_at([9.0, 2.0, 4.0], [1.0, 1e-3, 1e-5], 1e-4) < 4.0


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


def test_nobody_takes_coarser_steps_that_are_dearer():
    assert cost_at([9.0, 8.0, 2.0, 4.0], [1e-3, 1e-4, 1e-5, 1e-6], 1e-2) == 2.0
    assert cost_at([1.0, 9.0, 2.0, 4.0], [1.0, 1e-4, 1e-5, 1e-6], 1e-3) == 2.0
