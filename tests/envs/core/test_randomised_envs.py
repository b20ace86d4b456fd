"""Environments whose episodes draw their vehicle from a pool: what is flown, the same alone and among many."""

import copy
import pickle
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from support.environments import StationKeepingEnv
from support.separate import Separate, assert_flights_agree

import dq_marine  # noqa: F401 - registers
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.table import Table
from dq_marine.backend.table_type import tables_in
from dq_marine.envs.core.currents import numbers_of
from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.randomisation import Randomisation
from dq_marine.simulation.scene import Scene

ID = "dq_marine/StationKeeping-v0"
POSITIONING = "dq_marine/DynamicPositioning-v0"
POOL = {"randomise": "default", "vehicle_pool": 5, "vehicle_seed": 2}
IN_A_SEA = POOL | {"level": "medium"}


@pytest.fixture(scope="module")
def env():
    return StationKeepingEnv(**POOL)


def flown(env, periods=20, seed=0):
    """States along a flight under fixed actions, from where the environment is."""
    rng = np.random.default_rng(seed)
    states = []
    for _ in range(periods):
        env.step(rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32))
        states.append(env.get_state()["state"])
    return np.array(states)


@pytest.mark.sweep
def test_many_fly_as_each_alone():
    """To the last bit, through several episodes, each with another vehicle."""
    keywords = POOL | {"max_episode_steps": 12}
    envs = gym.make_vec(ID, num_envs=11, **keywords)
    assert_flights_agree(envs, Separate(11, **keywords), 45, seed=3)
    vehicles = envs.get_attr("flown_vehicle")
    pool = Randomisation.load().pool(envs.single.vehicle, 5, 2)
    assert {vehicle.rigid_body.mass for vehicle in vehicles} <= {vehicle.rigid_body.mass for vehicle in pool}

    numbers = []
    for _ in range(200):  # every vehicle is drawn as often as the others
        _, infos = envs.reset()
        numbers.extend(infos["vehicle"].tolist())
    counts = np.bincount(numbers, minlength=5)
    assert (np.abs(counts - 440) < 5 * np.sqrt(440 * 0.8)).all()


def test_an_episode_is_that_of_an_environment_made_for_its_vehicle(env):
    seen = set()
    for seed in range(12):
        _, info = env.reset(seed=seed)
        seen.add(info["vehicle"])
        assert env.flown_vehicle is env.pool.vehicles[info["vehicle"]]
        own = StationKeepingEnv(env.flown_vehicle, current=env.current_draw.speed)
        own.reset(
            options={
                "position": env.position_ned,
                "quaternion": env.quaternion_body_to_ned,
                "velocity": env.velocity_body,
                "current": info["current_ned"],
            }
        )
        assert np.allclose(flown(own), flown(env), rtol=1e-9, atol=1e-9)
    assert seen == {0, 1, 2, 3, 4}


def test_the_vehicles_differ_where_it_matters(env):
    """The same start and actions lead elsewhere."""
    ends = {}
    options = {"position": (0.0, 0.0, 5.0), "velocity": np.zeros(6), "current": np.zeros(3)}
    for seed in range(12):
        _, info = env.reset(seed=seed, options=options | {"quaternion": (1.0, 0.0, 0.0, 0.0)})
        end = flown(env)[-1].tobytes()
        assert ends.setdefault(info["vehicle"], end) == end
    assert len(set(ends.values())) == 5


def test_a_seed_draws_the_same_episode(env):
    first, info = env.reset(seed=4)
    again, info_again = StationKeepingEnv(**POOL).reset(seed=4)
    assert np.array_equal(first, again)
    assert info["vehicle"] == info_again["vehicle"]


def test_an_episode_is_saved_with_its_vehicle(env):
    env.reset(seed=1)
    flown(env, 3)
    state, vehicle = env.get_state(), env.flown_vehicle
    expected = flown(env)
    other = StationKeepingEnv(**POOL)
    other.set_state(state)
    assert other.flown_vehicle == vehicle
    assert np.array_equal(flown(other), expected)
    carried = pickle.loads(pickle.dumps(env))
    carried.set_state(state)
    assert np.array_equal(flown(carried), expected)
    with pytest.raises(InvalidInputError, match=r"state\['vehicle'\] = 5 is too large; give one from 0 to 4"):
        env.set_state(state | {"vehicle": 5})


