"""In what drawn vehicles are not the nominal one: the factors that were drawn, of every vehicle there is."""

import numpy as np
import pytest

from dq_marine.randomisation import Randomisation
from dq_marine.randomisation.differences import BODIES, WRENCHES, differences
from dq_marine.vehicles import load_vehicle, vehicle_names


def always(value):
    """A distribution of one number."""
    return {"uniform": (value, value)}


def found_in(drawn, nominal, actuation="wrench"):
    """Return the differences of two drawn vehicles by name: of what varies alone."""
    return {one.difference.name: one.numbers for one in differences(drawn, nominal, actuation)}


@pytest.mark.parametrize("name", vehicle_names())
def test_the_factors_are_those_that_were_drawn(name):
    nominal = load_vehicle(name)
    tables = {
        "rigid_body": {"mass": always(1.1)},
        "added_mass": {"factor": always(1.3)},
        "damping": {"linear": always(0.7), "quadratic": always(1.4)},
        "actuators": {"wrench": always(0.9)},
    }
    drawn = Randomisation.model_validate(tables).draw(nominal, 0)
    told = {one.name: one.between(drawn, nominal) for one in (*BODIES, *WRENCHES)}
    assert told["mass_factor"] == pytest.approx(1.1)
    for part, factor in (
        ("added_mass_factors", 1.3),
        ("linear_damping_factors", 0.7),
        ("quadratic_damping_factors", 1.4),
        ("wrench_factors", 0.9),
    ):
        assert set(np.round(told[part], 9)) <= {factor, 1.0}, part  # 1 where the nominal vehicle has nothing
    assert factor in np.round(told["wrench_factors"], 9)
    for one in (*BODIES, *WRENCHES):
        own = one.between(nominal, nominal)
        assert own == pytest.approx(1.0 if one.name.endswith(("factor", "factors")) else 0.0), one.name


def test_only_what_varies_is_told():
    nominal = load_vehicle("bluerov2_heavy")
    drawn = Randomisation.model_validate({"damping": {"linear": {"uniform": (0.5, 1.5)}}}).pool(nominal, 5)
    found = found_in(drawn, nominal)
    assert set(found) == {"linear_damping_factors"}
    numbers = found["linear_damping_factors"]
    assert numbers.shape == (5, 6)
    driven = np.diag(nominal.linear_damping) > 0.0
    expected = [
        np.diag(one.linear_damping)[driven] / np.diag(nominal.linear_damping)[driven] for one in drawn
    ]
    assert numbers[:, driven] == pytest.approx(np.array(expected))
    assert found_in(drawn[:1], nominal) == {}


def test_weight_and_righting_are_told_as_shifts():
    nominal = load_vehicle("bluerov2_heavy")
    tables = {"buoyancy": {"net_weight": {"uniform": (-0.01, 0.01)}, "list_angle": {"uniform": (-5.0, 5.0)}}}
    drawn = Randomisation.model_validate(tables).pool(nominal, 4)
    found = found_in(drawn, nominal)
    for number, one in enumerate(drawn):
        share = (one.weight - one.buoyant_force) / one.weight
        before = (nominal.weight - nominal.buoyant_force) / nominal.weight
        assert found["net_weight_shift"][number] == pytest.approx([share - before])
        arm = one.restoring_arm / one.weight - nominal.restoring_arm / nominal.weight
        assert found["righting_arm_shift"][number] == pytest.approx(arm)


def test_vessels_that_float_are_told_of_their_stiffness():
    nominal = load_vehicle("otter")
    drawn = Randomisation.model_validate({"buoyancy": {"righting_lever": {"uniform": (0.5, 2.0)}}}).pool(
        nominal, 4
    )
    told = found_in(drawn, nominal)["stiffness_factors"]
    expected = [np.diag(one.waterplane_stiffness) / np.diag(nominal.waterplane_stiffness) for one in drawn]
    assert told == pytest.approx(np.array(expected))
