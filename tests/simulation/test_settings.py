"""Settings: checked once, frozen, the same again from JSON, and the same scene and environment as from keywords."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.environments import StationKeepingEnv

from dq_marine.errors import InvalidInputError, UnknownKeywordError
from dq_marine.simulation.scene import Scene
from dq_marine.simulation.settings import Settings, SettingsKeywords
from dq_marine.task.sensors.build import KINDS
from dq_marine.vehicles import vehicle_names

WRONG = {
    "vehicle": ("titanic", "titanic.*bluerov2_heavy"),
    "current": ((1.0, 2.0), "current.*shape"),
    "weather": ("rain", "weather = 'rain'; give a list"),
    "forces": (3.0, "forces = 3.0; give a list"),
    "solids": (3.0, "solids = 3.0; give a list"),
    "gravity": (-1.0, "gravity = -1"),
    "actuation": ("sails", "actuation = 'sails' is unknown; give one of"),
    "hydrostatics": ("wet", "hydrostatics = 'wet'"),
    "radiation": ("wet", "radiation = 'wet'"),
    "scheme": ("euler", "scheme = 'euler' is unknown; give one of"),
    "order": (3, "order = 3 is unknown; give one of"),
    "kick": ("soft", "kick = 'soft' is unknown; give one of"),
    "control_period": (math.nan, "control_period = nan"),
    "substeps": (0, "substeps = 0"),
    "sensors": ("sonar", "sensors = 'sonar' is unknown; give one of"),
    "action_delay": (11, "action_delay = 11 is too large; give one from 0 to 10"),
    "observation_delay": (-1, "observation_delay = -1 is below 0"),
    "randomise": ("wild", "wild"),
    "vehicle_pool": (0, "vehicle_pool = 0"),
    "vehicle_seed": (-1, "vehicle_seed = -1 is below 0; give 0 or more"),
}


@pytest.mark.parametrize("name", [one.name for one in dataclasses.fields(Settings)])
def test_every_setting_is_checked(name):
    value, message = WRONG[name]
    with pytest.raises(InvalidInputError, match=message):
        Settings(**{name: value})


@pytest.mark.parametrize(
    ("given", "message"),
    [({"substeps": 10_001}, "at most 10000"), ({"vehicle_pool": 100_001}, "at most 100000")],
)
def test_large_numbers_are_refused(given, message):
    with pytest.raises(InvalidInputError, match=message):
        Settings(**given)


def test_keywords_are_the_settings_but_the_vehicle():
    names = {one.name for one in dataclasses.fields(Settings)}
    assert set(SettingsKeywords.__annotations__) == names - {"vehicle"}


def test_settings_do_not_change():
    made = Settings()
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.order = 4


def test_unknown_keywords_are_refused_with_the_known_ones():
    with pytest.raises(UnknownKeywordError, match=r"'colour'; there are .*'gravity'") as caught:
        Settings.of(colour="red")
    assert isinstance(caught.value, TypeError)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    with pytest.raises(UnknownKeywordError, match="an unexpected keyword argument 'frameskip'; its own are"):
        StationKeepingEnv(frameskip=1)


speeds = st.floats(-1.0, 1.0)
currents = st.one_of(
    st.floats(0.0, 2.0),
    st.tuples(speeds, speeds, speeds),
    st.none(),
    st.builds(
        lambda a, b, c: {"depths": [0.0, 1.0 + abs(a)], "velocities": [[a, b], [c, 0.0]]}, speeds, speeds, speeds
    ),
    st.builds(
        lambda a, b, c: {"mean": [a, b, 0.0], "standard_deviation": abs(c), "correlation_time": 10.0},
        speeds, speeds, speeds,
    ),
)  # fmt: skip
seas = st.fixed_dictionaries(
    {
        "kind": st.just("sea"),
        "height": st.floats(0.1, 1.0),
        "period": st.floats(4.0, 9.0),
        "direction": st.floats(-3.0, 3.0),
        "components": st.integers(1, 20),
        "seed": st.integers(0, 1000),
        "slow_drift": st.booleans(),
    }
)
winds = st.fixed_dictionaries(
    {"kind": st.just("wind"), "speed": st.floats(0.1, 20.0), "direction_from": st.floats(-3.0, 3.0)}
)
sensors = st.one_of(
    st.none(),
    st.just("auv"),
    st.dictionaries(st.sampled_from(list(KINDS)), st.fixed_dictionaries({"noise": st.floats(0.0, 1.0)})),
)
valid = st.fixed_dictionaries(
    {
        "vehicle": st.sampled_from(vehicle_names()),
        "current": currents,
        "weather": st.lists(st.one_of(seas, winds), max_size=3),
        "gravity": st.one_of(st.none(), st.floats(9.7, 9.9)),
        "scheme": st.sampled_from(["midpoint", "paper"]),
        "order": st.sampled_from([2, 4]),
        "kick": st.sampled_from(["l_stable", "implicit_node"]),
        "control_period": st.floats(0.01, 1.0),
        "substeps": st.integers(1, 20),
        "sensors": sensors,
        "action_delay": st.integers(0, 10),
        "observation_delay": st.integers(0, 10),
        "randomise": st.sampled_from([None, "default", "published"]),
        "vehicle_pool": st.integers(1, 1000),
        "vehicle_seed": st.integers(0, 2**40),
    }
)


@settings(max_examples=30)
@given(valid)
def test_json_tells_all(keywords):
    made = Settings(**keywords)
    again = Settings.from_json(made.to_json())
    assert again == made
    assert again.to_json() == made.to_json()
    assert pickle.loads(pickle.dumps(made)) == made


@settings(max_examples=30)
@given(
    valid,
    st.sampled_from([{"substeps": 21}, {"control_period": 2.0}, {"vehicle_seed": 2**41}, {"gravity": 9.6}]),
)
def test_other_settings_are_not_equal(keywords, change):
    assert Settings(**keywords) != Settings(**keywords | change)


@pytest.mark.parametrize(
    "keywords",
    [
        {"current": (0.2, 0.0, 0.0)},
        {
            "weather": [{"kind": "sea", "height": 0.3, "period": 4.0, "components": 7}],
            "gravity": 9.8,
            "order": 4,
        },
    ],
)
def test_a_scene_of_settings_is_the_scene_of_keywords(keywords):
    one = Scene(**keywords, step=0.05)
    other = Scene.from_settings(Settings(**keywords, control_period=0.1, substeps=2))
    assert one.composition == other.composition
    assert one.step == other.step
    assert repr(one.parameters_at(0.05)) == repr(other.parameters_at(0.05))


def test_an_environment_of_settings_is_that_of_keywords():
    given = {"current": 0.3, "control_period": 0.1, "substeps": 4}
    one, other = StationKeepingEnv(**given), StationKeepingEnv(settings=Settings(**given))
    assert one.settings == other.settings
    first, second = one.reset(seed=5), other.reset(seed=5)
    assert np.array_equal(first[0], second[0])
    for _ in range(20):
        action = one.np_random.uniform(-1.0, 1.0, 6)
        other.np_random.uniform(-1.0, 1.0, 6)
        first, second = one.step(action), other.step(action)
        assert np.array_equal(first[0], second[0])
        assert first[1:4] == second[1:4]


def test_settings_or_keywords_not_both():
    with pytest.raises(InvalidInputError, match=r"settings and \['current'\] are given"):
        StationKeepingEnv(settings=Settings(), current=0.1)
