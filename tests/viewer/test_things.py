"""Things around a vehicle: their forms have their sizes and face outwards, and each is drawn, placed and taken away."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.samples import ROV, snapshot, yawed

from dq_marine.errors import InvalidInputError
from dq_marine.task.things import (
    Block,
    Cage,
    Column,
    Cone,
    Faces,
    Form,
    Line,
    Relief,
    ShipHull,
    Sphere,
    Thing,
    TorpedoHull,
    Tube,
)
from dq_marine.viewer.meshes import Mesh, joined
from dq_marine.viewer.models.thing_models import RIM, thing_model, tube
from dq_marine.viewer.placement import HIDDEN_SCALE
from dq_marine.viewer.snapshot import Snapshot
from dq_marine.viewer.world.drawing import Drawing, floor_below
from dq_marine.viewer.world.things import THINGS, Things

BENT = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (20.0, 5.0, 2.0), (30.0, 15.0, 2.0))
GRID = tuple(np.linspace(-20.0, 20.0, 9))
HILLY = Relief(GRID, GRID, tuple(10.0 + 0.2 * n - 0.1 * e + math.sin(n) for n in GRID for e in GRID))
FORMS = {
    "column": Column(0.5, 8.0),
    "cage": Cage(12.0, 20.0),
    "ship": ShipHull(30.0, 5.0),
    "block": Block(30.0, 5.0, 2.0),
    "torpedo": TorpedoHull(1.3, 0.2),
    "cone": Cone(0.4, 1.0, 2.0),
    "line": Line(BENT, 0.1),
    "tube": Tube(BENT, 0.3),
    "sphere": Sphere(1.5),
    "faces": Faces(
        (
            ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
            ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        )
    ),
    "relief": HILLY,
}
PILLAR = Thing(FORMS["column"], (3.0, 4.0, 5.0))


def mesh_of(form: Form) -> Mesh:
    return joined([painted.mesh for painted in thing_model(form)[0]])


@pytest.mark.parametrize("name", FORMS)
def test_triangles_run_anticlockwise_seen_from_where_their_normals_point(name: str) -> None:
    mesh = mesh_of(FORMS[name])
    a, b, c = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    facing = np.cross(b - a, c - a)
    areas = np.linalg.norm(facing, axis=1)
    normals = mesh.normals[mesh.triangles].mean(axis=1)
    assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-9)
    assert (np.sum(facing * normals, axis=1)[areas > 1e-9] > 0.0).all()


def test_forms_have_their_sizes() -> None:
    column = mesh_of(FORMS["column"]).vertices
    assert_allclose(np.hypot(column[:, 0], column[:, 1]).max(), 1.02 * 0.5)
    assert_allclose([column[:, 2].min(), column[:, 2].max()], [-4.0, 4.0], atol=1e-9)
    ship = mesh_of(FORMS["ship"]).vertices
    assert_allclose(np.ptp(ship[:, 0]), 30.0, rtol=0.02)
    assert_allclose(np.ptp(ship[:, 1]), 5.0, rtol=0.02)
    assert ship[:, 2].min() < 0.0 < ship[:, 2].max()  # afloat
    block = mesh_of(FORMS["block"]).vertices
    assert_allclose(np.ptp(block, axis=0), [30.0, 5.0, 2.0])
    assert_allclose(block.mean(axis=0), 0.0, atol=1e-9)
    torpedo = mesh_of(FORMS["torpedo"]).vertices
    assert_allclose(np.ptp(torpedo[:, 0]), 1.3, rtol=0.05)
    radii = np.hypot(torpedo[:, 1], torpedo[:, 2])
    assert np.isclose(radii, 0.1).sum() > 20  # of the hull, from which the fins stick out
    assert radii.max() < 0.25
    cone = mesh_of(FORMS["cone"]).vertices
    radii = np.hypot(cone[:, 1], cone[:, 2])
    assert_allclose(radii[np.isclose(cone[:, 0], 0.0)], 0.4)
    assert_allclose(radii.max(), (1.0 + RIM) * 1.0)
    assert_allclose(cone[:, 0].min(), -2.0 - RIM * 1.0)


def test_a_tube_is_as_far_from_its_line_as_its_radius() -> None:
    mesh = tube(np.array(BENT), 0.3)
    rings = mesh.vertices.reshape(len(BENT), -1, 3)
    assert_allclose(np.linalg.norm(rings - np.array(BENT)[:, None], axis=2), 0.3)
    upright = tube(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 7.0]]), 0.5).vertices
    assert_allclose(np.hypot(upright[:, 0], upright[:, 1]), 0.5)


def test_a_seabed_has_its_depths_and_faces_up() -> None:
    mesh = mesh_of(HILLY)
    depths = {(n, e): d for (n, e), d in zip([(n, e) for n in GRID for e in GRID], HILLY.depths, strict=True)}
    assert all(depths[north, east] == depth for north, east, depth in mesh.vertices)
    assert (mesh.normals[:, 2] < 0.0).all()


def around(*things: Thing, time: float = 0.0) -> Snapshot:
    return snapshot(time=time, things=things)


def test_a_thing_is_drawn_once_and_placed_where_it_is() -> None:
    things = Things()
    first = around(PILLAR, PILLAR._replace(position_ned=(9.0, 9.0, 5.0)))
    assert [message.kind for message in things.appear(first)] == ["set_object", "set_object"]
    moved = around(PILLAR._replace(position_ned=(3.5, 4.0, 5.0), attitude=tuple(yawed(0.3))))
    assert things.appear(moved) == []
    places = things.placements(moved)
    assert places[f"{THINGS}/0"].position == (3.5, 4.0, 5.0)
    assert_allclose(places[f"{THINGS}/0"].quaternion, yawed(0.3))
    assert places[f"{THINGS}/1"].scale == HIDDEN_SCALE  # gone


def test_another_form_is_another_thing() -> None:
    things = Things()
    things.appear(around(PILLAR))
    wider = around(Thing(Column(0.6, 8.0), (0.0, 0.0, 5.0)))
    assert len(things.appear(wider)) == 1
    places = things.placements(wider)
    assert [place.scale == HIDDEN_SCALE for place in places.values()] == [True, False]


def test_a_new_episode_takes_the_old_things_away() -> None:
    drawing = Drawing(ROV)
    drawing.appear(around(PILLAR))
    old = [path for path in drawing.placements(around(PILLAR)) if path.startswith(THINGS)]
    assert [(message.kind, message.path) for message in drawing.restart()] == [("delete", old[0])]
    assert drawing.restart() == []
    drawing.appear(around(PILLAR))
    new = [path for path in drawing.placements(around(PILLAR)) if path.startswith(THINGS)]
    assert len(new) == 1
    assert new != old  # placements that were sent for the old one do not count


def test_the_floor_is_below_a_seabed() -> None:
    assert floor_below([around(Thing(HILLY))], ROV) > max(HILLY.depths)


@pytest.mark.parametrize(
    ("thing", "complaint"),
    [
        ("a pillar", r"things\[0\] is 'a pillar'; give a .*Thing"),
        (Thing(None, (0.0, 0.0, 0.0)), r"things\[0\] is Thing"),  # type: ignore[arg-type]
        (PILLAR._replace(position_ned=(0.0, math.nan, 0.0)), r"things\[0\].position_ned"),
        (PILLAR._replace(attitude=(0.0, 0.0, 0.0, 0.0)), r"things\[0\].attitude"),
    ],
)
def test_what_is_no_thing_is_refused(thing: Thing, complaint: str) -> None:
    with pytest.raises(InvalidInputError, match=complaint):
        around(thing)