def test_without_a_choice_nothing_is_drawn():
    """The random numbers of an episode are those of one without randomisation: the first two make the current."""
    plain = StationKeepingEnv(current=0.5)
    _, info = plain.reset(seed=0)
    assert "vehicle" not in info
    assert plain.flown_vehicle is plain.vehicle
    speed, direction = np.random.default_rng(0).random(2)
    angle = np.pi * (2.0 * direction - 1.0)
    assert np.allclose(info["current_ned"], (0.5 * speed * np.cos(angle), 0.5 * speed * np.sin(angle), 0.0))
    for single in (
        StationKeepingEnv(randomise=Randomisation()),
        StationKeepingEnv(**POOL | {"vehicle_pool": 1}),
    ):
        assert single.scene.composition == plain.scene.composition
    one = StationKeepingEnv(randomise=Randomisation(), vehicle_pool=1, current=0.5)
    assert np.array_equal(one.reset(seed=0)[0], plain.reset(seed=0)[0])
    assert np.array_equal(flown(one), flown(plain))


def test_the_file_says_how_strong_the_current_is():
    assert StationKeepingEnv(randomise="default", vehicle_pool=2).current_draw.speed == 0.5
    assert StationKeepingEnv(randomise="default", vehicle_pool=2, current=0.1).current_draw.speed == 0.1
    assert StationKeepingEnv(randomise=Randomisation(), vehicle_pool=2).current_draw.speed == 0.3
    assert StationKeepingEnv().current_draw.speed == 0.3


def test_gymnasium_finds_nothing_wrong(env):
    check_env(copy.copy(env), skip_render_check=True)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: StationKeepingEnv(randomise="wild"), "no randomisation 'wild'"),
        (lambda: StationKeepingEnv(**POOL | {"vehicle_pool": 0}), "vehicle_pool = 0 is below 1"),
        (lambda: StationKeepingEnv(**POOL | {"vehicle_seed": -1}), "seed = -1"),
        (
            lambda: StationKeepingEnv(**POOL, control_period=3.0, substeps=2),
            r"drawn vehicle \d of 5: step = 1.5 s is too large",
        ),
        (
            lambda: gym.make_vec(ID, num_envs=2, vehicle=["bluerov2_heavy"] * 2, **POOL),
            "a list of vehicles and randomise both say",
        ),
    ],
)
def test_bad_requests_are_refused(make, message):
    with pytest.raises(InvalidInputError, match=message):
        make()


@pytest.mark.slow
@pytest.mark.sweep
def test_vessels_with_propellers_fly_as_each_alone():
    """What a vessel that floats, its cross-flow drag and its propellers have drawn reaches the lanes, too."""
    keywords = POOL | {"vehicle": "otter", "actuation": "thrusters", "max_episode_steps": 6}
    envs = gym.make_vec(ID, num_envs=9, **keywords)
    assert_flights_agree(envs, Separate(9, **keywords), 20, seed=3)
    assert len(set(envs.get_attr("flown_vehicle"))) > 1


def a_sea_of_ones_own(vehicle, current_ned):
    """Weather whose table is the longer, the heavier the vehicle."""
    table = Table([0.0] * int(vehicle.rigid_body.mass))
    return (ForceTerm("own", tabled_force, (table,)),)


def tabled_force(parameters, pose, time):
    return Spatial((0.0, 0.0, 0.0), (parameters[0][0], 0.0, 0.0))


def test_weather_that_answers_vehicles_by_tables_of_different_lengths_is_refused():
    """One's numbers would be read where another's are."""
    own = SimpleNamespace(changes=False, terms=a_sea_of_ones_own)
    with pytest.raises(
        InvalidInputError, match=r"forces on drawn vehicle \d have .* same length for all, or leave randomise"
    ):
        StationKeepingEnv(weather=[own], **POOL)


def test_sea_and_wind_push_drawn_ships_as_the_one_they_are_drawn_from():
    env = gym.make(POSITIONING, **IN_A_SEA).unwrapped
    nominal = Scene.from_settings(env.settings)
    assert {"waves", "slow drift", "wind"} <= set(nominal.terms)
    wanted = numbers_of(nominal)
    assert len(tables_in(wanted)) > 10
    for parameters in env.pool.parameters:
        assert parameters.inertia != wanted.inertia
        assert tables_in(parameters) == tables_in(wanted)


@pytest.mark.slow
@pytest.mark.sweep
def test_drawn_ships_in_a_sea_fly_as_each_alone():
    keywords = IN_A_SEA | {"max_episode_steps": 6}
    envs = gym.make_vec(POSITIONING, num_envs=9, **keywords)
    assert_flights_agree(envs, Separate(9, POSITIONING, **keywords), 20, seed=3)
    assert len(set(envs.get_attr("flown_vehicle"))) > 1


def test_ships_of_a_pool_have_their_own_numbers():
    """In calm water, where the tables of all are of one size: what is unpacked is what was prepared."""
    env = gym.make("dq_marine/Berthing-v0", level="hard", **POOL).unwrapped
    for seed in range(5):
        _, info = env.reset(seed=seed)
        prepared = env.pool.parameters[int(info["vehicle"])]
        assert env._parameters.inertia == prepared.inertia
        assert np.isfinite(env.velocity_through_water).all()
