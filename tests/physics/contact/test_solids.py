"""Solids: what `solids=` takes, distances where they stand, JSON and back, and what is refused."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.solids import box, write_stl

from dq_marine.charts.solid_chart import SolidChart
from dq_marine.envs import parallel_env
from dq_marine.errors import InvalidInputError
from dq_marine.physics.contact.formulas import make_placed
from dq_marine.physics.contact.hull import hull_spheres
from dq_marine.physics.contact.shapes import Ball, Box, Pillar, Plane, Rod
from dq_marine.physics.contact.solid import Solid
from dq_marine.simulation.scene import Scene
from dq_marine.simulation.settings import Settings
from dq_marine.simulation.solids import plain_solids, solids_of
from dq_marine.vehicles import load_vehicle, vehicle_names

measures = st.floats(0.1, 50.0)
places = st.tuples(*[st.floats(-50.0, 50.0)] * 3)
headings = st.floats(-3.0, 3.0)
shapes = st.one_of(
    st.builds(Plane, places.filter(lambda a: math.hypot(*a) > 0.1)),
    st.builds(Ball, measures),
    st.builds(Box, st.tuples(measures, measures, measures)),
    st.builds(Pillar, measures),
    st.builds(Rod, places.filter(lambda a: math.hypot(*a) > 0.1), measures),
)
solids = st.builds(
    Solid, shapes, places, headings, st.floats(0.0, 2.0), st.one_of(st.none(), measures), st.floats(0.0, 2.0)
)


def distance(solid, point):
    return make_placed(solid.shape.distance)(solid.place, tuple(point))


@given(st.lists(solids, max_size=4))
def test_solids_are_the_same_again_from_text_and_numbers(made):
    assert solids_of(plain_solids(solids_of(made))) == tuple(made)
    assert pickle.loads(pickle.dumps(made)) == made


def test_settings_with_solids_are_the_same_again_from_json():
    made = Settings(
        solids=[
            Plane((0.0, 1.0, -2.0)),
            Solid(Rod((1.0, 2.0, 0.1), 0.3), (1.0, 2.0, 3.0), 0.7, 0.1, 1e4, 0.2),
        ]
    )
    assert Settings.from_json(made.to_json()) == made


@given(solids, places, places)
def test_no_distance_changes_by_more_than_the_point_moves(solid, one, other):
    way = math.dist(one, other)
    assert abs(distance(solid, one) - distance(solid, other)) <= way * (1.0 + 1e-9) + 1e-9


@given(shapes, places, places, headings)
def test_a_solid_that_is_moved_and_turned_is_as_far_from_what_is_moved_and_turned_with_it(
    shape, place, point, heading
):
    turn = np.array(
        [
            [math.cos(heading), -math.sin(heading), 0.0],
            [math.sin(heading), math.cos(heading), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    moved = Solid(shape, place, heading)
    there = tuple((np.array(place) + turn @ point).tolist())
    assert distance(moved, there) == pytest.approx(distance(Solid(shape), point), abs=1e-9)


def test_a_mesh_is_a_solid_and_travels_by_its_file(tmp_path):
    file = write_stl(tmp_path / "box.stl", box(4.0, 2.0, 1.0))
    (solid,) = solids_of(
        [{"kind": "mesh", "file": str(file), "spacing": 0.2, "position_ned": [1.0, 2.0, 3.0]}]
    )
    assert isinstance(solid.shape, SolidChart)
    assert distance(solid, (1.0, 2.0, 3.2)) == pytest.approx(-0.2, abs=0.01)
    assert distance(solid, (3.3, 2.0, 3.2)) == pytest.approx(0.3, abs=0.01)
    (plain,) = plain_solids([solid])
    assert plain["file"] == str(file)
    (again,) = solids_of([plain])
    assert np.array_equal(again.shape.distances, solid.shape.distances)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("wall", "solids = 'wall'; give a list"),
        (["wall"], "solids has 'wall'; give Solid"),
        ([Plane], "solids has .*Plane.*; give Solid"),
        ([{"kind": "cube"}], "kind of a solid = 'cube' is unknown; give one of"),
        ([{"radius": 1.0}], "kind of a solid = None"),
        ([{"kind": "ball"}], "a ball lacks radius; it takes damping_ratio, friction, heading"),
        ([{"kind": "ball", "radius": 1.0, "size": 2.0}], "a ball does not take 'size'"),
        ([{"kind": "ball", "radius": -1.0}], "radius = -1"),
        ([{"kind": "box", "size": [1.0, 0.0, 2.0]}], r"size\[1\] = 0"),
        ([{"kind": "plane", "normal": [0.0, 0.0, 0.0]}], "is no direction"),
        ([{"kind": "rod", "end": [0.0, 0.0, 0.0], "radius": 1.0}], "length of a rod = 0"),
        ([{"kind": "plane", "friction": -0.1}], "friction = -0.1"),
        ([{"kind": "plane", "stiffness": 0.0}], "stiffness = 0"),
        ([{"kind": "plane", "damping_ratio": math.nan}], "damping_ratio = nan"),
        ([{"kind": "plane", "position_ned": [0.0, 1e9, 0.0]}], "at most 100000 m"),
        ([{"kind": "mesh", "file": "nowhere.stl"}], "a mesh lacks spacing"),
        ([{"kind": "mesh", "file": "nowhere.stl", "spacing": 0.1}], "nowhere.stl"),
        ([{"kind": "mesh", "file": 5, "spacing": 0.1}], "file = 5 is no path of a file"),
        ([Solid(Plane())] * 65, "solids has 65 of them; give at most 64"),
    ],
)
def test_what_is_no_solid_is_refused(given, message):
    with pytest.raises(InvalidInputError, match=message):
        solids_of(given)


class Deaf:
    """A shape without a function."""

    distance, numbers = 3.0, ()


class Nowhere:
    """A shape whose distance is no number."""

    distance, numbers = staticmethod(lambda numbers, point: math.nan), ()


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (Deaf(), "has no distance: TypeError"),
        (Plane, "has no distance"),
        (Nowhere(), "is not a finite distance"),
    ],
)
def test_a_shape_whose_distance_cannot_be_had_is_refused(shape, message):
    with pytest.raises(InvalidInputError, match=message):
        Solid(shape)


@pytest.mark.parametrize(
    "keywords",
    [
        {"order": 4},
        {"scheme": "gauss", "order": 8},
        {"scheme": "galerkin", "order": 4},
        {"scheme": "runge_kutta", "order": 8},
    ],
)
def test_methods_of_high_order_say_that_they_know_no_contact(keywords):
    with pytest.raises(InvalidInputError, match=r'knows no contact.*give scheme="midpoint", order=2'):
        Scene("bluerov2", solids=[Plane()], **keywords)


def test_time_does_not_run_backwards_in_contact():
    with pytest.raises(InvalidInputError, match="contact"):
        Scene("bluerov2", solids=[Plane()], step=-0.02)


def test_vessels_with_origins_of_their_own_take_no_solids():
    with pytest.raises(InvalidInputError, match="each vessel's axes have an origin of their own"):
        parallel_env(["otter", "otter"], solids=[{"kind": "plane", "position_ned": [0.0, 0.0, 5.0]}])


@pytest.mark.parametrize("name", vehicle_names())
def test_the_spheres_of_a_hull_reach_its_ends_and_no_farther(name):
    size = load_vehicle(name).dimensions
    spheres = hull_spheres(load_vehicle(name))
    for along, whole in ((spheres.x, size.length), (spheres.y, size.width), (spheres.z, size.height)):
        reach = [place + radius for place, radius in zip(along, spheres.radius, strict=True)]
        back = [place - radius for place, radius in zip(along, spheres.radius, strict=True)]
        assert max(reach) - min(back) == pytest.approx(whole, rel=0.03)
    assert len(spheres.x) <= 36
