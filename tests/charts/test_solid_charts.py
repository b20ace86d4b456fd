"""Signed distances from STL files: closed forms of box and ball, sphere tracing, and what is refused."""

import copy
import pickle

import numpy as np
import pytest

from dq_marine.algebra.distances import box_distance
from dq_marine.charts.solid_chart import MOST_PAIRS, SolidChart
from dq_marine.charts.triangles import distances_to
from dq_marine.errors import InvalidInputError
from dq_marine.task.world.rays import make_trace

CENTER, HALF = (1.0, -2.0, 3.0), (2.0, 1.0, 0.5)
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def box_triangles():
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = np.array(CENTER) + signs * HALF
    return np.array([points[list(three)] for a, b, c, d in FACES for three in ((a, b, c), (a, c, d))])


def write_stl(path, triangles):
    """Write triangles as ASCII STL."""
    lines = ["solid s"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid s"]) + "\n")
    return path


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    return SolidChart.from_stl(write_stl(tmp_path_factory.mktemp("solid") / "box.stl", box_triangles()), 0.25)


def test_distances_to_triangles_are_those_of_the_nearest_of_many_points_on_them():
    rng = np.random.default_rng(1)
    triangles, points = rng.normal(size=(3, 3, 3)), rng.normal(scale=2.0, size=(40, 3))
    shares = np.array([(i, j, 200 - i - j) for i in range(201) for j in range(201 - i)]) / 200.0
    surface = np.einsum("sk,tki->tsi", shares, triangles).reshape(-1, 3)
    nearest = np.array([np.linalg.norm(surface - point, axis=1).min() for point in points])
    found = distances_to(points, triangles)
    assert (found <= nearest + 1e-12).all()
    assert np.allclose(found, nearest, atol=1e-2)


def test_the_samples_of_a_box_are_its_signed_distances(box):
    counts = box.distances.shape
    assert counts == (21, 13, 9)
    for place in np.ndindex(*counts):
        point = tuple(np.array(box.first) + box.spacing * np.array(place))
        assert box.distances[place] == pytest.approx(box_distance(point, CENTER, HALF), abs=1e-7)
        assert box.distance(box.grid, point) == pytest.approx(box.distances[place], abs=1e-12)


def test_a_beam_is_traced_to_the_box(box):
    trace = make_trace(box.distance, 64)
    assert trace(box.grid, (-6.0, -2.0, 3.0), (1.0, 0.0, 0.0), 20.0) == pytest.approx(5.0, abs=1e-6)
    assert trace(box.grid, (1.0, -2.0, -4.0), (0.0, 0.0, 1.0), 20.0) == pytest.approx(6.5, abs=1e-6)
    assert trace(box.grid, (-6.0, 4.0, 3.0), (1.0, 0.0, 0.0), 20.0) == 20.0


def test_charts_of_solids_travel(box):
    for other in (pickle.loads(pickle.dumps(box)), copy.deepcopy(box)):
        assert other.grid == box.grid
        assert other.distance is box.distance


@pytest.mark.parametrize(
    ("spacing", "message"),
    [
        (0.0, "spacing = 0"),
        (float("nan"), "spacing"),
        (1.5, r"more than the least side of box\.stl, 1 m"),
        (0.02, r"205 x .* samples; at most 65,536.*or more"),
    ],
)
def test_wrong_spacings_are_refused(tmp_path, spacing, message):
    path = write_stl(tmp_path / "box.stl", box_triangles())
    with pytest.raises(InvalidInputError, match=message):
        SolidChart.from_stl(path, spacing)


def test_the_spacing_that_a_message_asks_for_is_taken(tmp_path):
    path = write_stl(tmp_path / "box.stl", box_triangles())
    with pytest.raises(InvalidInputError, match="give about") as refused:
        SolidChart.from_stl(path, 0.03)
    asked = float(str(refused.value).split("about ")[1].split()[0])
    assert SolidChart.from_stl(path, asked).spacing == asked


def test_meshes_that_are_open_absent_or_too_fine_are_refused(tmp_path, monkeypatch):
    with pytest.raises(InvalidInputError, match="not closed"):
        SolidChart.from_stl(write_stl(tmp_path / "open.stl", box_triangles()[1:]), 0.25)
    with pytest.raises(InvalidInputError, match="there is no mesh"):
        SolidChart.from_stl(tmp_path / "nowhere.stl", 0.25)
    path = write_stl(tmp_path / "box.stl", box_triangles())
    monkeypatch.setattr("dq_marine.charts.solid_chart.MOST_PAIRS", MOST_PAIRS >> 12)
    with pytest.raises(InvalidInputError, match=r"12 triangles, too many for .* samples; give at most"):
        SolidChart.from_stl(path, 0.25)
