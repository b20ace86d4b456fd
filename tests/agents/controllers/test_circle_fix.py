"""A fix by circles of position: where they meet, and always the same of two places where they meet twice."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.controllers.circle_fix import circle_fix

places = st.tuples(st.floats(-40.0, 40.0), st.floats(-40.0, 40.0))


def circles_through(place, centres):
    centres = np.array(centres)
    return centres, np.linalg.norm(np.array(place) - centres, axis=1)


@given(places, st.lists(places, min_size=3, max_size=8))
def test_it_is_where_the_circles_meet(place, centres):
    centres, radii = circles_through(place, centres)
    assume(radii.min() > 1.0)
    spread = centres - centres.mean(axis=0)
    assume(np.linalg.svd(spread, compute_uv=False)[-1] > 5.0)  # not along a line: a single place is left
    fix = circle_fix(centres, radii, np.linspace(0.3, 30.0, len(radii)))
    assert np.linalg.norm(fix - place) < 0.05 * radii.max()


@given(places, st.floats(0.2, 3.0), st.floats(1.0, 10.0))
def test_of_two_places_beside_a_straight_way_it_is_the_one_to_starboard(place, direction, step):
    """Ahead and starboard are positive: the way goes through the vehicle, and both places are as far from it."""
    along = np.array([np.cos(direction), np.sin(direction)])
    centres, radii = circles_through(place, [-k * step * along for k in range(6)])
    across = np.array([-along[1], along[0]])
    other = np.array(place) - 2.0 * (np.array(place) @ across) * across
    towards = np.array([1.0, 1.0]) / np.sqrt(2.0)
    assume(abs(np.array(place) @ across) > 3.0)
    assume(abs((place - other) @ towards) > 2.0)
    unwanted, wanted = sorted((np.array(place), other), key=lambda one: one @ towards)
    fix = circle_fix(centres, radii, np.full(6, 1.0))
    assert np.linalg.norm(fix - wanted) < np.linalg.norm(fix - unwanted)


@given(places, st.integers(1, 8))
def test_circles_that_coincide_leave_a_place_on_them(place, count):
    centres, radii = circles_through(place, [(0.0, 0.0)] * count)
    assume(radii[0] > 1.0)
    fix = circle_fix(centres, radii, np.ones(count))
    assert np.linalg.norm(fix) == pytest.approx(radii[0], rel=1e-6)
    assert np.all(fix > 0.0), "ahead and to starboard"


@pytest.mark.parametrize("joins", [(80,), range(4000)], ids=["once", "in each period"])
def test_a_controller_that_joins_an_episode_under_way_meets_its_partner(joins):
    """By the circles alone. What it does when it joins in each period follows from what is seen then."""
    env = gym.make("dq_marine/Rendezvous-v0", level="medium")
    controller = make_baseline("controller", env, 0)
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
    env.close()
    assert met == 4
