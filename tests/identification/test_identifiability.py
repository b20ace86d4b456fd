"""Standard errors and what is held, against the closed forms of linear least squares."""

from __future__ import annotations

import numpy as np
import pytest

from dq_marine.identification.identifiability import correlated, covariance, standard_errors, told

RNG = np.random.default_rng(0)


def test_covariance_is_the_inverse_of_the_normal_matrix():
    jacobian = RNG.normal(size=(50, 4)) * np.array([1.0, 1e4, 1e-4, 3.0])
    assert covariance(jacobian) == pytest.approx(np.linalg.inv(jacobian.T @ jacobian), rel=1e-9)


def test_errors_are_those_of_repeated_estimates():
    jacobian = RNG.normal(size=(60, 3))
    noise = RNG.normal(size=(60, 4000))
    scatter = np.linalg.lstsq(jacobian, noise, rcond=None)[0].std(axis=1)
    assert standard_errors(jacobian) == pytest.approx(scatter, rel=0.05)


def test_what_is_not_felt_is_held():
    jacobian = np.column_stack([100.0 * RNG.normal(size=50), np.zeros(50), RNG.normal(size=50)])
    free, held = told(jacobian, np.zeros(3), [3, 5, 8], bound=0.1)
    assert free == [3]
    assert [one.place for one in held] == [5, 8]
    assert held[0].standard_error == np.inf
    assert held[1].standard_error == pytest.approx(standard_errors(jacobian[:, 2:])[0], rel=0.05)


def test_of_two_that_only_go_together_one_is_held():
    column = 100.0 * RNG.normal(size=50)
    free, held = told(np.column_stack([column, column]), np.zeros(2), [0, 1], bound=0.1)
    assert len(free) == len(held) == 1


def test_what_is_felt_through_noise_is_held():
    jacobian = 100.0 * RNG.normal(size=(50, 2))
    assert told(jacobian, np.array([0.9, 0.1]), [4, 6], bound=0.1) == ([6], [(4, np.inf)])


def test_high_correlations_are_named_highest_first():
    matrix = np.array([[1.0, 1.98, 0.0], [1.98, 4.0, 0.1], [0.0, 0.1, 1.0]])
    assert correlated(matrix) == [(0, 1, pytest.approx(0.99))]
