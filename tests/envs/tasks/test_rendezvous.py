"""Rendezvous: what it takes to succeed, by the task's formulas alone, and that the baseline does."""

import math
from typing import NamedTuple

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.rendezvous import RendezvousController
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.packing import pack
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import SOUND_SPEED
from dq_marine.task.protocol import Situation
from dq_marine.vehicles import load_vehicle

RENDEZVOUS = "dq_marine/Rendezvous-v0"
VEHICLES = ("remus100", "bluerov2", "bluerov2_heavy", "rexrov", "npsauv")
DEFINITION = task_named(RENDEZVOUS)
TASK = DEFINITION.task


class Beside(NamedTuple):
    """How a vehicle goes beside its partner: how far to starboard [m], how fast over its speed, turned by [rad]."""

    starboard: float
    speed: float = 1.0
    turned: float = 0.0


def numbers(vehicle="remus100", **keywords):
    vehicle = load_vehicle(vehicle)
    settings = DEFINITION.checked_settings(keywords, vehicle)
    return DEFINITION.parameters(settings, EpisodeContext(vehicle, DEFINITION.period_for(vehicle), {}))


def partner_of(own, memory):
    """Where the partner is, and its course [rad]: the goal is abreast of it."""
    place, (w, _, _, z) = DEFINITION.goal(own, memory)
    course, beside = 2.0 * math.atan2(z, w), 0.5 * (own.safe + own.meeting)
    return np.array(place) - beside * np.array([-math.sin(course), math.cos(course), 0.0]), course


def moving(own, memory, beside):
    """The motion of a vehicle beside its partner, on the level."""
    place, course = partner_of(own, memory)
    off = (-beside.starboard * math.sin(course), beside.starboard * math.cos(course), 0.0)
    velocity = Spatial((0.0, 0.0, 0.0), (beside.speed * own.speed, 0.0, 0.0))
    return Motion(
        tuple(np.add(place, off)), quaternion_from_euler(0.0, 0.0, course + beside.turned), velocity
    )


def flown(own, follow, seed=0):
    """The situations of an episode in which the vehicle moves as `follow(number of the period)` says."""
    random = np.random.default_rng(seed)
    uniforms = tuple(random.random(TASK.draws).tolist())
    memory = TASK.initial_memory(own, TASK.start(own, uniforms), uniforms)
    for step in range(DEFINITION.max_episode_steps):
        motion = moving(own, memory, follow(step))
        memory = TASK.sense(own, memory, motion, tuple(random.random(TASK.sense_draws).tolist()))
        memory = TASK.update_memory(own, memory, motion, motion)
        now = Situation(motion, memory, TASK.measure(own, memory, motion), 0.0, 3.0)
        yield now
        if TASK.terminated(own, now):
            return


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_who_stays_beside_the_partner_for_long_enough_succeeds(vehicle):
    own = numbers(vehicle)
    *before, last = flown(own, lambda step: Beside(0.5 * (own.safe + own.meeting)))
    assert TASK.succeeded(own, last)
    assert not any(TASK.succeeded(own, one) for one in before)
    assert (len(before) + 1) * own.period == pytest.approx(own.hold, abs=own.period)
    terms = TASK.reward(own, DEFINITION.weights, last)
    assert terms.finish == DEFINITION.weights.finish
    assert sum(terms) > sum(TASK.reward(own, DEFINITION.weights, before[-1]))


@pytest.mark.parametrize(
    "wrong", [Beside(1.2), Beside(0.5, speed=0.7), Beside(0.5, speed=1.3), Beside(0.5, turned=0.35)]
)
def test_it_takes_nearness_and_speed_and_course_all_the_while(wrong):
    """A single period otherwise, and the time counts anew; always otherwise, and there is no success."""
    own = numbers(turn=0.0, climb=0.0)
    good, wrong = Beside(0.5 * own.meeting), wrong._replace(starboard=wrong.starboard * own.meeting)
    periods = round(own.hold / own.period)
    *_, last = flown(own, lambda step: wrong if step == periods - 5 else good)
    assert TASK.succeeded(own, last)
    assert last.memory.course.parameter * own.winding.leg > 1.8 * own.hold * own.speed
    *_, last = flown(own, lambda step: wrong)
    assert not TASK.succeeded(own, last)
    assert last.metrics.held_time == 0.0


def test_who_comes_too_near_has_hit_who_stays_away_is_lost_and_a_course_has_an_end():
    own = numbers()
    (hit,) = flown(own, lambda step: Beside(0.9 * own.safe))
    assert DEFINITION.collided(own, hit.memory)
    assert TASK.reward(own, DEFINITION.weights, hit).collision == -DEFINITION.weights.collision
    (lost,) = flown(own, lambda step: Beside(2.1 * own.distance))
    assert not TASK.succeeded(own, lost)
    *_, missed = flown(own, lambda step: Beside(1.5 * own.meeting))
    assert missed.memory.course.parameter >= 3.0
    assert not TASK.succeeded(own, missed)
    assert not DEFINITION.collided(own, missed.memory)


