"""A running fix: where circles meet, and always the same of two places where all of them meet twice."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from dq_marine.task.hearing import partner_link
from dq_marine.task.position_circles import CIRCLES, Circle, Plot, empty_plot
from dq_marine.task.running_fix import fix_told, running_fix

NOISE, AHEAD, FAR = 0.2, (1.0, 0.0), 1e3
LINK = partner_link(NOISE, 0.0, "course", 0.0, 2.0)

lengths = st.floats(-40.0, 40.0)
places = st.tuples(lengths, lengths)
angles = st.floats(-math.pi, math.pi)


class Told(NamedTuple):
    """What an observation tells of a fix."""

    told: float
    ahead: float
    starboard: float
    distance: float
    share: float

    @property
    def place(self) -> NDArray[np.float64]:
        return self.distance * np.array([self.ahead, self.starboard])


def told(plot: Plot, bow: tuple[float, float] = AHEAD) -> tuple[Told, Told]:
    """Both fixes as they are observed."""
    one, other = running_fix(LINK, plot, bow)
    return Told(*fix_told(one, bow, FAR)), Told(*fix_told(other, bow, FAR))


def plot_of(centres: ArrayLike, radii: ArrayLike, ages: ArrayLike) -> Plot:
    """As many circles as are given, the newest first."""
    given_circles = [
        Circle(tuple(map(float, c)), float(r), float(age))
        for c, r, age in zip(np.asarray(centres), radii, ages, strict=True)
    ]
    return (*given_circles, *empty_plot()[len(given_circles) :])


def circles_through(place, centres) -> tuple[Plot, NDArray[np.float64]]:
    radii = np.linalg.norm(np.array(place) - np.array(centres), axis=1)
    return plot_of(centres, radii, np.linspace(0.3, 30.0, len(radii))), radii


def not_along_a_line(centres) -> bool:
    """Whether circles about these centres leave a single place, and not two that are as good but for rounding."""
    return bool(np.linalg.svd(centres - np.mean(centres, axis=0), compute_uv=False)[-1] > 5.0)


@given(places, st.lists(places, min_size=3, max_size=CIRCLES))
def test_it_is_where_the_circles_meet(place, centres):
    plot, radii = circles_through(place, centres)
    assume(radii.min() > 1.0)
    assume(not_along_a_line(centres))
    one, other = told(plot)
    assert np.linalg.norm(one.place - place) < 1e-3 * radii.max()
    assert one.share > other.share


@given(places, angles, st.floats(1.0, 10.0))
def test_of_two_places_beside_a_straight_way_it_is_the_one_to_starboard(place, direction, step):
    """The way goes through the vehicle, and both places are as far from it."""
    along = np.array([np.cos(direction), np.sin(direction)])
    across = np.array([-along[1], along[0]])
    mirrored = np.array(place) - 2.0 * (np.array(place) @ across) * across
    preferred = np.array([1.0, 1.0]) / np.sqrt(2.0)
    assume(abs(np.array(place) @ across) > max(5.0, 0.2 * np.linalg.norm(place)))  # two places, not about one
    assume(abs((place - mirrored) @ preferred) > 2.0)
    plot, _ = circles_through(place, [-k * step * along for k in range(6)])
    unwanted, wanted = sorted((np.array(place), mirrored), key=lambda at: at @ preferred)
    one, other = told(plot)
    assert np.linalg.norm(one.place - wanted) < 0.05
    assert np.linalg.norm(other.place - unwanted) < 0.05
    assert one.share == pytest.approx(0.5, abs=0.02)
    assert one.share + other.share == pytest.approx(1.0)


@given(places, st.lists(places, min_size=3, max_size=CIRCLES), angles, angles)
def test_it_turns_with_what_is_seen(place, centres, turn, heading):
    """Circles and bow turned alike: the same is seen from the vehicle."""
    plot, radii = circles_through(place, centres)
    assume(radii.min() > 1.0)
    assume(not_along_a_line(centres))

    def turned(a, angle):
        return (
            math.cos(angle) * a[0] - math.sin(angle) * a[1],
            math.sin(angle) * a[0] + math.cos(angle) * a[1],
        )

    round_it = tuple(one._replace(centre=turned(one.centre, turn)) for one in plot)
    before = told(plot, turned(AHEAD, heading))
    after = told(round_it, turned(AHEAD, heading + turn))
    assert np.allclose(before[0].place, after[0].place, atol=1e-5 * (1.0 + radii.max()))


def test_seldom_is_another_place_on_the_newest_circle_much_likelier():
    """Against a search of the whole circle, for ranges that err as they are said to."""
    random = np.random.default_rng(0)
    lacking = np.array(
        [lacking_likelihood(random, count) for count in range(3, CIRCLES + 1) for _ in range(50)]
    )
    assert np.mean(lacking > 1.0) < 0.03
    assert np.median(lacking) < 0.01


def lacking_likelihood(random: np.random.Generator, count: int) -> float:
    """By how much the fix is less likely than the best place, by equation (1) and what is preferred."""
    place = random.uniform(-20.0, 20.0, 2)
    centres = np.cumsum(random.normal(0.0, 3.0, (count, 2)), axis=0)
    ages = np.sort(random.uniform(0.0, 30.0, count))
    deviation = np.sqrt(NOISE**2 + 0.1**2 + (0.015 * ages) ** 2)
    radii = np.abs(np.linalg.norm(place - centres, axis=1) + deviation * random.normal(size=count))

    def likelihood(at):
        off = np.linalg.norm(at[..., None, :] - centres, axis=-1) - radii
        towards = (at @ np.full(2, np.sqrt(0.5))) / np.linalg.norm(at, axis=-1)
        return 0.5 * towards - 0.5 * np.minimum(25.0, (off / deviation) ** 2).sum(axis=-1)

    round_it = np.linspace(-np.pi, np.pi, 10_000)
    everywhere = centres[0] + radii[0] * np.stack([np.cos(round_it), np.sin(round_it)], axis=-1)
    one, _ = told(plot_of(centres, radii, ages))
    return float(likelihood(everywhere).max() - likelihood(one.place))


def test_one_circle_is_no_fix():
    for plot in (empty_plot(), circles_through((3.0, 4.0), [(0.0, 0.0)])[0]):
        assert told(plot) == ((0.0,) * 5,) * 2


@given(places, st.integers(2, CIRCLES))
def test_circles_about_one_place_leave_a_place_on_them(place, count):
    plot, radii = circles_through(place, [(0.0, 0.0)] * count)
    assume(radii[0] > 1.0)
    one, _ = told(plot)
    assert one.told == 1.0
    assert one.distance == pytest.approx(radii[0], rel=1e-6)


@given(st.lists(st.tuples(lengths, lengths, st.floats(0.0, 1e3), st.floats(0.0, 60.0)), max_size=CIRCLES))
def test_whatever_the_circles_are_it_is_finite_and_bounded(circles):
    plot = plot_of([c[:2] for c in circles], [c[2] for c in circles], [c[3] for c in circles])
    for fix in running_fix(LINK, plot, AHEAD):
        shown = Told(*fix_told(fix, AHEAD, 50.0))
        assert np.all(np.isfinite(shown))
        assert math.hypot(shown.ahead, shown.starboard) <= 1.0 + 1e-12
        assert 0.0 <= shown.distance <= 50.0
        assert 0.0 <= shown.share <= 1.0
