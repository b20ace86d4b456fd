"""The interquartile mean and its bootstrap interval, beside SciPy's, and how often the interval holds the truth."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from dq_marine.report.interquartile import interquartile_interval, interquartile_means

SCORES = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=60)


@given(SCORES)
def test_the_mean_is_scipys_trimmed_mean(scores):
    expected = stats.trim_mean(scores, 0.25)
    assert interquartile_means(np.array(scores)) == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_outliers_do_not_move_it():
    assert interquartile_means(np.array([1.0, 2.0, 3.0, 1e9])) == 2.5
    assert interquartile_means(np.array([-1e9, 2.0, 3.0, 4.0])) == 2.5
    assert interquartile_means(np.array([[1.0, 1.0, 4.0, 4.0], [0.0, 0.0, 0.0, 8.0]])).tolist() == [2.5, 0.0]


@given(SCORES)
def test_an_interval_lies_within_the_scores_and_is_the_same_each_time(scores):
    found = interquartile_interval(scores)
    slack = 1e-9 * max(1.0, max(map(abs, scores)))
    assert min(scores) - slack <= found.low <= found.high <= max(scores) + slack
    assert found == interquartile_interval(scores)


def test_an_interval_of_equal_scores_has_no_width():
    assert interquartile_interval([0.25] * 7) == (0.25, 0.25, 0.25)
    assert interquartile_interval([3.0]) == (3.0, 3.0, 3.0)


def test_an_interval_is_scipys_percentile_bootstrap():
    scores = np.random.default_rng(1).gamma(2.0, size=50)
    theirs = stats.bootstrap(
        (scores,),
        lambda sample, axis: stats.trim_mean(sample, 0.25, axis=axis),
        n_resamples=20_000,
        method="percentile",
        rng=np.random.default_rng(2),
    ).confidence_interval
    found = interquartile_interval(scores.tolist())
    width = theirs.high - theirs.low
    assert found.low == pytest.approx(theirs.low, abs=0.05 * width)
    assert found.high == pytest.approx(theirs.high, abs=0.05 * width)


def test_intervals_hold_the_true_mean_about_as_often_as_they_say():
    """Of a uniform distribution the interquartile mean is 1/2. 95 of 100 would be ideal; the bootstrap gives fewer."""
    random = np.random.default_rng(3)
    found = [interquartile_interval(random.random(40).tolist()) for _ in range(200)]
    held = sum(one.low <= 0.5 <= one.high for one in found)
    assert 0.9 <= held / len(found) <= 0.99
