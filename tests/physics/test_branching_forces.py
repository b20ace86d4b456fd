"""A user's force with `if`, in a batch: called for one body at a time, or refused with the remedy."""

import numpy as np
import pytest

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.spatial import Spatial
from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.scene import Scene

NO_MOMENT = (0.0, 0.0, 0.0)


def tether(parameters, pose, time):
    """Pulls back beyond a distance."""
    x = pose_position(pose)[0]
    if x > parameters[0]:
        return Spatial(NO_MOMENT, (parameters[1] * (parameters[0] - x), 0.0, 0.0))
    return Spatial(NO_MOMENT, NO_MOMENT)


def brake(parameters, pose, twist, time):
    """Acts ahead, not astern."""
    u = twist.linear[0]
    return Spatial(NO_MOMENT, (-parameters[0] * u * u if u > 0.0 else 0.0, 0.0, 0.0))


@pytest.mark.sweep
def test_bodies_have_the_bits_of_a_single_one():
    forces = (
        ForceTerm("tether", tether, (0.5, 300.0), branches=True),
        ForceTerm("brake", brake, (20.0,), uses_velocity=True, branches=True),
    )
    scene = Scene(forces=forces)
    velocities = np.zeros((11, 6))
    velocities[:, 0] = np.linspace(-1.0, 1.0, 11)
    batch = scene.batch(11)
    batch.reset(velocity_body=velocities)
    batch.step((30.0, 0.0, 0.0, 0.0, 0.0, 0.0), 200)
    for body, velocity in enumerate(velocities):
        single = scene.stepper()
        single.reset(velocity_body=velocity)
        single.step((30.0, 0.0, 0.0, 0.0, 0.0, 0.0), 200)
        assert np.array_equal(batch.get_state()[body], single.get_state())
    assert batch.position_ned[:, 0].max() > 0.5


def test_a_branch_that_is_not_announced_is_refused_with_the_remedy():
    batch = Scene(forces=(ForceTerm("tether", tether, (0.5, 300.0)),)).batch(3)
    with pytest.raises(InvalidInputError, match=r"branches=True.*dq_marine\.algebra\.selection"):
        batch.step()
    assert batch.time == 0.0
