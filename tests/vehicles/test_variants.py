"""Variants of the catalogue's vehicles differ from them where their files say, and nowhere else."""

import numpy as np
import pytest

from dq_marine.algebra.attitude import attitude_angles
from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.vehicles.variants import read_variant, variant_names, varied


@pytest.mark.parametrize("name", variant_names())
def test_a_variant_is_its_vehicle_but_for_its_changes(name):
    base, changes = read_variant(name)
    assert name not in vehicle_names()
    one, other = load_vehicle(base).model_dump(), load_vehicle(name).model_dump()
    assert one != other
    for place in changes:
        *tables, key = place.split(".")
        inner, outer = one, other
        for table in tables:
            inner, outer = inner[table], outer[table]
        assert inner.pop(key) != outer.pop(key), place
    assert one == other


def test_values_are_replaced_as_a_whole_and_the_content_stays():
    content = {"a": {"b": {"c": 1, "d": 2}}, "e": 3}
    assert varied(content, {"a.b": {"c": 4}, "e": 5}) == {"a": {"b": {"c": 4}}, "e": 5}
    assert content == {"a": {"b": {"c": 1, "d": 2}}, "e": 3}


def test_whoever_misspells_one_is_told_which_there_are():
    with pytest.raises(InvalidInputError, match=r"'bluerov2_as_published'.*variants .*bluerov2_published"):
        load_vehicle("bluerov2_as_published")


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("name", "throttle"), [("bluerov2_published", 0.5), ("bluerov2_heavy_published", 1.0)]
)
def test_the_published_sets_somersault_as_their_files_say(name, throttle):
    """Ahead by the vectored thrusters, let go a degree off level."""
    body = Scene(name, step=0.01, actuation="thrusters").stepper()
    half = np.radians(0.5)
    body.reset((0.0, 0.0, 20.0), (np.cos(half), 0.0, np.sin(half), 0.0))
    commands = np.zeros(len(load_vehicle(name).channels))
    commands[:4] = throttle * np.array([1.0, 1.0, -1.0, -1.0])
    largest = 0.0
    for _ in range(300):
        body.actuate(commands, 20)
        largest = max(largest, abs(attitude_angles(body.quaternion_body_to_ned)[1]))
    assert np.degrees(largest) > 80.0
