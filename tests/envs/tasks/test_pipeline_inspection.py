"""Pipeline inspection: what sonar and detector tell, what counts as success, and a controller that follows the pipe."""

import math

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.pipelines import PipelineController
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.packing import unpack
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.tasks import pipeline_inspection as task
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import Motion
from dq_marine.task.grounds import make_wavy_ground
from dq_marine.task.protocol import Situation
from dq_marine.task.splines import winding_draws
from dq_marine.task.world.pipes import make_pipe
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/PipelineInspection-v0"
QUIET = {"noise": 0.0, "dropout": 0.0}
VEHICLE = load_vehicle("remus100")
GROUNDS = make_wavy_ground(task.WAVES)
LAID = make_pipe(GROUNDS.along, GROUNDS.cast).laid
DRAWS = task.START_DRAWS + winding_draws(task.SPANS) + 4 * task.WAVES


def made(**keywords):
    return gym.make(ID, **keywords).unwrapped


def numbers(period=0.5):
    settings = task.fitted(task.Settings(), VEHICLE)
    return task.parameters(settings, EpisodeContext(VEHICLE, period, {}))


def glide(own, seed, aside=0.0, high=lambda done: 0.0, skew=0.0):
    """The situations of a body that goes beside the pipe, too high by so much [m], and over ground off its course."""
    uniforms = tuple(np.random.default_rng(seed).random(DRAWS).tolist())
    memory = task.initial_memory(own, task.start(own, uniforms), uniforms)
    found, parameter, still = [], 0.0, (0.0, 0.0, 0.0)
    while len(found) < 400 and not (found and task.terminated(own, found[-1])):
        parameter += own.flight.speed * own.flight.period / own.leg
        nearest = min(parameter, float(task.SPANS))
        at, way = task.point_at(memory.controls, nearest)[:2]
        at = tuple(
            a + (parameter - nearest) * w for a, w in zip(at, way, strict=True)
        )  # straight on at the end
        course = math.atan2(way[1], way[0])
        north, east = at[0] - aside * math.sin(course), at[1] + aside * math.cos(course)
        axis = LAID(memory.ground, at[:2], way[:2], own.radius).on_axis[2]
        depth = axis - own.flight.altitude - high(parameter / task.SPANS)
        attitude = quaternion_from_euler(0.0, 0.0, course + skew)
        motion = Motion((north, east, depth), attitude, Spatial(still, (own.flight.speed, 0.0, 0.0)))
        memory = task.update_memory(own, memory, motion, motion)
        found.append(Situation(motion, memory, task.measure(own, memory, motion), 0.0, 3.0))
    return found


def test_the_pipe_followed_at_the_altitude_is_success_and_only_at_its_end():
    own = numbers()
    found = glide(own, 1)
    assert [bool(task.succeeded(own, now)) for now in found] == [False] * (len(found) - 1) + [True]
    metrics = found[-1].metrics
    assert metrics.mean_cross_track_error == pytest.approx(0.0, abs=1e-3)
    assert metrics.mean_altitude_error == pytest.approx(0.0, abs=1e-3)
    assert metrics.mean_course_error == pytest.approx(0.0, abs=1e-3)
    rewards = task.reward(own, task.Rewards(), found[10])
    assert (rewards.progress, rewards.nearness) == pytest.approx((0.4, 0.6), abs=1e-2)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("share", "succeeds"), [(0.9, True), (1.1, False)])
def test_mean_errors_across_and_up_decide(side, share, succeeds):
    own = numbers()
    off = side * share * own.tolerance
    across, up = glide(own, 2, aside=off)[-1], glide(own, 2, high=lambda done: off)[-1]
    assert across.metrics.mean_cross_track_error == pytest.approx(abs(off), rel=0.01)
    assert across.metrics.cross_track_error == pytest.approx(off, rel=0.01)
    assert up.metrics.mean_altitude_error == pytest.approx(abs(off), rel=0.01)
    assert task.succeeded(own, across) == task.succeeded(own, up) == succeeds