def test_what_is_observed_of_the_partner_is_where_it_was_when_sound_left_it():
    """From afar, as sound and the packet itself take their time."""
    own = numbers(distance=100.0, noise=0.0, drift=0.0, dropout=0.0, contents="position")
    sent = round(own.link.slot / own.period)
    situations = list(zip(range(3 * sent), flown(own, lambda step: Beside(140.0)), strict=False))
    places = [partner_of(own, now.memory)[0] for _, now in situations]
    heard = 0
    for step, now in situations:
        told, age, distance, *_ = TASK.observe(own, now.memory, now.motion)[0]
        if told[0] and step + 1 < 2 * sent:  # the packet of the period with the number `sent`
            at_sending = situations[sent - 1][1].motion.position_ned
            assert age == pytest.approx((step + 1 - sent) * own.period)
            assert age >= distance / SOUND_SPEED + own.link.packet - 1e-9
            assert distance == pytest.approx(math.dist(places[sent - 1], at_sending), abs=0.3)
            heard += 1
    assert heard == sent - math.ceil((140.0 / SOUND_SPEED + own.link.packet) / own.period)


@pytest.mark.parametrize("level", DEFINITION.levels)
def test_starts_are_away_from_the_partner_with_the_bow_about_towards_it(level):
    keywords = {
        name: value for name, value in DEFINITION.levels[level].items() if name in DEFINITION.keywords
    }
    own, random = numbers(**keywords), np.random.default_rng(0)
    for _ in range(50):
        uniforms = tuple(random.random(TASK.draws).tolist())
        begun = TASK.start(own, uniforms)
        metrics = TASK.initial_memory(own, begun, uniforms).metrics
        assert 0.7 * own.distance <= metrics.distance <= 1.01 * own.distance
        w, _, _, z = begun.attitude
        towards = math.atan2(-begun.position_ned[1], -begun.position_ned[0])
        assert abs(math.remainder(2.0 * math.atan2(z, w) - towards, math.tau)) <= math.radians(60.0) + 1e-9
        assert begun.position_ned[2] >= 20.0


def test_to_meet_pays_more_than_to_stay_near_for_ever():
    """For who discounts by 0.99; per period nobody gets more than nearness and company in full."""
    weights = DEFINITION.weights
    assert weights.finish > 2.0 * (weights.nearness + weights.company) / (1.0 - 0.99)


@pytest.mark.parametrize("contents", ["none", "position"])
def test_what_is_observed_stays_within_its_bounds_wherever_the_vehicle_is(contents):
    vehicle, keywords = load_vehicle("remus100"), {"contents": contents, "drift": 100.0, "noise": 100.0}
    settings, own = DEFINITION.checked_settings(keywords, vehicle), numbers(**keywords)
    bounds = np.array(
        [one.bound for one in DEFINITION.observations(settings, vehicle) for _ in range(one.size)]
    )
    random = np.random.default_rng(0)
    for now in flown(own, lambda step: Beside(random.uniform(own.safe, 2.0 * own.meeting))):
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
            for name in (
                "distance",
                "meeting",
                "hold",
                "turn",
                "climb",
                "interval",
                "noise",
                "dropout",
                "drift",
            )
            for value in (-1.0, math.nan, 1e300, "far")
        ),
        ("meeting", 11.0),  # more than half of the distance
        ("contents", "all"),
        ("contents", 2),
    ],
)
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        numbers(**{name: value})


@pytest.mark.sweep  # whole episodes
@pytest.mark.parametrize("vehicle", VEHICLES)
def test_the_baseline_meets_its_partner(vehicle):
    env = gym.make(RENDEZVOUS, vehicle=vehicle, level="medium")
    controller = controller_for(env)
    assert isinstance(controller, RendezvousController)
    for seed in range(3):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}: {episode.measured}"


@pytest.mark.parametrize("joins", [(80,), range(4000)], ids=["once", "in each period"])
def test_a_controller_that_joins_an_episode_under_way_meets_its_partner(joins):
    """By the running fix alone. What it does when it joins in each period follows from what is seen then."""
    env = gym.make(RENDEZVOUS, level="medium")
    controller = controller_for(env)
    met = 0
    for seed in range(4):
        observation, _ = env.reset(seed=6_000_000 + seed)
        over, period = False, 0
        while not over:
            if period == 0 or period in joins:
                controller.reset(env)
            observation, _, terminated, truncated, info = env.step(controller.act(observation))
            over, period = terminated or truncated, period + 1
        met += bool(info["is_success"])
    assert met == 4


@pytest.mark.parametrize("seed", [5_000_055, 5_000_120, 5_000_174])
def test_a_partner_that_comes_head_on_is_passed_on_one_side(seed):
    """Which side its place would be on changes with each packet there, and who turned with it was hit."""
    env = gym.make(RENDEZVOUS, level="medium")
    episode = fly_episode(env, controller_for(env), seed=seed)
    assert episode.success, episode.measured
