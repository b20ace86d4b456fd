"""Whatever a solver tries is a physical vehicle; theta = 0 is the one in the file."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.sweeps import sweep

from dq_marine import load_vehicle, vehicle_names
from dq_marine.errors import InvalidInputError
from dq_marine.identification.parameters import LARGEST_THETA, parameters_of, quantities_of, vehicle_with

FULL = ("added_mass_full", "linear", "quadratic", "couplings", "cross_flow")
SCALED = ("added_mass", "linear", "quadratic", "couplings", "cross_flow")
THETAS = st.lists(st.floats(-LARGEST_THETA, LARGEST_THETA), min_size=60, max_size=60)


@pytest.mark.parametrize("name", sweep(vehicle_names(), plain=["rexrov", "remus100"]))
@pytest.mark.parametrize("groups", [FULL, SCALED])
def test_mass_and_damping_stay_positive(name, groups):
    nominal = load_vehicle(name)
    if np.linalg.eigvalsh(nominal.added_mass_matrix).min() < 0.0:
        with pytest.raises(InvalidInputError, match="eigenvalue of -"):
            parameters_of(nominal, groups)
        groups = groups[1:]
    parameters = parameters_of(nominal, groups)

    @settings(max_examples=25, derandomize=True)
    @given(THETAS)
    def physical(thetas):
        theta = np.array(thetas)[: len(parameters)]
        try:
            vehicle = vehicle_with(nominal, parameters, theta)
        except ValueError as refusal:
            assert re.search("added mass|drag_coefficient", str(refusal))  # more than a file may say
            return
        scale = np.sqrt(np.diag(vehicle.mass_matrix))
        assert np.linalg.eigvalsh(vehicle.mass_matrix / np.outer(scale, scale)).min() > 0.0
        assert (vehicle.added_mass_matrix == vehicle.added_mass_matrix.T).all()
        symmetric = 0.5 * (vehicle.linear_damping + vehicle.linear_damping.T)
        assert np.linalg.eigvalsh(symmetric).min() >= -1e-9 * np.abs(symmetric).max()
        assert (vehicle.quadratic_damping >= 0.0).all()

    physical()


@pytest.mark.parametrize("name", vehicle_names())
def test_zero_is_the_file(name):
    nominal = load_vehicle(name)
    groups = [group for group in (*SCALED, "manoeuvring", "gains") if _has(nominal, group)]
    parameters = parameters_of(nominal, groups)
    vehicle = vehicle_with(nominal, parameters, np.zeros(len(parameters)))
    assert vehicle.mass_matrix == pytest.approx(nominal.mass_matrix, rel=1e-12)
    assert vehicle.linear_damping == pytest.approx(nominal.linear_damping, rel=1e-12)
    assert vehicle.quadratic_damping == pytest.approx(nominal.quadratic_damping)
    assert vehicle.damping_couplings == pytest.approx(nominal.damping_couplings)
    assert vehicle.actuators == nominal.actuators
    assert vehicle.manoeuvring == nominal.manoeuvring
    labels = [parameter.label for parameter in parameters]
    assert len(set(labels)) == len(labels)


def _has(vehicle, group):
    try:
        return bool(parameters_of(vehicle, [group]))
    except InvalidInputError:
        return False


@pytest.mark.parametrize("name", ["remus100", "kvlcc2_l7"])
def test_each_parameter_moves_its_own_number(name):
    nominal = load_vehicle(name)
    parameters = parameters_of(nominal, (*SCALED, "manoeuvring", "gains"))
    before = [one.value for one in quantities_of(nominal, parameters)]
    for place, parameter in enumerate(parameters):
        theta = np.zeros(len(parameters))
        theta[place] = 0.1
        after = [one.value for one in quantities_of(vehicle_with(nominal, parameters, theta), parameters)]
        moved = np.flatnonzero(~np.isclose(before, after, rtol=1e-9))
        assert moved.tolist() == [place], parameter.label


def test_a_hull_resists_surge_sway_and_yaw_whatever_is_tried():
    nominal = load_vehicle("kvlcc2_l7")
    parameters = parameters_of(nominal, ["manoeuvring"])
    assert len(parameters) == 17

    @settings(max_examples=100, derandomize=True)
    @given(THETAS)
    def resists(thetas):
        try:
            hull = vehicle_with(nominal, parameters, thetas[:17]).manoeuvring.hull
        except ValueError as refusal:
            assert re.search("drives (sway|yaw|surge) instead of resisting it", str(refusal))
            return
        assert hull.surge.resistance > 0.0
        assert hull.sway.v < 0.0
        assert hull.yaw.r < 0.0

    resists()


def test_a_full_added_mass_reaches_any_coupling():
    nominal = load_vehicle("bluerov2_heavy")
    parameters = parameters_of(nominal, ["added_mass_full"])
    assert len(parameters) == 21
    theta = np.random.default_rng(0).uniform(-1.0, 1.0, 21)
    added = vehicle_with(nominal, parameters, theta).added_mass_matrix
    assert np.linalg.eigvalsh(added).min() > 0.0
    assert (added[np.tril_indices(6)] != 0.0).all()


@pytest.mark.parametrize(
    ("groups", "message"),
    [
        (["mass"], r"fit = 'mass' is unknown; give some of added_mass"),
        ([], r"fit = '' is unknown"),
        (["added_mass", "added_mass_full"], r"two forms of one matrix"),
        (["cross_flow"], r"'BlueROV2 Heavy' has nothing of cross_flow to fit"),
    ],
)
def test_wrong_groups(groups, message):
    with pytest.raises(InvalidInputError, match=message):
        parameters_of(load_vehicle("bluerov2_heavy"), groups)
