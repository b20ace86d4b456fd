"""Ships with an MMG model in the standard manoeuvres, by shaft and rudder."""

import math

import pytest

from dq_marine.manoeuvres import turning_circle
from dq_marine.manoeuvres.rudder_steering import RudderSteering
from dq_marine.vehicles import load_vehicle


def test_a_turning_circle_of_kvlcc2_at_full_scale():
    """The approach is by the propeller, the turn that of the model by Froude's law: 3.08, 1.33 and 3.12 lengths."""
    circle = turning_circle(load_vehicle("kvlcc2"))
    assert circle.approach_speed == pytest.approx(7.97, rel=0.005)
    lengths = [value / 320.0 for value in (circle.advance, circle.transfer, circle.tactical_diameter)]
    assert lengths == pytest.approx([3.08, 1.33, 3.12], rel=0.01)


def test_full_helm_is_the_rudders_limit_and_its_moment():
    vehicle = load_vehicle("kvlcc2_l7")
    steering = RudderSteering(vehicle.manoeuvring, vehicle.buoyancy.water_density)
    assert math.degrees(steering.full_angle) == pytest.approx(35.0)
    assert steering.full_moment(1.179) == pytest.approx(vehicle.wrench_limits[5], rel=1e-3)
