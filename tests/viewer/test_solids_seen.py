"""Solids as things to draw: where they stand, as large as they are."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.solids import box, write_stl

from dq_marine.algebra.quaternion import rotate
from dq_marine.charts.solid_chart import SolidChart
from dq_marine.physics.contact.formulas import make_placed
from dq_marine.physics.contact.shapes import Ball, Box, Pillar, Plane, Rod
from dq_marine.physics.contact.solid import Solid
from dq_marine.task.things import Block, Column, Faces, Relief, Sphere, Tube
from dq_marine.viewer.meshes import joined
from dq_marine.viewer.models.thing_models import thing_model
from dq_marine.viewer.solids import things_of

PLACE = (3.0, -2.0, 5.0)


def vertices_ned(thing):
    """Where the surface of a thing is."""
    mesh = joined([painted.mesh for painted in thing_model(thing.form)[0]])
    turned = [rotate(thing.attitude, tuple(vertex)) for vertex in mesh.vertices.tolist()]
    return np.array(turned) + thing.position_ned


@pytest.mark.parametrize(
    ("shape", "form", "tolerance"),
    [
        (Plane(), Relief, 1e-9),
        (Plane((1.0, 2.0, -2.0)), Block, None),
        (Ball(1.5), Sphere, 0.02),
        (Box((3.0, 1.0, 2.0)), Block, 1e-9),
        (Pillar(0.5), Column, None),
        (Rod((1.0, 2.0, 1.0), 0.3), Tube, 1e-6),
    ],
)
def test_what_is_drawn_lies_on_the_surface_that_is_touched(shape, form, tolerance):
    solid = Solid(shape, PLACE, heading=0.7)
    (thing,) = things_of([solid], 1.0)
    assert isinstance(thing.form, form)
    distances = [
        make_placed(shape.distance)(solid.place, tuple(point)) for point in vertices_ned(thing).tolist()
    ]
    if tolerance is not None:
        assert_allclose(distances, 0.0, atol=tolerance)
    elif form is Block:  # a plane is drawn as a slab that is behind it
        assert_allclose(max(distances), 0.0, atol=1e-6)
        assert min(distances) == pytest.approx(-0.5)
    else:  # a column has ends and a band
        assert max(distances) == pytest.approx(0.02 * 0.5)
        assert min(distances) >= -0.5 - 1e-9


def test_a_chart_of_a_mesh_is_drawn_as_its_mesh(tmp_path):
    corners = box(4.0, 2.0, 1.0)
    chart = SolidChart.from_stl(write_stl(tmp_path / "box.stl", corners), 0.25)
    (thing,) = things_of([Solid(chart, PLACE, math.pi / 2)], 1.0)
    assert isinstance(thing.form, Faces)
    drawn = vertices_ned(thing)
    assert_allclose(drawn.max(axis=0), np.add(PLACE, (1.0, 2.0, 1.0)), atol=1e-6)
    assert_allclose(drawn.min(axis=0), np.add(PLACE, (-1.0, -2.0, 0.0)), atol=1e-6)


def test_a_shape_of_ones_own_is_not_drawn():
    class Mound:
        distance = staticmethod(lambda numbers, point: point[2] - 3.0)
        numbers = (1.0,)

    assert things_of([Solid(Mound())], 1.0) == ()
