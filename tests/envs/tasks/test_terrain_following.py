"""Terrain following: what beams tell, what counts as success, and a controller that keeps the altitude."""

import math

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.agents.controllers.terrain import TerrainController
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.packing import unpack
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.envs.tasks import terrain_following as task
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import Motion
from dq_marine.task.grounds import make_wavy_ground
from dq_marine.task.protocol import Situation
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/TerrainFollowing-v0"
QUIET = {"noise": 0.0, "dropout": 0.0}
VEHICLE = load_vehicle("remus100")
DEPTH_AT = make_wavy_ground(task.WAVES).depth


def made(**keywords):
    return gym.make(ID, **keywords).unwrapped


def memory_of(env):
    return unpack(env.blank_memory, env.get_state()["memory"])


def numbers(period=0.5):
    settings = task.fitted(task.Settings(), VEHICLE)
    return task.parameters(settings, EpisodeContext(VEHICLE, period, {}))


def glide(own, seed, pace=1.0, high=lambda along: 0.0):
    """The situations of a body that goes along the track level, at a share of the speed, too high by so much [m]."""
    uniforms = tuple(np.random.default_rng(seed).random(task.START_DRAWS + 4 * task.WAVES).tolist())
    memory = task.initial_memory(own, task.start(own, uniforms), uniforms)
    (north, east), speed, along = memory.course, pace * own.flight.speed, 0.0
    attitude = quaternion_from_euler(0.0, 0.0, math.atan2(east, north))
    found = []
    while len(found) < 400 and not (found and task.terminated(own, found[-1])):
        along += speed * own.flight.period
        place = (along * north, along * east)
        depth = DEPTH_AT(memory.ground, *place) - own.flight.altitude - high(along)
        motion = Motion((*place, depth), attitude, Spatial((0.0, 0.0, 0.0), (speed, 0.0, 0.0)))
        memory = task.update_memory(own, memory, motion, motion)
        found.append(Situation(motion, memory, task.measure(own, memory, motion), 0.0, 3.0))
    return found


def test_the_track_flown_at_the_altitude_and_the_pace_is_success_and_only_at_its_end():
    own = numbers()
    found = glide(own, 1)
    assert [bool(task.succeeded(own, now)) for now in found] == [False] * (len(found) - 1) + [True]
    assert found[-1].metrics.rms_error == pytest.approx(0.0, abs=1e-9)
    assert found[-1].metrics.mean_speed_error == pytest.approx(0.0, abs=1e-9)
    rewards = task.reward(own, task.Rewards(), found[0])
    assert (rewards.progress, rewards.nearness) == pytest.approx((0.4, 0.6))


@pytest.mark.parametrize(("share", "succeeds"), [(0.9, True), (1.1, False)])
def test_the_rms_error_decides_whatever_its_sign_and_counts_from_a_quarter_of_the_track_on(share, succeeds):
    own = numbers()

    def high(along):
        if along < 0.2 * own.track:
            return own.flight.altitude  # before errors count, anything goes
        return share * own.tolerance * (1.0 if int(along / 3.0) % 2 else -1.0)

    last = glide(own, 2, high=high)[-1]
    assert last.metrics.rms_error == pytest.approx(share * own.tolerance)
    assert task.succeeded(own, last) == succeeds
    assert task.terminated(own, last)


@pytest.mark.parametrize(("pace", "succeeds"), [(0.85, False), (0.95, True), (1.15, False)])
def test_the_pace_must_be_kept_as_well(pace, succeeds):
    own = numbers()
    last = glide(own, 3, pace=pace)[-1]
    assert last.metrics.mean_speed_error == pytest.approx(abs(1.0 - pace) * own.flight.speed)
    assert task.succeeded(own, last) == succeeds


def test_contact_with_the_seabed_ends_the_episode_at_the_speed_of_the_impact():
    own = numbers()
    last = glide(own, 4, high=lambda along: -0.1 * along)[-1]
    assert last.metrics.clearance < 0.0
    assert last.metrics.share_done < 1.0
    assert last.metrics.impact_speed == pytest.approx(own.flight.speed)
    assert task.reward(own, task.Rewards(), last).contact == -20.0
    assert not task.succeeded(own, last)


def test_a_vehicle_that_climbs_away_is_lost():
    own = numbers()
    last = glide(own, 5, high=lambda along: 0.5 * along)[-1]
    assert last.metrics.altitude_error > task.LOST * own.flight.altitude
    assert task.terminated(own, last)
    assert not task.succeeded(own, last)


@pytest.mark.parametrize("vehicle", ["remus100", "bluerov2_heavy"])
def test_episodes_begin_under_way_about_at_the_altitude_and_the_altimeter_tells_it(vehicle):
    env = made(vehicle=vehicle, **QUIET)
    length, speed = env.vehicle.dimensions.length, cruising_speed(env.vehicle)
    read = parts_reader(env, (*TerrainController.READS, "ordered_altitude"))
    for seed in range(20):
        observation, info = env.reset(seed=seed)
        parts, memory = read(observation), memory_of(env)
        altitude = 4.0 * length + info["altitude_error"]
        assert abs(info["altitude_error"]) <= 0.8 * length + 1e-9
        assert parts["ordered_altitude"][0] == pytest.approx(4.0 * length)
        assert parts["altimeter_reading"][0] == pytest.approx(altitude / (16.0 * length), rel=1e-5)
        assert 0.5 * speed - 1e-6 <= parts["linear_velocity_body"][0] <= speed + 1e-6
        assert parts["track_ahead_body"][0] >= math.cos(math.radians(20.0)) - 1e-6
        assert np.hypot(*memory.course) == pytest.approx(1.0)
        assert info["clearance"] > length


def test_readings_have_noise_and_are_lost_as_often_as_told():
    exact, noisy, lossy = (
        made(noise=noise, dropout=dropout) for noise, dropout in ((0.0, 0.0), (0.02, 0.0), (0.0, 0.5))
    )
    off, lost = [], []
    for seed in range(60):
        true, told, holed = (env.reset(seed=seed)[0][: task.BEAMS] for env in (exact, noisy, lossy))
        met = true < 0.9
        off += (told - true)[met].tolist()
        lost += (holed[met] == 1.0).tolist()
    assert np.std(off) == pytest.approx(0.02, rel=0.15)
    assert np.mean(lost) == pytest.approx(0.5, abs=0.1)


@pytest.mark.sweep
def test_the_controller_keeps_the_altitude_where_one_that_sees_nothing_does_not():
    env = made(level="medium")
    controller = controller_for(env)
    assert isinstance(controller, TerrainController)
    ends = {False: [], True: []}
    for blind in ends:
        for seed in range(4):
            observation, info = env.reset(seed=seed)
            controller.reset(env)
            done = False
            while not done:
                if blind:
                    observation[: task.BEAMS] = 1.0
                observation, _, terminated, truncated, info = env.step(controller.act(observation))
                done = terminated or truncated
            ends[blind].append(bool(info["is_success"]))
    assert all(ends[False])
    assert not any(ends[True])


@pytest.mark.parametrize("name", ["speed", "altitude", "wave", "slope", "reach", "noise", "dropout", "track"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far"])
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        made(**{name: value})
