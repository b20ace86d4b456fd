"""What controllers remember of ground and pipes: least squares that find what is there, wherever the vehicle goes."""

import math

import numpy as np
import pytest

from dq_marine.agents.controllers.profiles import Ground, Route


def surface(x, y):
    """A plane that is bent along north, as a depth."""
    return 10.0 + 0.3 * x - 0.2 * y + 0.01 * x * x


def seen_from(place, heading, points):
    """Points in NED as ahead, to starboard and below of a level vehicle."""
    c, s = math.cos(heading), math.sin(heading)
    off = points - np.array(place)
    return np.column_stack([c * off[:, 0] + s * off[:, 1], c * off[:, 1] - s * off[:, 0], off[:, 2]])


def echoes(rng, count, noise=0.0):
    places = rng.uniform(-4.0, 6.0, (count, 2))
    return np.column_stack([places, surface(*places.T) + noise * rng.standard_normal(count)])


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_the_ground_is_found_among_echoes_with_noise(noise):
    ground = Ground(1.5, 10.0)
    ground.add(echoes(np.random.default_rng(0), 4000, noise))
    for ahead, starboard in ((0.0, 0.0), (2.0, -1.0)):
        found = ground.at(ahead, starboard)
        assert found.below == pytest.approx(surface(ahead, starboard), abs=0.02)
        assert found.ahead == pytest.approx(0.3 + 0.02 * ahead, abs=0.02)
        assert found.starboard == pytest.approx(-0.2, abs=0.02)


def test_what_was_seen_is_where_it_is_after_any_way_and_turn():
    rng, width = np.random.default_rng(1), 2.0
    points, place, heading = echoes(rng, 300), np.zeros(3), 0.0
    moved, fresh = Ground(width, 100.0), Ground(width, 100.0)
    moved.add(points)
    for _ in range(20):
        way, turn = rng.uniform(-0.2, 0.3, 3), rng.uniform(-0.1, 0.1)
        c, s = math.cos(heading), math.sin(heading)
        place += [c * way[0] - s * way[1], s * way[0] + c * way[1], way[2]]
        heading += turn
        moved.move(tuple(way), turn)
    fresh.add(seen_from(place, heading, points))
    assert moved.at(0.5, -0.5) == pytest.approx(fresh.at(0.5, -0.5), abs=1e-9)


def test_what_is_far_behind_is_forgotten():
    ground = Ground(1.0, 3.0)
    ground.add(np.array([[0.0, 0.0, 5.0], [2.0, 0.0, 6.0]]))
    ground.move((3.5, 0.0, 0.0), 0.0)
    assert ground.at(0.0, 0.0).below == pytest.approx(6.0, abs=1e-3)
    ground.move((3.5, 0.0, 0.0), 0.0)
    assert ground.empty
    ground.add(np.array([[0.0, 0.0, 5.0]]))
    ground.reset()
    assert ground.empty


def test_a_route_is_found_with_its_slope_and_bend():
    rng, route = np.random.default_rng(2), Route(1.5, 10.0)
    x = rng.uniform(-2.0, 5.0, 3000)
    y = 0.7 + 0.2 * x - 0.03 * x * x + 0.02 * rng.standard_normal(len(x))
    route.add(np.column_stack([x, y, np.zeros_like(x)]))
    for ahead in (0.0, 1.0):
        line = route.at(ahead)
        assert line.starboard == pytest.approx(0.7 + 0.2 * ahead - 0.03 * ahead**2, abs=0.01)
        assert line.slope == pytest.approx(0.2 - 0.06 * ahead, abs=0.01)
        assert line.bend == pytest.approx(-0.06, abs=0.01)


def test_a_single_point_is_taken_as_level_ground_and_a_line_straight_ahead():
    ground, route = Ground(1.0, 5.0), Route(1.0, 5.0)
    ground.add(np.array([[0.5, 0.5, 4.0]]))
    route.add(np.array([[2.0, 1.0, 0.0]]))
    assert ground.at(0.0, 0.0) == pytest.approx((4.0, 0.0, 0.0))
    assert route.at(0.0) == pytest.approx((1.0, 0.0, 0.0))
