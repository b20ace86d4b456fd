"""What a batch refuses, with the value, the limit and the remedy."""

import numpy as np
import pytest
from support.different_scenes import different_scenes

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene, batch_of

CURRENT = (0.2, -0.1, 0.05)


NAN_ROW = np.where(np.arange(7)[:, None] == 5, np.nan, np.zeros((7, 6)))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda b: b.step(NAN_ROW), r"wrench_body\[5\]"),
        (lambda b: b.step((np.inf, 0, 0, 0, 0, 0)), "wrench_body"),
        (lambda b: b.step(np.zeros((6, 6))), r"shape \(6, 6\); give shape \(7, 6\)"),
        (lambda b: b.step("forward"), "not numeric"),
        (lambda b: b.step(steps=0), "steps = 0"),
        (lambda b: b.step(steps=1.5), "steps = 1.5"),
        (lambda b: b.reset(quaternion_body_to_ned=2.0 * np.eye(7, 4)), r"quaternion.*\[0\] has length 2"),
        (lambda b: b.reset(position_ned=NAN_ROW[:, :3]), r"position_ned\[5\]"),
        (lambda b: b.reset(velocity_body=NAN_ROW), r"velocity_body\[5\]"),
        (lambda b: b.reset((1.0, 2.0, 3.0), velocity_body=np.zeros(5)), r"velocity_body has shape \(5,\)"),
        (lambda b: b.set_state(np.zeros((7, 15))), r"state.*length is 0"),
        (lambda b: b.set_state(np.zeros((7, 14))), r"shape \(7, 14\)"),
        (lambda b: b.set_state(b.get_state() + np.arange(7)[:, None] * np.eye(15)[0]), "one time"),
    ],
)
def test_bad_input_is_refused_and_changes_nothing(call, message):
    batch = batch_of(different_scenes()[:7])
    batch.step((10.0, 0.0, 0.0, 0.0, 0.0, 1.0), 5)
    before = batch.get_state()
    with pytest.raises(InvalidInputError, match=message):
        call(batch)
    assert np.array_equal(batch.get_state(), before)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Scene().batch(0), "number of bodies = 0"),
        (lambda: Scene().batch(2.5), r"2\.5 is not an integer"),
        (lambda: Scene().batch(3, precision="float16"), r"precision = 'float16'.*float32"),
        (lambda: Scene().batch(3, arithmetic="loose"), r"arithmetic = 'loose'.*strict"),
        (lambda: Scene().batch(3, threads=0), "threads = 0; give None or"),
        (lambda: Scene().batch(3, threads=1.5), r"threads = 1\.5"),
        (lambda: Scene().batch(3, threads=10**6), "threads = 1000000"),
        (lambda: batch_of([]), "0 scenes"),
        (lambda: batch_of([1]), r"scenes = \[1\]; give a list of dq_marine\.Scene"),
        (lambda: batch_of(Scene()), "give a list"),
        (lambda: batch_of([Scene()], 1.5), r"number of bodies = 1\.5 is not an integer"),
        (lambda: batch_of([Scene(), Scene()], 3), "2 scenes for 3 bodies"),
        (lambda: batch_of([Scene(), Scene(current=CURRENT)]), "differ in what they compute"),
        (lambda: batch_of([Scene(), Scene(step=0.01)]), "or in their step"),
    ],
)
def test_a_batch_that_cannot_be_is_refused_with_the_remedy(make, message):
    with pytest.raises(InvalidInputError, match=message):
        make()
