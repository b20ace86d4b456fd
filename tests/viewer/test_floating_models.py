"""Vessels as they are drawn: within their sizes, closed, with normals outwards; their surroundings."""

import math

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.viewer.models.hull_mesh import Level, lofted
from dq_marine.viewer.models.vehicle_model import HULLS
from dq_marine.viewer.snapshot import Shape, at_rest
from dq_marine.viewer.world.drawing import Drawing
from dq_marine.viewer.world.sea import SPECKS
from dq_marine.viewer.world.water import ON_THE_SURFACE, UNDER_WATER, surroundings_of

OTTER = Shape(2.0, 1.08, 0.6, kind="catamaran", draft=0.195)
SUPPLY = Shape(83.0, 18.0, 8.0, kind="ship", draft=5.0)
TANKER = Shape(246.0, 46.0, 20.0, kind="ship", draft=10.0)


def volume(mesh):
    """By the divergence theorem: right only for a closed surface whose triangles face outwards."""
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


def test_a_loft_between_equal_levels_has_the_volume_of_its_outline():
    """Of a parabolic bow on a straight side: area 2 h (s + 2 (L - s)/3), to the facets of the bow."""
    levels = [Level(z, -5.0, 5.0, 1.5, 0.6) for z in (2.0, 0.5, -1.0)]
    exact = 3.0 * 2.0 * 1.5 * (6.0 + 2.0 / 3.0 * 4.0)
    mesh = lofted(levels)
    assert volume(mesh) == pytest.approx(exact, rel=0.01)
    assert np.isfinite(mesh.normals).all()
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0)


@pytest.mark.parametrize("shape", [OTTER, SUPPLY, TANKER], ids=["otter", "supply", "tanker"])
def test_a_vessel_is_drawn_in_its_size(shape):
    parts = HULLS[shape.kind](shape)
    vertices = np.vstack([painted.mesh.vertices for part in parts.values() for painted in part])
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    assert high[0] - low[0] == pytest.approx(shape.length, rel=0.02)
    assert high[1] - low[1] == pytest.approx(shape.width, rel=0.05)
    assert high[2] == pytest.approx(shape.keel)
    assert shape.keel - low[2] > shape.height
    assert np.isfinite(vertices).all()


def test_a_large_ship_has_its_bridge_aft():
    def middle(shape):
        bridge = HULLS["ship"](shape)["bridge"]
        return np.vstack([painted.mesh.vertices for painted in bridge])[:, 0].mean()

    assert middle(SUPPLY) > 0.1 * SUPPLY.length
    assert middle(TANKER) < -0.2 * TANKER.length


def test_vessels_are_seen_above_water_and_others_below():
    assert surroundings_of(OTTER) is ON_THE_SURFACE
    assert surroundings_of(Shape(1.0, 0.2, 0.2, kind="torpedo")) is UNDER_WATER
    paths = {command.path for command in Drawing(OTTER).scenery(at_rest(0.0))}
    assert SPECKS not in paths


def test_a_draft_is_half_the_height_unless_given():
    assert Shape(1.0, 1.0, 0.5, kind="ship").keel == 0.25
    assert OTTER.keel == 0.195
    for wrong in (0.0, -1.0, math.nan):
        with pytest.raises(InvalidInputError, match="draft"):
            Shape(1.0, 1.0, 1.0, kind="ship", draft=wrong)
