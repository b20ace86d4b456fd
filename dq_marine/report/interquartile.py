"""The interquartile mean of scores, with a bootstrap confidence interval.

Agarwal, R., Schwarzer, M., Castro, P. S., Courville, A., Bellemare, M. G. (2021). Deep reinforcement learning at the
edge of the statistical precipice. NeurIPS 34. Their library rliable defines both as here: the mean of what is left of
the scores after a quarter of them is cut off at each end, which outliers do not move and which has a narrower interval
than the median; and the percentile bootstrap over scores that are drawn with replacement.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

CUT = 0.25
"""Share of the scores that is cut off at each end."""

CONFIDENCE, RESAMPLES, SEED = 0.95, 10_000, 0
"""Of the intervals: what they cover, how many bootstrap samples they are of, and the seed of these."""

MOST_NUMBERS = 2_000_000
"""Drawn at a time: 16 MB."""


class Interval(NamedTuple):
    """An interquartile mean, and the ends of its 95 % confidence interval."""

    iqm: float
    low: float
    high: float


def interquartile_means(scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the interquartile mean along the last axis, which loses it: of n scores, floor(n / 4) go at each end."""
    count = scores.shape[-1]
    cut = int(CUT * count)
    kept: NDArray[np.float64] = np.sort(scores, axis=-1)[..., cut : count - cut]
    return np.asarray(kept.mean(axis=-1))


def interquartile_interval(scores: Sequence[float]) -> Interval:
    """Return the interquartile mean of scores and its confidence interval, always the same for the same scores.

    Args:
        scores: one for each episode, which stand for all episodes of their kind; at least 1.
    """
    values = np.asarray(scores, dtype=np.float64)
    random = np.random.default_rng(SEED)
    at_a_time = max(1, MOST_NUMBERS // len(values))
    counts = [min(at_a_time, RESAMPLES - begun) for begun in range(0, RESAMPLES, at_a_time)]
    means = [
        interquartile_means(values[random.integers(0, len(values), (count, len(values)))]) for count in counts
    ]
    tail = 50.0 * (1.0 - CONFIDENCE)
    low, high = np.percentile(np.concatenate(means), [tail, 100.0 - tail])
    return Interval(float(interquartile_means(values)), float(low), float(high))
