"""The watch of a vessel among several: whom it shows, by which rule they meet, and what it remembers of them."""

import math

import pytest

from dq_marine.algebra.spatial import Spatial
from dq_marine.envs.multi.watch import Seen, Watch, seen_from_above
from dq_marine.integrator.body import Motion
from dq_marine.task.lookout import lookout_kept
from dq_marine.task.starts import under_way
from dq_marine.task.traffic import Own

OWN = Own((1.0, 0.0), 1.0, 2.0, 60.0)
STILL = Spatial((0.0,) * 3, (0.0,) * 3)


def vessel(north, east, heading_deg, speed=1.0):
    bow = (math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg)))
    return Seen((north, east), (speed * bow[0], speed * bow[1]), bow)


ABOUT = {
    "ahead": vessel(50.0, 0.0, 180.0),
    "starboard": vessel(40.0, 40.0, -90.0),
    "port": vessel(45.0, -45.0, 90.0),
    "far": vessel(500.0, 500.0, -135.0),
    "slow": vessel(80.0, 1.0, 0.0, speed=0.3),
}
HERE = vessel(0.0, 0.0, 0.0)


def shown(lookout):
    return [(one.place, one.give_way, one.to_port) for one in lookout.vessels if one.present > 0.5]


def test_the_nearest_three_are_shown_where_they_are():
    lookout = Watch(OWN, (0.0, 0.0)).first(HERE, ABOUT)
    assert sorted(place for place, _, _ in shown(lookout)) == [(40.0, 40.0), (45.0, -45.0), (50.0, 0.0)]
    assert sorted(lookout.least) == pytest.approx([50.0, math.hypot(40.0, 40.0), math.hypot(45.0, 45.0)])


def test_an_empty_slot_shows_nobody_and_nobody_is_near_there():
    lookout = Watch(OWN, (0.0, 0.0)).first(HERE, {"ahead": ABOUT["ahead"]})
    assert len(shown(lookout)) == 1
    assert sorted(lookout.least)[1:] == [600.0, 600.0]


@pytest.mark.parametrize(
    ("name", "own_gives_way", "other_gives_way"),
    [("ahead", 1.0, 1.0), ("starboard", 1.0, 0.0), ("port", 0.0, 1.0), ("slow", 1.0, 0.0)],
)
def test_of_two_that_cross_one_gives_way_and_head_on_both_do(name, own_gives_way, other_gives_way):
    other = ABOUT[name]
    (mine,) = shown(Watch(OWN, (0.0, 0.0)).first(HERE, {name: other}))
    (theirs,) = shown(Watch(Own(other.bow, 1.0, 2.0, 60.0), other.place).first(other, {"own": HERE}))
    assert (mine[1], theirs[1]) == (own_gives_way, other_gives_way)
    assert theirs[0] == (-other.place[0], -other.place[1])  # in its own frame


def test_a_rule_holds_once_it_is_settled_and_is_none_before_they_come_nearer():
    watch = Watch(OWN, (0.0, 0.0))
    away = vessel(40.0, 40.0, 0.0, speed=2.0)
    lookout = watch.first(HERE, {"other": away})
    assert shown(lookout)[0][1:] == (0.0, 0.0)
    lookout = watch.kept(lookout, HERE, {"other": ABOUT["starboard"]}, 0.1)
    assert shown(lookout)[0][1:] == (1.0, 1.0)
    lookout = watch.kept(lookout, HERE, {"other": ABOUT["port"]}, 0.1)
    assert shown(lookout)[0][1:] == (1.0, 1.0)


def test_after_the_period_all_are_where_they_really_are():
    """The lookout goes on with constant velocities, from where these lead to the truth."""
    watch, origin = Watch(OWN, (7.0, -3.0)), (7.0, -3.0)
    here = vessel(7.0, -3.0, 0.0)
    lookout = watch.first(here, {"ahead": ABOUT["ahead"]})
    turned = vessel(49.0, 0.4, 150.0)
    lookout = watch.kept(lookout, here, {"ahead": turned}, 0.5)
    lookout = lookout_kept(lookout, Motion((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), STILL), 0.5)
    (place, *_) = shown(lookout)[0]
    assert place == pytest.approx((49.0 - origin[0], 0.4 - origin[1]))
    assert min(lookout.least) == pytest.approx(math.hypot(42.0, 3.4))


def test_who_is_shown_again_is_remembered():
    watch = Watch(OWN, (0.0, 0.0))
    others = {name: ABOUT[name] for name in ("ahead", "starboard", "port", "far")}
    lookout = watch.first(HERE, others)
    slot = [one.place for one in lookout.vessels].index((50.0, 0.0))
    passed = list(lookout.least)
    passed[slot] = 4.0
    lookout = lookout._replace(
        least=tuple(passed), turning=tuple(2.0 if k == slot else 0.0 for k in range(3))
    )
    gone = {**others, "ahead": vessel(900.0, 0.0, 180.0), "far": vessel(60.0, 5.0, 180.0)}
    lookout = watch.kept(lookout, HERE, gone, 0.0)
    assert (60.0, 5.0) in [one.place for one in lookout.vessels]
    assert lookout.least[slot] == pytest.approx(math.hypot(60.0, 5.0))
    assert lookout.turning[slot] == 0.0
    lookout = watch.kept(lookout, HERE, others, 0.0)
    back = [one.place for one in lookout.vessels].index((50.0, 0.0))
    assert (lookout.least[back], lookout.turning[back]) == (4.0, 2.0)


def test_who_has_left_is_no_longer_there_but_what_came_of_it_is():
    watch = Watch(OWN, (0.0, 0.0))
    lookout = watch.first(HERE, {"ahead": vessel(4.0, 0.0, 180.0)})
    lookout = watch.kept(lookout, HERE, {}, 0.1)
    assert shown(lookout) == []
    assert min(lookout.least) == 4.0


def test_a_vessel_is_seen_from_above_in_the_common_frame():
    begun = under_way((3.0, 4.0, 0.1), 0.7, 2.0)
    seen = seen_from_above(Motion(*begun), (10.0, 20.0))
    assert seen.place == (13.0, 24.0)
    assert seen.velocity == pytest.approx((2.0 * math.cos(0.7), 2.0 * math.sin(0.7)))
    assert seen.bow == pytest.approx((math.cos(0.7), math.sin(0.7)))