@pytest.mark.parametrize(("skew", "succeeds"), [(0.9, True), (-1.1, False)])
def test_the_course_over_ground_must_be_along_the_pipe(skew, succeeds):
    own = numbers()
    last = glide(own, 3, skew=skew * task.ASKEW)[-1]
    assert last.metrics.mean_course_error == pytest.approx(abs(skew) * task.ASKEW, rel=0.01)
    assert last.metrics.course_error == pytest.approx(skew * task.ASKEW, rel=0.01)
    assert task.succeeded(own, last) == succeeds


def test_contact_with_the_pipe_ends_the_episode_at_the_speed_of_the_impact():
    own = numbers()
    last = glide(own, 4, high=lambda done: -2.0 * done * own.flight.altitude)[-1]
    assert last.metrics.clearance < 0.0
    assert last.metrics.share_done < 1.0
    assert last.metrics.impact_speed == pytest.approx(own.flight.speed)
    assert task.reward(own, task.Rewards(), last).contact == -20.0
    assert not task.succeeded(own, last)


def test_whoever_leaves_the_pipe_is_lost():
    own = numbers()
    last = glide(own, 5, aside=1.1 * task.LOST * own.flight.altitude)[-1]
    assert task.terminated(own, last)
    assert not task.succeeded(own, last)


@pytest.mark.parametrize("vehicle", ["remus100", "bluerov2_heavy"])
def test_the_detector_tells_where_the_pipe_is_and_the_sonar_how_far_the_ground(vehicle):
    """At the start the pipe is straight and about along the bow, so that plane geometry tells the sight."""
    env = made(vehicle=vehicle, turn=0.0, slope=0.0, **QUIET)
    length = env.vehicle.dimensions.length
    read = parts_reader(env, PipelineController.READS)
    for seed in range(10):
        observation, info = env.reset(seed=seed)
        parts, memory = read(observation), unpack(env.blank_memory, env.get_state()["memory"])
        assert parts["pipe_seen"][0] == 1.0
        assert parts["pipe_ahead"][0] == pytest.approx(3.0 * length)
        bearing = memory.shown.sight.bearing
        expected = 3.0 * length * math.tan(bearing) - info["cross_track_error"] / math.cos(bearing)
        assert parts["pipe_starboard"][0] == pytest.approx(expected, abs=1e-4)
        height = 3.0 * length + info["altitude_error"] + 0.15 * length  # over the ground that it lies on
        outer = parts["sonar_readings"][0] * 9.0 * length * math.cos(math.radians(50.0))
        assert outer == pytest.approx(height, rel=1e-4)


def test_the_detector_loses_the_pipe_as_often_as_told():
    env = made(noise=0.0, dropout=0.4)
    read = parts_reader(env, PipelineController.READS)
    seen = [read(env.reset(seed=seed)[0])["pipe_seen"][0] for seed in range(120)]
    assert np.mean(seen) == pytest.approx(0.6, abs=0.13)


@pytest.mark.sweep
def test_the_controller_follows_the_pipe_where_one_that_sees_nothing_does_not():
    env = made(level="medium")
    controller = controller_for(env)
    assert isinstance(controller, PipelineController)
    ends = {False: [], True: []}
    for blind in ends:
        for seed in range(4):
            observation, info = env.reset(seed=seed)
            controller.reset(env)
            done = False
            while not done:
                if blind:
                    observation[: task.BEAMS] = 1.0
                    observation[task.BEAMS : task.BEAMS + 3] = 0.0
                observation, _, terminated, truncated, info = env.step(controller.act(observation))
                done = terminated or truncated
            ends[blind].append(bool(info["is_success"]))
    assert all(ends[False])
    assert not any(ends[True])


@pytest.mark.parametrize("name", ["altitude", "slope", "leg", "turn", "pipe_radius", "noise", "dropout"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far"])
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        made(**{name: value})
