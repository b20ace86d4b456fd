"""What is drawn of the worlds of tasks is where the formulas have it."""

import math

import numpy as np
import pytest

from dq_marine.algebra.quaternion import rotate
from dq_marine.task.acoustics import Sender
from dq_marine.task.berths import Berth, Harbour, from_berth
from dq_marine.task.docks import Dock, Funnel, heave_of
from dq_marine.task.harmonics import Curve, curve_point
from dq_marine.task.scenery import (
    dock_seen,
    field_seen,
    formation_seen,
    harbour_seen,
    harmonics_seen,
    line_seen,
    vessels_seen,
)
from dq_marine.task.traffic import OtherVessel
from dq_marine.task.world.pillars import LAYOUTS, Hull, Pillar

ZERO = (0.0, 0.0, 0.0)


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
@pytest.mark.parametrize(("depth", "length"), [(20.0, 0.5), (0.0, 320.0)], ids=["under water", "afloat"])
def test_pillars_stand_at_their_places_and_through_the_vehicles_depth(depth, length, layout):
    pillars = [Pillar(1.0, 2.0, 0.5, 0.1, 0.0), Pillar(-7.0, 3.0, 0.25, 0.0, 0.0)]
    for pillar, thing in zip(
        pillars, field_seen(pillars, layout, depth, Hull(0.5 * length, 0.1 * length)), strict=True
    ):
        assert thing.position_ned[:2] == (pillar.north, pillar.east)
        assert thing.form.radius == pillar.radius
        half = 0.5 * thing.form.height
        assert thing.position_ned[2] - half <= 0.0
        assert thing.position_ned[2] + half > depth + 0.5 * length


def test_vessels_that_are_there_head_where_they_go():
    there = OtherVessel((100.0, -50.0), (0.0, -3.0), 1.0, 0.0, 0.0)
    (thing,) = vessels_seen([there, there._replace(present=0.0)], 12.0)
    assert thing.position_ned == (100.0, -50.0, 0.0)
    assert rotate(thing.attitude, (1.0, 0.0, 0.0)) == pytest.approx((0.0, -1.0, 0.0))
    assert thing.form.length == 12.0


def test_those_of_a_formation_are_where_they_are_and_head_where_they_go():
    senders = [Sender((1.0, 2.0, 30.0), (0.0, 1.5, 0.1)), Sender((-4.0, 2.0, 30.0), (-1.0, 0.0, 0.0))]
    things = formation_seen(senders, 1.3)
    assert [thing.position_ned for thing in things] == [sender.position_ned for sender in senders]
    bows = [rotate(thing.attitude, (1.0, 0.0, 0.0)) for thing in things]
    assert bows[0] == pytest.approx((0.0, 1.0, 0.0))
    assert bows[1] == pytest.approx((-1.0, 0.0, 0.0))
    assert {thing.form.length for thing in things} == {1.3}


def test_a_docks_throat_is_where_it_heaves_and_its_mouth_before_it():
    course = 0.7
    dock = Dock(math.cos(course), math.sin(course), 20.0, 0.3, 1.1, 0.5)
    (thing,) = dock_seen(dock, Funnel(0.4, 2.0, 0.3))
    assert thing.position_ned == (0.0, 0.0, heave_of(dock)[0])
    mouth = rotate(thing.attitude, (-thing.form.length, 0.0, 0.0))
    assert mouth == pytest.approx((-2.0 * dock.north, -2.0 * dock.east, 0.0))
    assert (thing.form.throat, thing.form.mouth) == pytest.approx((0.4, 1.0))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_quay_and_its_piers_are_where_the_walls_are(side):
    berth = Berth(0.6, 0.8, side)
    harbour = Harbour(Hull(40.0, 9.0), 1.0, pier=80.0, basin=120.0, thickness=20.0)
    (quay,) = harbour_seen(harbour._replace(pier=0.0), berth)
    drawn, *piers = harbour_seen(harbour, berth)
    assert drawn == quay
    for thing, face in ((quay, (0.0, 0.0)), (piers[0], (-130.0, 80.0)), (piers[1], (130.0, 80.0))):
        away = (0.0, 0.5 * side * -thing.form.along_y, 0.0)
        middle = np.add(thing.position_ned, rotate(thing.attitude, away))
        assert tuple(middle[:2]) == pytest.approx(from_berth(harbour, berth, *face), abs=1e-9)
        assert thing.position_ned[2] - 0.5 * thing.form.along_z < 0.0  # above the water
    assert [(one.form.along_x, one.form.along_y) for one in piers] == [(20.0, 80.0)] * 2


def test_lines_go_through_their_points():
    points = [(0.0, 0.0, 1.0), (1.0, 2.0, 3.0)]
    (line,) = line_seen(points, 0.2)
    assert line.form == (tuple(points), 0.1)
    curve = Curve(
        (1.0, 2.0, 3.0), (0.0, 0.0, 0.1), ((5.0, 0.0, 0.0), ZERO, ZERO), ((0.0, 5.0, 0.0), ZERO, ZERO)
    )
    (helix,) = harmonics_seen(curve, 0.2)
    places = np.array(helix.form.points)
    assert np.allclose(np.linalg.norm(places[:, :2] - (1.0, 2.0), axis=1), 5.0)
    assert tuple(places[0]) == curve_point(curve, 0.0).position_ned
    assert np.abs(np.diff(places, axis=0)).max() < 1.0
