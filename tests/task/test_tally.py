"""Means over the part of an episode in which errors count."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.task.tally import NOTHING_YET, counted, means


@given(st.lists(st.tuples(st.booleans(), *[st.floats(0.0, 10.0)] * 3), max_size=20), st.floats(0.05, 2.0))
def test_means_are_those_of_the_periods_that_count(periods, period):
    tally = NOTHING_YET
    for counting, *numbers in periods:
        tally = counted(tally, counting, tuple(numbers), period)
    chosen = [numbers for counting, *numbers in periods if counting]
    expected = np.mean(chosen, axis=0) if chosen else np.zeros(3)
    assert np.allclose(means(tally, period), expected, atol=1e-12)
    assert np.isclose(tally.time, period * len(chosen))
