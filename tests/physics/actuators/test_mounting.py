"""Where the forces of actuators act: where they are mounted, or where their moment says."""

import numpy as np
import pytest
from support.fleet import everything

from dq_marine.physics.actuators.build import actuator_parts
from dq_marine.physics.actuators.mounting import mounting_points, nearest_point_of_action
from dq_marine.vehicles import load_vehicle


def test_a_force_at_its_point_of_action_has_the_wrenchs_moment():
    """A moment along the force stays over: no point has it."""
    random = np.random.default_rng(3)
    for force, place in random.normal(size=(20, 2, 3)):
        turning = 0.7 * force
        found = nearest_point_of_action(np.concatenate([force, np.cross(place, force) + turning]))
        assert np.cross(found, force) == pytest.approx(np.cross(place, force), abs=1e-12)
        assert found @ force == pytest.approx(0.0, abs=1e-12)
    assert not nearest_point_of_action(np.array([0.0, 0.0, 0.0, 1.0, 2.0, 3.0])).any()


def test_points_are_those_of_the_file():
    points = mounting_points(everything())
    assert points[:4] == pytest.approx(
        np.array([[-0.4, 0.0, 0.1], [0.3, 0.1, 0.0], [-0.3, 0.2, 0.1], [0.3, -0.2, 0.1]])
    )
    assert points[4, 0] == pytest.approx(-6.1 / 9.6)


@pytest.mark.parametrize("name", ["bluerov2_heavy", "remus100", "osv83", "otter", "kvlcc2", "mariner"])
def test_every_actuator_has_a_point_within_the_hull(name):
    vehicle = load_vehicle(name)
    points, size = mounting_points(vehicle), vehicle.dimensions
    assert len(points) == len(actuator_parts(vehicle))
    half = np.array([size.length, size.width, 2.0 * size.height]) / 2.0
    assert (np.abs(points) <= 1.1 * half).all()
    if name in ("remus100", "kvlcc2", "mariner"):
        assert (points[:, 0] < -0.4 * size.length).all()
