"""The observer of disturbances: it finds what the model lacks, in axes that stand still, as fast as it is told to."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from dq_marine.agents.controllers.disturbance import DisturbanceObserver
from dq_marine.agents.controllers.hydrodynamic_model import DOWN, HydrodynamicModel
from dq_marine.agents.controllers.reading import Reading
from dq_marine.vehicles import load_vehicle

PERIOD, LAG, TURN_RATE = 0.1, 0.5, 0.3


def held_still(time):
    """What a vehicle that heads north reads beside a goal that turns."""
    goal_to_body = Rotation.from_rotvec(TURN_RATE * time * DOWN).as_matrix()
    turning = np.concatenate([np.zeros(3), TURN_RATE * DOWN])
    return Reading(np.zeros(6), np.zeros(6), goal_to_body, turning, np.zeros(6))


def test_a_steady_force_is_found_from_what_holds_against_it_and_stands_still_while_the_goal_turns():
    model = HydrodynamicModel(load_vehicle("rexrov"))
    observer = DisturbanceObserver(model, PERIOD, LAG)
    force = np.array([100.0, -50.0, 20.0, 5.0, -3.0, 8.0])
    holding = -force - model.restoring(DOWN)
    for number in range(40):
        reading = held_still(number * PERIOD)
        observer.observe(reading)
        back = reading.goal_to_body.T
        seen = (1.0 - math.exp(-number * PERIOD / LAG)) * np.concatenate([back @ force[:3], back @ force[3:]])
        np.testing.assert_allclose(observer.estimate_in_goal, seen, atol=1e-9)
        observer.given(reading, holding)
    later = held_still((number + 5) * PERIOD).goal_to_body.T
    turned = observer.ahead(np.array([0.0, 5.0 * PERIOD * TURN_RATE]))
    np.testing.assert_allclose(turned[0], observer.estimate_in_goal)
    np.testing.assert_allclose(turned[1][:3], later @ reading.goal_to_body @ turned[0][:3], atol=1e-9)


def test_a_new_episode_begins_without_an_estimate():
    observer = DisturbanceObserver(HydrodynamicModel(load_vehicle("rexrov")), PERIOD, LAG)
    observer.given(held_still(0.0), np.ones(6))
    observer.observe(held_still(PERIOD))
    assert observer.estimate_in_goal.any()
    observer.reset()
    observer.observe(held_still(0.0))
    assert not observer.estimate_in_goal.any()
