"""Formation keeping: what it takes to succeed, by the task's formulas alone, and that the baseline does."""

import math

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.formations import FormationController
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.packing import pack
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import Motion
from dq_marine.task.protocol import Situation
from dq_marine.vehicles import load_vehicle

FORMATION_KEEPING = "dq_marine/FormationKeeping-v0"
VEHICLES = ("remus100", "bluerov2", "bluerov2_heavy", "rexrov", "npsauv")
DEFINITION = task_named(FORMATION_KEEPING)
TASK = DEFINITION.task


def numbers(vehicle="remus100", **keywords):
    vehicle = load_vehicle(vehicle)
    settings = DEFINITION.checked_settings(keywords, vehicle)
    return DEFINITION.parameters(settings, EpisodeContext(vehicle, DEFINITION.period_for(vehicle), {}))


def in_place(own, memory, off=(0.0, 0.0, 0.0)):
    """The motion of who is in its place, or off it."""
    place = DEFINITION.goal(own, memory)
    velocity = Spatial((0.0, 0.0, 0.0), (own.speed, 0.0, 0.0))
    return Motion(tuple(np.add(place.position_ned, off)), place.attitude, velocity)


def marched(own, follow, seed=0):
    """The situations of an episode in which the vehicle is where `follow(memory so far)` says."""
    random = np.random.default_rng(seed)
    uniforms = tuple(random.random(TASK.draws).tolist())
    begun = TASK.start(own, uniforms)
    memory = TASK.initial_memory(own, begun, uniforms)
    memory = TASK.sense(own, memory, Motion(*begun), tuple(random.random(TASK.sense_draws).tolist()))
    while True:
        motion = follow(memory)
        memory = TASK.sense(own, memory, motion, tuple(random.random(TASK.sense_draws).tolist()))
        memory = TASK.update_memory(own, memory, motion, motion)
        now = Situation(motion, memory, TASK.measure(own, memory, motion), 0.0, 3.0)
        yield now
        if TASK.terminated(own, now):
            return


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_who_is_in_place_all_the_way_succeeds_at_the_end_of_the_course(vehicle):
    own = numbers(vehicle)
    *before, last = marched(own, lambda memory: in_place(own, memory))
    assert TASK.succeeded(own, last)
    assert not any(TASK.succeeded(own, one) for one in before)
    assert last.metrics.worst_error < 2.0 * own.speed * own.period  # it is a period late
    assert last.metrics.nearest_distance > own.safe
    assert len(before) + 1 <= DEFINITION.max_episode_steps
    terms = TASK.reward(own, DEFINITION.weights, last)
    assert terms.finish == DEFINITION.weights.finish
    assert sum(terms) > sum(TASK.reward(own, DEFINITION.weights, before[-1]))


def test_an_error_counts_in_the_last_half_alone():
    own = numbers()
    far = (0.0, 0.0, 1.5 * own.tolerance)

    def off_in(first, last):
        def follow(memory):
            off = far if first <= memory.metrics.share_done < last else (0.0, 0.0, 0.0)
            return in_place(own, memory, off)

        return list(marched(own, follow))[-1]

    assert TASK.succeeded(own, off_in(0.0, 0.45))
    assert not TASK.succeeded(own, off_in(0.6, 0.65))


def test_who_stays_behind_is_lost_and_who_comes_too_near_has_hit():
    own = numbers()
    still = marched(
        own,
        lambda memory: Motion(
            (0.0, 0.0, own.depth + 30.0), (1.0, 0.0, 0.0, 0.0), Spatial((0.0,) * 3, (0.0,) * 3)
        ),
    )
    *_, lost = still
    assert lost.metrics.slot_error > 5.0 * own.spacing
    assert not TASK.succeeded(own, lost)
    leader = Motion((0.5 * own.safe, 0.0, own.depth), (1.0, 0.0, 0.0, 0.0), Spatial((0.0,) * 3, (0.0,) * 3))
    (hit,) = marched(own, lambda memory: leader)
    assert hit.metrics.nearest_distance < own.safe
    assert TASK.reward(own, DEFINITION.weights, hit).collision == -DEFINITION.weights.collision


@pytest.mark.parametrize("level", DEFINITION.levels)
def test_starts_are_about_ones_place_and_hit_nobody(level):
    keywords = {
        name: value for name, value in DEFINITION.levels[level].items() if name in DEFINITION.keywords
    }
    own, random = numbers(**keywords), np.random.default_rng(0)
    for _ in range(50):
        uniforms = tuple(random.random(TASK.draws).tolist())
        begun = TASK.start(own, uniforms)
        metrics = TASK.initial_memory(own, begun, uniforms).metrics
        assert metrics.slot_error <= 0.3 * math.sqrt(2.0) * own.spacing + 1e-9
        assert metrics.heading_error <= math.radians(20.0) + 1e-9
        assert metrics.nearest_distance > 0.5 * own.spacing


@pytest.mark.parametrize("contents", ["none", "course", "position"])
def test_what_is_observed_stays_within_its_bounds_wherever_the_vehicle_is(contents):
    vehicle = load_vehicle("remus100")
    settings = DEFINITION.checked_settings({"contents": contents, "drift": 100.0, "noise": 100.0}, vehicle)
    own = numbers(contents=contents, drift=100.0, noise=100.0)
    bounds = np.array(
        [one.bound for one in DEFINITION.observations(settings, vehicle) for _ in range(one.size)]
    )
    random = np.random.default_rng(0)
    for now in marched(own, lambda memory: in_place(own, memory, tuple(random.normal(0.0, 8.0, 3)))):
        attitude = quaternion_from_euler(*random.uniform(-1.5, 1.5, 2), random.uniform(-3.0, 3.0))
        astray = Motion(tuple(random.normal(0.0, 1e3, 3)), attitude, Spatial((20.0,) * 3, (20.0,) * 3))
        for motion in (now.motion, astray):
            shown = pack(TASK.observe(own, now.memory, motion))
            assert shown.shape == bounds.shape
            assert (np.abs(shown) <= bounds * (1.0 + 1e-12)).all()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(
            (name, value)
            for name in ("spacing", "turn", "climb", "noise", "dropout", "drift")
            for value in (-1.0, math.nan, 1e300, "far")
        ),
        ("contents", "all"),
        ("contents", 2),
    ],
)
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        numbers(**{name: value})


@pytest.mark.sweep
@pytest.mark.parametrize("vehicle", VEHICLES)
def test_the_baseline_keeps_its_place(vehicle):
    env = gym.make(FORMATION_KEEPING, vehicle=vehicle, level="medium")
    controller = controller_for(env)
    assert isinstance(controller, FormationController)
    for seed in range(3):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}: {episode.measured}"
